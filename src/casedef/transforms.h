#pragma once

#include "fppg/vec.h"

#include <cmath>
#include <numbers>

namespace fppg
{

inline double radians(double degrees)
{
    return degrees * std::numbers::pi / 180;
}

inline Transform translation(const Vec3& by)
{
    Transform t;
    t.offset = by;
    return t;
}

inline Transform scaling(const Vec3& s)
{
    Transform t;
    t.linear = {Vec3{s.x, 0, 0}, Vec3{0, s.y, 0}, Vec3{0, 0, s.z}};
    return t;
}

/// Right-handed rotation about an axis through the origin, angle in radians.
inline Transform rotation(const Vec3& axis, double angle)
{
    const Vec3 u = axis / norm(axis);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double k = 1 - c;
    Transform t;
    t.linear = {Vec3{c + u.x * u.x * k, u.x * u.y * k - u.z * s, u.x * u.z * k + u.y * s},
                Vec3{u.y * u.x * k + u.z * s, c + u.y * u.y * k, u.y * u.z * k - u.x * s},
                Vec3{u.z * u.x * k - u.y * s, u.z * u.y * k + u.x * s, c + u.z * u.z * k}};
    return t;
}

inline Transform rotation_about_axis(int axis, double angle)
{
    Vec3 u;
    u[axis] = 1;
    return rotation(u, angle);
}

/// The map `t` with `center` in the place of the origin.
inline Transform around(const Vec3& center, const Transform& t)
{
    return translation(center) * t * translation(-center);
}

/// Scale, then rotate right-handed about y, x, z in this order, about the centre; then move (rule
/// T5; the order was found with four random triples of angles: only this one puts all corners
/// right).
inline Transform placement(const Vec3& center, const Vec3& scale, const Vec3& angles_deg,
                           const Vec3& move)
{
    Transform t = scaling(scale);
    for (const int axis : {1, 0, 2})
        if (angles_deg[axis] != 0) t = rotation_about_axis(axis, radians(angles_deg[axis])) * t;
    // A centre alone is passed over; else it and the move are added before it is taken off again
    // (GenCase v5.4.354: what rounding of y leaves of 500 triangles in a 2D case, see
    // clip_to_box()).
    const Vec3 turned_center = t(center);
    t.offset = t.is_identity() ? move : (center + move) - turned_center;
    return t;
}

} // namespace fppg
