#pragma once

#include "fppg/vec.h"

namespace fppg
{

/// The order of edge ends: both facets of an edge take them in it and so find the same bits.
inline bool is_less(const Vec3& a, const Vec3& b)
{
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

inline Vec3 closest_on_edge(const Vec3& point, const Vec3& a, const Vec3& b)
{
    const bool is_ordered = is_less(a, b);
    const Vec3& from = is_ordered ? a : b;
    const Vec3& to = is_ordered ? b : a;
    const Vec3 along = to - from;
    const double share = dot(point - from, along) / dot(along, along);
    if (!(share > 0)) return from;
    return share >= 1 ? to : from + share * along;
}

inline Vec3 closest_on_facet(const Vec3& point, const Vec3* corners)
{
    const Vec3 &a = corners[0], &b = corners[1], &c = corners[2];
    const Vec3 normal = cross(b - a, c - a);
    const double to_a = dot(cross(c - b, point - b), normal);
    const double to_b = dot(cross(a - c, point - c), normal);
    const double to_c = dot(cross(b - a, point - a), normal);
    if (to_a > 0 && to_b > 0 && to_c > 0)
        return (to_a * a + to_b * b + to_c * c) / (to_a + to_b + to_c);

    Vec3 best = closest_on_edge(point, a, b);
    for (const Vec3& other : {closest_on_edge(point, b, c), closest_on_edge(point, c, a)})
        if (dot(other - point, other - point) < dot(best - point, best - point)) best = other;
    return best;
}

} // namespace fppg
