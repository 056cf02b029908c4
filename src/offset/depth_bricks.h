#pragma once

#include "offset/offset_surface.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Cells along a side of a brick.
inline constexpr int brick_cells = 8;
inline constexpr int brick_nodes = brick_cells + 1;

/// The grid of an offset surface: node (i, j, k) at origin + cell (i, j, k).
struct DepthGrid
{
    Vec3 origin;
    double cell = 0;
    std::array<std::int64_t, 3> cells{0, 0, 0}; ///< cells [0, cells)

    Vec3 node(std::int64_t i, std::int64_t j, std::int64_t k) const
    {
        return origin +
               cell * Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
    }
};

/// A node of the grid.
struct DepthNode
{
    Vec3 foot;
    Vec3 direction;
    double depth = 0;
    bool is_known = false; ///< looked at, and the wall is over it
};

/// A cube of brick_cells^3 cells through which the offset surface may pass.
struct DepthBrick
{
    std::array<std::int64_t, 3> first{0, 0, 0}; ///< its lowest cell
    std::vector<DepthNode> nodes; ///< brick_nodes^3, z fastest; empty but while it is looked at

    const DepthNode& node(int i, int j, int k) const
    {
        const int at = (i * brick_nodes + j) * brick_nodes + k;
        return nodes[static_cast<std::size_t>(at)];
    }
};

DepthGrid depth_grid(const WallDepth& wall, const OffsetOptions& options);

/// The bricks through which the surface may pass, in a fixed order: a cube is left out when the
/// distance of its middle differs from the depth by more than half its diagonal.
std::vector<DepthBrick> find_bricks(const WallDepth& wall, const DepthGrid& grid,
                                    const OffsetOptions& options, int threads);

/// Looks at the nodes of a brick near the surface.
void fill_brick(const WallDepth& wall, const DepthGrid& grid, double depth, DepthBrick& brick);

} // namespace fppg
