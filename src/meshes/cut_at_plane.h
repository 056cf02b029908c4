#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <vector>

namespace fppg
{

/// Cuts a polygon at a plane as GenCase v5.4.354 does for `<clipdomain>` (domain_clip.h) and clips:
/// a corner outside gives way to the point on the edge to the corner before it, then to the one on
/// the edge to the corner after it, unless this point is within 1e-4 m of the corner kept before
/// it.
///
/// holds     whether a corner is kept
/// crossing  of two corners, one outside: the point between them on the plane
/// kept      the corners left; two and fewer where nothing but an edge is left
template <typename Holds, typename Crossing>
void cut_at_plane(const std::vector<Vec3>& polygon, const Holds& holds, const Crossing& crossing,
                  std::vector<Vec3>& kept)
{
    constexpr double merge_distance = 1e-4;
    kept.clear();
    const auto add_crossing = [&](const Vec3& a, const Vec3& b)
    {
        const Vec3 p = crossing(a, b);
        if (kept.empty() || norm(p - kept.back()) > merge_distance) kept.push_back(p);
    };
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        const Vec3& p = polygon[i];
        if (holds(p))
        {
            kept.push_back(p);
            continue;
        }
        const Vec3& before = polygon[(i + n - 1) % n];
        const Vec3& after = polygon[(i + 1) % n];
        if (holds(before)) add_crossing(before, p);
        if (holds(after)) add_crossing(p, after);
    }
}

} // namespace fppg
