#include "offset/depth_bricks.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

/// Half of a cube's diagonal over its side, with room for rounding.
constexpr double half_diagonal = 0.8660254037844387 + 1e-6;

struct Cube
{
    std::array<std::int64_t, 3> first{0, 0, 0}; ///< cell
    std::int64_t size = 0;                      ///< cells
    /// Metres; no corner or middle of it, or of a part of it, is farther from the surface.
    double within = std::numeric_limits<double>::infinity();
};

/// Whether the surface may pass through a cube of cells. Its `within` is made tighter.
bool may_hold(const WallDepth& wall, const DepthGrid& grid, Cube& cube, double depth)
{
    const double half = 0.5 * static_cast<double>(cube.size);
    const Vec3 middle =
        grid.node(cube.first[0], cube.first[1], cube.first[2]) + (half * grid.cell) * Vec3{1, 1, 1};
    const double reach = 2 * half * half_diagonal * grid.cell;
    const DepthPlace place = wall.at(middle, cube.within);
    const double distance = norm(place.nearest - middle);
    cube.within = (distance + reach) * (1 + 1e-9);
    if (std::fabs(distance - depth) <= reach)
        return distance <= reach || !wall.is_surely_before(middle, place);
    // At a mitre the depth is less than the distance, and jumps where another side is as near.
    return place.depth > 0 && distance > depth && distance - reach < longest_mitre * depth &&
           (place.depth < depth + reach ||
            wall.has_mitre_near(middle, longest_mitre * depth + reach));
}

} // namespace

DepthGrid depth_grid(const WallDepth& wall, const OffsetOptions& options)
{
    Box3 box;
    for (const Vec3& v : wall.mesh().vertices) box.add(v);
    DepthGrid grid;
    grid.cell = options.cell;
    // Fractions of a cell, so that planes of a case do not fall onto nodes.
    const std::array<double, 3> shift{0.371, 0.437, 0.293};
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        const double room = options.depth + 2 * grid.cell;
        grid.origin[axis] = box.min[axis] - room - shift[a] * grid.cell;
        grid.cells[a] = static_cast<std::int64_t>(
            std::ceil((box.max[axis] + room - grid.origin[axis]) / grid.cell));
    }
    if (options.plane_y)
    {
        grid.origin.y = *options.plane_y - grid.cell;
        grid.cells[1] = 2;
    }
    return grid;
}

std::vector<DepthBrick> find_bricks(const WallDepth& wall, const DepthGrid& grid,
                                    const OffsetOptions& options, int threads)
{
    std::int64_t size = brick_cells;
    const std::int64_t most = *std::max_element(grid.cells.begin(), grid.cells.end());
    while (size < most) size *= 2;
    std::vector<Cube> cubes{{{0, 0, 0}, size}};
    while (true)
    {
        std::vector<char> stays(cubes.size());
        parallel_for(
            cubes.size(), threads,
            [&](std::size_t i) { stays[i] = may_hold(wall, grid, cubes[i], options.depth); }, 16);
        std::vector<Cube> next;
        const std::int64_t half = size / 2;
        for (std::size_t i = 0; i < cubes.size(); ++i)
        {
            if (stays[i] == 0) continue;
            if (size == brick_cells)
            {
                next.push_back(cubes[i]);
                continue;
            }
            for (std::int64_t part = 0; part < 8; ++part)
            {
                Cube cube{cubes[i].first, half, cubes[i].within};
                cube.first[0] += (part >> 2 & 1) * half;
                cube.first[1] += (part >> 1 & 1) * half;
                cube.first[2] += (part & 1) * half;
                if (cube.first[0] < grid.cells[0] && cube.first[1] < grid.cells[1] &&
                    cube.first[2] < grid.cells[2])
                    next.push_back(cube);
            }
        }
        cubes = std::move(next);
        if (size == brick_cells) break;
        size = half;
    }
    std::vector<DepthBrick> bricks(cubes.size());
    for (std::size_t i = 0; i < cubes.size(); ++i) bricks[i].first = cubes[i].first;
    return bricks;
}

namespace
{

class BrickFiller
{
public:
    BrickFiller(const WallDepth& wall, const DepthGrid& grid, double depth, DepthBrick& brick)
        : wall_(wall), grid_(grid), depth_(depth), brick_(brick)
    {
        constexpr int all = brick_nodes * brick_nodes * brick_nodes;
        brick.nodes.assign(static_cast<std::size_t>(all), {});
        is_seen_.assign(brick.nodes.size(), 0);
    }

    /// within  metres, as in Cube
    void descend(const std::array<int, 3>& first, int size, double within)
    {
        Cube cube{
            {brick_.first[0] + first[0], brick_.first[1] + first[1], brick_.first[2] + first[2]},
            size,
            within};
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (cube.first[axis] >= grid_.cells[axis]) return;
        if (size < brick_cells && !may_hold(wall_, grid_, cube, depth_)) return;
        if (size == 2)
        {
            for (int i = 0; i <= 2; ++i)
                for (int j = 0; j <= 2; ++j)
                    for (int k = 0; k <= 2; ++k)
                        look({first[0] + i, first[1] + j, first[2] + k}, cube.within);
            return;
        }
        const int half = size / 2;
        for (int part = 0; part < 8; ++part)
            descend({first[0] + (part >> 2 & 1) * half, first[1] + (part >> 1 & 1) * half,
                     first[2] + (part & 1) * half},
                    half, cube.within);
    }

private:
    void look(const std::array<int, 3>& n, double within)
    {
        const int number = (n[0] * brick_nodes + n[1]) * brick_nodes + n[2];
        const auto at = static_cast<std::size_t>(number);
        if (is_seen_[at] != 0) return;
        is_seen_[at] = 1;
        const Vec3 p =
            grid_.node(brick_.first[0] + n[0], brick_.first[1] + n[1], brick_.first[2] + n[2]);
        const DepthPlace place = wall_.at(p, within);
        DepthNode& node = brick_.nodes[at];
        node.foot = place.foot;
        node.direction = place.direction;
        node.depth = place.depth;
        node.is_known = !place.is_beyond_rim;
    }

    const WallDepth& wall_;
    const DepthGrid& grid_;
    double depth_;
    DepthBrick& brick_;
    std::vector<char> is_seen_;
};

} // namespace

void fill_brick(const WallDepth& wall, const DepthGrid& grid, double depth, DepthBrick& brick)
{
    BrickFiller(wall, grid, depth, brick)
        .descend({0, 0, 0}, brick_cells, std::numeric_limits<double>::infinity());
}

} // namespace fppg
