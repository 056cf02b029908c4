#include "nodes/cell_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{
namespace
{

/// The corner of the lattice cell around a point that is nearest to it.
Node nearest_node(const Vec3& p, const LatticeGrid& grid)
{
    const auto round_of = [&](int axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.step(axis);
        return to_index(std::ceil(index - 0.5));
    };
    return {round_of(0), round_of(1), round_of(2)};
}

} // namespace

CellCorners cell_corners(const Vec3& p, const LatticeGrid& grid)
{
    const auto floor_of = [&](int axis)
    {
        const double index = (p[axis] - grid.origin[axis]) / grid.step(axis);
        return to_index(std::floor(index));
    };
    const Node low{floor_of(0), floor_of(1), floor_of(2)};
    CellCorners out;
    std::array<double, 8> squared;
    for (int corner = 0; corner < 8; ++corner)
    {
        const Node n{low.x + (corner >> 2), low.y + (corner >> 1 & 1), low.z + (corner & 1)};
        if (!is_inside(n, grid)) continue;
        const Vec3 away = position(n, grid) - p;
        const double d = dot(away, away);
        auto at = static_cast<std::size_t>(out.count++);
        for (; at > 0 && d < squared[at - 1]; --at)
        {
            squared[at] = squared[at - 1];
            out.nodes[at] = out.nodes[at - 1];
        }
        squared[at] = d;
        out.nodes[at] = n;
    }
    return out;
}

std::optional<Node> find_node_in(const std::vector<Spans>& slabs, const Vec3& p,
                                 const LatticeGrid& grid)
{
    const auto is_held = [&](const Node& n)
    {
        return contains(slabs[static_cast<std::size_t>(n.x)], static_cast<std::uint32_t>(n.y),
                        static_cast<std::uint32_t>(n.z));
    };
    // Mostly it is the nearest of all.
    const Node nearest = nearest_node(p, grid);
    if (is_inside(nearest, grid) && is_held(nearest)) return nearest;
    const CellCorners corners = cell_corners(p, grid);
    const auto* end = corners.nodes.begin() + corners.count;
    const auto* found = std::find_if(corners.nodes.begin(), end, is_held);
    return found == end ? std::nullopt : std::optional(*found);
}

bool contains(const Spans& spans, std::uint32_t y, std::uint32_t z)
{
    const auto after =
        std::upper_bound(spans.begin(), spans.end(), std::pair(y, z),
                         [](const std::pair<std::uint32_t, std::uint32_t>& at, const Span& s)
                         { return at.first < s.y || (at.first == s.y && at.second < s.z_begin); });
    return after != spans.begin() && std::prev(after)->y == y && z < std::prev(after)->z_end;
}

std::vector<Spans> by_slab(SpanSet set, const LatticeGrid& grid)
{
    std::vector<Spans> out(grid.n[0]);
    for (std::size_t i = 0; i < set.slabs.size(); ++i)
        out[set.x_begin + i] = std::move(set.slabs[i]);
    return out;
}

} // namespace fppg
