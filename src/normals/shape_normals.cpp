#include "normals/shape_normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{

Vec3 to_plane(const Vec3& p, const Vec3& unit, double offset, double reach)
{
    const double d = offset - dot(p, unit);
    return std::fabs(d) <= reach ? d * unit : Vec3{};
}

Vec3 to_sphere(const Vec3& p, const SphereNormals& sphere, double reach)
{
    const Vec3 out = p - sphere.center;
    const double q = norm(out);
    const bool is_inside = q < sphere.radius;
    if (q == sphere.radius || is_inside != sphere.is_inside || q == 0) return {};
    const double d = sphere.radius - q;
    return std::fabs(d) <= reach ? (d / q) * out : Vec3{};
}

Vec3 to_cylinder(const Vec3& p, const CylinderNormals& cylinder, double reach, double h)
{
    const Vec3 axis = cylinder.center2 - cylinder.center1;
    const double height = norm(axis);
    if (height == 0) return {};
    const Vec3 unit = axis / height;
    const double t = dot(p - cylinder.center1, unit);
    const Vec3 from_axis = p - cylinder.center1 - t * unit;
    const double q = norm(from_axis);
    const bool is_between = t > 0 && t < height;
    if (cylinder.is_inside)
    {
        if (!is_between || !(q < cylinder.radius)) return {};
        const bool is_first = t <= height / 2;
        const double side = q > 0 ? cylinder.radius - q : std::numeric_limits<double>::infinity();
        const double cover = cylinder.limits[is_first ? 0 : 1]
                                 ? (is_first ? t : height - t)
                                 : std::numeric_limits<double>::infinity();
        if (!(std::min(side, cover) <= reach)) return {};
        const Vec3 to_side = q > 0 ? (side / q) * from_axis : Vec3{};
        if (!std::isfinite(cover)) return to_side;
        const Vec3 to_cover = (is_first ? -cover : cover) * unit;
        if (std::fabs(side - cover) < 0.01 * h) return to_side + to_cover;
        return side < cover ? to_side : to_cover;
    }
    const double axial = t < 0 ? -t : t > height ? height - t : 0;
    const double radial = q > cylinder.radius ? cylinder.radius - q : 0;
    if (axial != 0 && radial != 0)
        return std::min(std::fabs(axial), std::fabs(radial)) <= reach
                   ? axial * unit + (radial / q) * from_axis
                   : Vec3{};
    if (std::fabs(axial + radial) > reach) return {};
    return radial != 0 ? (radial / q) * from_axis : axial * unit;
}

} // namespace fppg
