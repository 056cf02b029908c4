#pragma once

#include "nodes/spans.h"

#include <array>
#include <cstdint>
#include <limits>

namespace fppg
{

/// Higher than every node.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Heights of nodes along a direction, in dp from the node (0, 0, 0) of the lattice. Heights that
/// differ by less than `tolerance` are one layer.
struct NodeHeights
{
    static constexpr double tolerance = 1e-6;

    Vec3 up{0, 0, 1};                           ///< how much higher a step is, per axis
    std::array<std::int64_t, 3> begin{0, 0, 0}; ///< lattice node that the indices count from

    double at(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return up.x * static_cast<double>(x + begin[0]) + up.y * static_cast<double>(y + begin[1]) +
               up.z * static_cast<double>(z + begin[2]);
    }
};

/// How much higher a step of the lattice is along each axis, dp.
///
/// up  of length 1
inline Vec3 up_in_steps(const Vec3& up, const LatticeGrid& grid)
{
    return {up.x * grid.stretch.x, up.y * grid.stretch.y, up.z * grid.stretch.z};
}

std::uint64_t node_count(const std::vector<Spans>& nodes);

/// The nodes of slab x whose height is at most `limit`.
Spans nodes_up_to(const Spans& spans, std::int64_t x, const NodeHeights& heights, double limit);

/// Nodes of a set up to a height.
struct FillLevel
{
    double height = 0; ///< of the highest node, dp; that of the lowest node of the set if none is
    std::uint64_t nodes = 0;
};

/// All nodes up to a given height, NodeHeights::tolerance included.
FillLevel level_at(const std::vector<Spans>& nodes, const NodeHeights& heights, double limit,
                   int threads);

/// The whole layers, from the lowest one up, that hold as nearly as possible a number of nodes; of
/// two numbers equally near the smaller one.
FillLevel level_of_count(const std::vector<Spans>& nodes, const NodeHeights& heights, double count,
                         int threads);

} // namespace fppg
