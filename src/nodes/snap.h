#pragma once

#include "fppg/lattice.h"

#include "nodes/spans.h"

#include <cmath>
#include <optional>

namespace fppg
{

/// Indices of a lattice node; they may lie outside the lattice.
struct Node
{
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;

    std::int64_t operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    bool operator==(const Node&) const = default;
};

/// A whole number as an index. Far outside every lattice all are one, and so is what is no number,
/// so that the conversion is defined.
inline std::int64_t to_index(double whole)
{
    constexpr double limit = 4e9;
    return static_cast<std::int64_t>(!(whole >= -limit) ? -limit : whole > limit ? limit : whole);
}

/// Rounds a coordinate to the lattice: floor((c - origin) / dp + 0.5), in double and in this order,
/// so that halves fall as in GenCase (rule L4: 0.05 goes up to 0.1, 0.45 falls to 0.4). Below the
/// origin halves go down: -0.05 to -0.1 where the origin is 0.
inline std::int64_t snap(double coordinate, double origin, double dp)
{
    const double steps = (coordinate - origin) / dp;
    return to_index(steps < 0 ? std::ceil(steps - 0.5) : std::floor(steps + 0.5));
}

inline Node snap(const Vec3& p, const LatticeGrid& grid)
{
    return {snap(p.x, grid.origin.x, grid.step(0)), snap(p.y, grid.origin.y, grid.step(1)),
            snap(p.z, grid.origin.z, grid.step(2))};
}

/// The real place of a node.
inline Vec3 position(const Node& n, const LatticeGrid& grid)
{
    return grid.place(static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z));
}

inline bool is_inside(const Node& n, const LatticeGrid& grid)
{
    return n.x >= 0 && n.y >= 0 && n.z >= 0 && n.x < grid.n[0] && n.y < grid.n[1] &&
           n.z < grid.n[2];
}

/// Cuts a search interval [lo, hi] (both inclusive) down to the nodes where `holds` is true. The
/// true nodes must be consecutive; `lo` and `hi` may miss them by up to two nodes. The estimate is
/// cheap arithmetic, the decision is made by `holds` alone.
///
/// returns  false when there is no such node
template <typename Predicate>
bool trim_interval(std::int64_t& lo, std::int64_t& hi, std::int64_t min, std::int64_t max,
                   const Predicate& holds)
{
    lo = std::max(lo - 2, min);
    hi = std::min(hi + 2, max);
    while (lo <= hi && !holds(lo)) ++lo;
    while (hi >= lo && !holds(hi)) --hi;
    return lo <= hi;
}

} // namespace fppg
