#pragma once

#include "nodes/snap.h"
#include "nodes/spans.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fppg
{

/// The slabs of a box; nothing is listed yet.
inline SlabRegion slabs_of(const NodeBox& box)
{
    SlabRegion region;
    if (box.is_empty()) return region;
    region.x_begin = static_cast<std::uint32_t>(box.begin[0]);
    region.x_end = static_cast<std::uint32_t>(box.end[0]);
    return region;
}

/// The box of this many nodes around one.
inline NodeBox around(const Node& center, std::int64_t reach, const LatticeGrid& grid)
{
    return intersect({{center.x - reach, center.y - reach, center.z - reach},
                      {center.x + reach + 1, center.y + reach + 1, center.z + reach + 1}},
                     whole_lattice(grid));
}

inline void push(Spans& out, std::int64_t y, std::int64_t first, std::int64_t last)
{
    if (first <= last)
        out.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(first),
                       static_cast<std::uint32_t>(last) + 1});
}

/// An inclusive interval of z indices; empty when last < first.
struct Interval
{
    std::int64_t first = 0;
    std::int64_t last = -1;

    bool is_empty() const { return last < first; }
};

inline Interval meet(const Interval& a, const Interval& b)
{
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

/// Pushes `outer` without `inner`; inner lies inside outer or is empty.
inline void push_without(Spans& out, std::int64_t y, const Interval& outer, const Interval& inner)
{
    if (outer.is_empty()) return;
    if (inner.is_empty())
    {
        push(out, y, outer.first, outer.last);
        return;
    }
    push(out, y, outer.first, std::min(outer.last, inner.first - 1));
    push(out, y, std::max(outer.first, inner.last + 1), outer.last);
}

/// A radius in whole dp, as GenCase rounds it.
inline double rounded_radius(double radius, double dp)
{
    return std::floor(radius / dp + 0.5);
}

} // namespace fppg
