#pragma once

#include "offset/depth_bricks.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// An edge of a cell is 4 axis + 2 u + v: u and v (0 or 1) are its place along the two axes that
/// follow cyclically.
inline constexpr int edges_of_cell = 12;

/// The feet of two places are so much farther apart than the places where the surface has a crease
/// between them: behind a round wall they are R / (R - depth) apart.
inline constexpr double foot_jump = 2.5;

/// A vertex of the offset surface.
struct DualVertex
{
    Vec3 position;
    bool is_on_crease = false;
};

/// A cell through which the surface passes.
struct DualCell
{
    std::uint32_t first = 0; ///< its first vertex, of the brick
    /// Per edge the vertex, counted from the first, of the sheet that crosses it, or -1.
    std::array<std::int8_t, edges_of_cell> vertex{};
};

/// What a node of the grid is to the surface.
enum class NodeSide : std::uint8_t
{
    Unknown,
    Shallow,
    Deep,
};

/// The vertices of a brick.
struct DualBrick
{
    std::vector<NodeSide> sides; ///< brick_nodes^3, z fastest
    std::vector<DualVertex> vertices;
    std::vector<DualCell> cells;
    /// Per cell of the brick its index in `cells`, or -1.
    std::array<std::int16_t, brick_cells * brick_cells * brick_cells> index{};

    NodeSide side(const std::array<int, 3>& n) const
    {
        const int at = (n[0] * brick_nodes + n[1]) * brick_nodes + n[2];
        return sides[static_cast<std::size_t>(at)];
    }
};

/// What bricks are made from.
struct DualSource
{
    const WallDepth& wall;
    const DepthGrid& grid;
};

/// A vertex per sheet of the surface in every cell whose eight corners are known.
DualBrick make_dual_brick(const DualSource& from, const DepthBrick& brick, double depth);

} // namespace fppg
