#include "leak/rigid_motion.h"

#include <array>
#include <cassert>
#include <cmath>

namespace fppg
{

namespace
{

using Quaternion = std::array<double, 4>;
using Symmetric4 = std::array<Quaternion, 4>;

/// The eigenvector of the largest eigenvalue, by Jacobi's rotations; of length 1.
Quaternion largest_eigenvector(Symmetric4 a)
{
    Symmetric4 vectors{};
    for (std::size_t i = 0; i < 4; ++i) vectors[i][i] = 1;
    for (int sweep = 0; sweep < 60; ++sweep)
    {
        double off = 0;
        double diagonal = 0;
        for (std::size_t i = 0; i < 4; ++i)
        {
            diagonal += a[i][i] * a[i][i];
            for (std::size_t j = i + 1; j < 4; ++j) off += a[i][j] * a[i][j];
        }
        if (off <= 1e-32 * diagonal) break;
        for (std::size_t p = 0; p < 4; ++p)
            for (std::size_t q = p + 1; q < 4; ++q)
            {
                if (a[p][q] == 0) continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t =
                    (theta < 0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1);
                const double s = t * c;
                for (std::size_t k = 0; k < 4; ++k)
                {
                    const double kp = a[k][p];
                    const double kq = a[k][q];
                    a[k][p] = c * kp - s * kq;
                    a[k][q] = s * kp + c * kq;
                }
                for (std::size_t k = 0; k < 4; ++k)
                {
                    const double pk = a[p][k];
                    const double qk = a[q][k];
                    a[p][k] = c * pk - s * qk;
                    a[q][k] = s * pk + c * qk;
                    const double vp = vectors[k][p];
                    const double vq = vectors[k][q];
                    vectors[k][p] = c * vp - s * vq;
                    vectors[k][q] = s * vp + c * vq;
                }
            }
    }
    std::size_t best = 0;
    for (std::size_t i = 1; i < 4; ++i)
        if (a[i][i] > a[best][best]) best = i;
    Quaternion out{};
    for (std::size_t k = 0; k < 4; ++k) out[k] = vectors[k][best];
    return out;
}

std::array<Vec3, 3> rotation_of(const Quaternion& q)
{
    const auto [w, x, y, z] = q;
    return {Vec3{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
            Vec3{2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
            Vec3{2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
}

Vec3 middle_of(const std::vector<Vec3>& points)
{
    Vec3 sum;
    for (const Vec3& p : points) sum = sum + (p - points.front());
    return points.front() + sum / static_cast<double>(points.size());
}

} // namespace

RigidMotion fit_rigid_motion(const std::vector<Vec3>& from, const std::vector<Vec3>& to)
{
    assert(from.size() == to.size());
    RigidMotion motion;
    if (from.empty()) return motion;
    const Vec3 a = middle_of(from);
    const Vec3 b = middle_of(to);
    std::array<Vec3, 3> s; // s[i][j]: sum of from_i to_j
    for (std::size_t n = 0; n < from.size(); ++n)
    {
        const Vec3 u = from[n] - a;
        const Vec3 v = to[n] - b;
        for (int i = 0; i < 3; ++i)
            s[static_cast<std::size_t>(i)] = s[static_cast<std::size_t>(i)] + v * u[i];
    }
    const double xx = s[0].x;
    const double xy = s[0].y;
    const double xz = s[0].z;
    const double yx = s[1].x;
    const double yy = s[1].y;
    const double yz = s[1].z;
    const double zx = s[2].x;
    const double zy = s[2].y;
    const double zz = s[2].z;
    const Symmetric4 matrix{Quaternion{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                            Quaternion{yz - zy, xx - yy - zz, xy + yx, zx + xz},
                            Quaternion{zx - xz, xy + yx, yy - xx - zz, yz + zy},
                            Quaternion{xy - yx, zx + xz, yz + zy, zz - xx - yy}};
    motion.forward.linear = rotation_of(largest_eigenvector(matrix));
    const std::array<Vec3, 3>& r = motion.forward.linear;
    motion.backward.linear = {Vec3{r[0].x, r[1].x, r[2].x}, Vec3{r[0].y, r[1].y, r[2].y},
                              Vec3{r[0].z, r[1].z, r[2].z}};
    motion.forward.offset = b - motion.forward(a);
    motion.backward.offset = a - motion.backward(b);
    for (std::size_t n = 0; n < from.size(); ++n)
        motion.farthest = std::max(motion.farthest, norm(motion.forward(from[n]) - to[n]));
    return motion;
}

} // namespace fppg
