#pragma once

#include "fppg/vec.h"

#include <cmath>
#include <numbers>

namespace fppg
{

inline double radians(double degrees)
{
    return degrees * (std::numbers::pi / 180);
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

/// Right-handed rotation about an axis through the origin, angle in radians: the axis is turned
/// into the plane y = 0 and onto z, and back again, from left to right. So the matrix has GenCase's
/// last bits, which decide whether a side of 5 dp is drawn in 5 or 6 intervals off the lattice (60
/// random rotations in GenCase v5.4.354: all entries, but where its sine or cosine is another by a
/// bit, as for 9 of 60 angles).
inline Transform rotation(const Vec3& axis, double angle)
{
    const double length = norm(axis);
    const double across = std::sqrt(axis.y * axis.y + axis.z * axis.z);
    const double cos_x = across > 0 ? axis.z / across : 1;
    const double sin_x = across > 0 ? axis.y / across : 0;
    const double cos_y = across / length;
    const double sin_y = axis.x / length;
    const double c = std::cos(angle);
    // GenCase's C library rounds the sine of 45 degrees to its cosine.
    const bool is_diagonal = std::fabs(angle) == std::numbers::pi / 4;
    const double s = is_diagonal ? std::copysign(c, angle) : std::sin(angle);
    const auto about_x = [](double cosine, double sine)
    {
        Transform t;
        t.linear = {Vec3{1, 0, 0}, Vec3{0, cosine, -sine}, Vec3{0, sine, cosine}};
        return t;
    };
    const auto about_y = [](double cosine, double sine)
    {
        Transform t;
        t.linear = {Vec3{cosine, 0, sine}, Vec3{0, 1, 0}, Vec3{-sine, 0, cosine}};
        return t;
    };
    Transform about_z;
    about_z.linear = {Vec3{c, -s, 0}, Vec3{s, c, 0}, Vec3{0, 0, 1}};
    return about_x(cos_x, -sin_x) * about_y(cos_y, sin_y) * about_z * about_y(cos_y, -sin_y) *
           about_x(cos_x, sin_x);
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
