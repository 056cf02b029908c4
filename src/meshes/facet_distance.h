#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

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

/// One facet made ready for the distances of many points. The squared distance is right to
/// rounding; facets lower than 1e-8 of their longest side count as their three sides.
class FacetDistance
{
public:
    explicit FacetDistance(const Vec3* corners)
    {
        for (std::size_t s = 0; s < 3; ++s)
        {
            corners_[s] = corners[s];
            sides_[s] = corners[(s + 1) % 3] - corners[s];
            const double squared = dot(sides_[s], sides_[s]);
            side_inverse_[s] = squared > 0 ? 1 / squared : 0;
        }
        normal_ = cross(sides_[0], sides_[1]);
        const double squared = dot(normal_, normal_);
        const double longest = std::max(
            {dot(sides_[0], sides_[0]), dot(sides_[1], sides_[1]), dot(sides_[2], sides_[2])});
        if (!(squared > 1e-16 * longest * longest)) return;
        inverse_ = 1 / squared;
        for (std::size_t s = 0; s < 3; ++s) inwards_[s] = cross(normal_, sides_[s]);
    }

    /// The squared distance to the facet, or `limit` if it is not below that.
    double squared(const Vec3& p, double limit) const
    {
        const Vec3 from = p - corners_[0];
        const double height = dot(normal_, from);
        const double to_plane = height * height * inverse_; // 0 for a facet that is but its sides
        if (to_plane >= limit) return limit;
        const double ab = dot(inwards_[0], from);
        const double bc = dot(inwards_[1], p - corners_[1]);
        const double ca = dot(inwards_[2], from);
        if (inverse_ > 0 && ab >= 0 && bc >= 0 && ca >= 0) return to_plane;
        // The nearest point lies on a side that the point is beyond.
        double best = limit;
        if (!(ab > 0)) best = std::min(best, to_side(p, 0));
        if (!(bc > 0)) best = std::min(best, to_side(p, 1));
        if (!(ca > 0)) best = std::min(best, to_side(p, 2));
        return best;
    }

private:
    double to_side(const Vec3& p, std::size_t s) const
    {
        const Vec3 from = p - corners_[s];
        const double share = std::clamp(dot(from, sides_[s]) * side_inverse_[s], 0.0, 1.0);
        const Vec3 d = from - share * sides_[s];
        return dot(d, d);
    }

    std::array<Vec3, 3> corners_, sides_, inwards_{};
    std::array<double, 3> side_inverse_;
    Vec3 normal_;        ///< not of unit length
    double inverse_ = 0; ///< of its squared length; 0 where the facet is but its sides
};

} // namespace fppg
