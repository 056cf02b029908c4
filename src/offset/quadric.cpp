#include "offset/quadric.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// Turns a symmetric matrix so that its entry (p, q) vanishes (Jacobi); the columns of `vectors`
/// turn with it.
void turn_away(std::array<Vec3, 3>& a, std::array<Vec3, 3>& vectors, int p, int q)
{
    const auto row = [&](int i) -> Vec3& { return a[static_cast<std::size_t>(i)]; };
    const double off = row(p)[q];
    if (off == 0) return;
    const double theta = (row(q)[q] - row(p)[p]) / (2 * off);
    const double t = (theta >= 0 ? 1 : -1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1);
    const double s = t * c;
    for (int k = 0; k < 3; ++k)
    {
        const double at_p = row(k)[p];
        const double at_q = row(k)[q];
        row(k)[p] = c * at_p - s * at_q;
        row(k)[q] = s * at_p + c * at_q;
    }
    for (int k = 0; k < 3; ++k)
    {
        const double at_p = row(p)[k];
        const double at_q = row(q)[k];
        row(p)[k] = c * at_p - s * at_q;
        row(q)[k] = s * at_p + c * at_q;
        Vec3& v = vectors[static_cast<std::size_t>(k)];
        const double of_p = v[p];
        const double of_q = v[q];
        v[p] = c * of_p - s * of_q;
        v[q] = s * of_p + c * of_q;
    }
}

} // namespace

void Quadric::add_plane(const Vec3& normal, double offset)
{
    for (int i = 0; i < 3; ++i)
        matrix_[static_cast<std::size_t>(i)] =
            matrix_[static_cast<std::size_t>(i)] + normal[i] * normal;
    right_ = right_ + offset * normal;
}

Vec3 Quadric::least_point(double least_share) const
{
    std::array<Vec3, 3> a = matrix_;
    std::array<Vec3, 3> vectors{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (int sweep = 0; sweep < 8; ++sweep)
    {
        turn_away(a, vectors, 0, 1);
        turn_away(a, vectors, 0, 2);
        turn_away(a, vectors, 1, 2);
    }
    const double largest = std::max({a[0].x, a[1].y, a[2].z});
    Vec3 out;
    for (int i = 0; i < 3; ++i)
    {
        const double value = a[static_cast<std::size_t>(i)][i];
        if (!(value > least_share * largest)) continue;
        const Vec3 way{vectors[0][i], vectors[1][i], vectors[2][i]};
        out = out + (dot(way, right_) / value) * way;
    }
    return out;
}

} // namespace fppg
