#include "shapes/moments.h"

namespace fppg
{
namespace
{

/// Sums over a body: second moments as a symmetric matrix.
using Moments = std::array<Vec3, 3>;

std::array<Vec3, 3> inertia_of(const Moments& m)
{
    const double trace = m[0].x + m[1].y + m[2].z;
    std::array<Vec3, 3> out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            const double v = m[static_cast<std::size_t>(i)][j];
            out[static_cast<std::size_t>(i)][j] = i == j ? trace - v : v == 0 ? 0 : -v;
        }
    return out;
}

} // namespace

std::array<Vec3, 3> inertia_around(const Vec3& u, double axial, double across)
{
    std::array<Vec3, 3> out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out[static_cast<std::size_t>(i)][j] =
                (i == j ? across : 0) + (axial - across) * u[i] * u[j];
    return out;
}

ExactBody body_of_facets(const TriangleSoup& soup)
{
    // Tetrahedra from the middle of the box, so that sums stay small.
    Box3 box;
    for (const Vec3& v : soup.vertices) box.add(v);
    const Vec3 from = box.is_empty() ? Vec3{} : (box.min + box.max) * 0.5;
    double volume = 0;
    Vec3 first;
    Moments second;
    for (std::size_t t = 0; t < soup.size(); ++t)
    {
        const std::array<Vec3, 3> p{soup.vertices[3 * t] - from, soup.vertices[3 * t + 1] - from,
                                    soup.vertices[3 * t + 2] - from};
        const double six = dot(p[0], cross(p[1], p[2]));
        const Vec3 sum = p[0] + p[1] + p[2];
        volume += six / 6;
        first = first + sum * (six / 24);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                second[static_cast<std::size_t>(i)][j] +=
                    six / 120 *
                    (sum[i] * sum[j] + p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j]);
    }
    ExactBody body;
    const double sign = volume < 0 ? -1 : 1;
    body.volume = sign * volume;
    if (!(body.volume > 0)) return body;
    const Vec3 mean = first / volume;
    body.center = from + mean;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            double& m = second[static_cast<std::size_t>(i)][j];
            m = sign * m - body.volume * mean[i] * mean[j];
        }
    body.inertia = inertia_of(second);
    return body;
}

std::array<Vec3, 3> inertia_about(const std::array<Vec3, 3>& inertia, double mass,
                                  const Vec3& offset)
{
    std::array<Vec3, 3> out = inertia;
    const double square = dot(offset, offset);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out[static_cast<std::size_t>(i)][j] +=
                mass * ((i == j ? square : 0) - offset[i] * offset[j]);
    return out;
}

} // namespace fppg
