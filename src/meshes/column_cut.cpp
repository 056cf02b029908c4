#include "meshes/column_cut.h"

#include <algorithm>

namespace fppg
{

Height height_above(const ColumnFacet& facet, double x, double y)
{
    constexpr double unit = 4 * std::numeric_limits<double>::epsilon();
    const Vec3& a = facet.a;
    const auto [lowest, highest] = std::minmax({a.z, facet.b.z, facet.c.z});
    if (lowest == highest) return {lowest, 0};

    const Vec3 u = facet.b - a;
    const Vec3 v = facet.c - a;
    const double px = x - a.x;
    const double py = y - a.y;
    const double det = u.x * v.y - u.y * v.x;
    const double det_error = unit * (std::abs(u.x * v.y) + std::abs(u.y * v.x));
    const double whole = highest - lowest;
    if (!(std::abs(det) > 2 * det_error)) return {lowest + whole / 2, whole};

    const double along_u = px * v.y - py * v.x;
    const double along_v = u.x * py - u.y * px;
    const double error_u = unit * (std::abs(px * v.y) + std::abs(py * v.x));
    const double error_v = unit * (std::abs(u.x * py) + std::abs(u.y * px));
    const double rise = (along_u * u.z + along_v * v.z) / det;
    // The weights lie in [0, 1], so the relative error of the determinant counts at most twice.
    const double error =
        2 * (error_u * std::abs(u.z) + error_v * std::abs(v.z) + 2 * det_error * whole) /
            std::abs(det) +
        unit * (std::abs(a.z) + 2 * whole);
    return {std::clamp(a.z + rise, lowest, highest), std::min(error, whole)};
}

} // namespace fppg
