#include "nodes/snap.h"
#include "shapes/kinds.h"

#include <algorithm>
#include <cmath>

namespace fppg::kinds
{

/// A wave is cut at its box, which may reach beyond the domain.
Box3 bounds_of(const WaveOp&, double)
{
    return {};
}

SlabRegion nodes_of(const WaveOp& wave, const DrawState&, const LatticeGrid& grid)
{
    const Node low = snap(wave.corner, grid);
    const Node high = snap(wave.matrix(position(low, grid) + wave.size), grid);
    NodeBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        box.begin[k] = low[axis];
        box.end[k] = high[axis] + 1;
    }
    box = intersect(box, whole_lattice(grid));
    if (box.is_empty()) return {};
    SlabRegion region;
    region.x_begin = static_cast<std::uint32_t>(box.begin[0]);
    region.x_end = static_cast<std::uint32_t>(box.end[0]);
    region.emit = [wave, grid, box](std::uint32_t slab, Spans& out)
    {
        const double x = grid.origin.x + slab * grid.step(0);
        const double steepness = std::sqrt(3 * wave.h_max / (4 * std::pow(wave.depth, 3)));
        const double crest = 1 / std::cosh(steepness * (x - wave.x0));
        const double surface = wave.z0 + wave.depth + wave.h_max * crest * crest;
        std::int64_t first = box.begin[2];
        const double estimate =
            std::clamp((surface - grid.origin.z) / grid.step(2),
                       static_cast<double>(box.begin[2]) - 1, static_cast<double>(box.end[2]));
        auto last = static_cast<std::int64_t>(estimate);
        const auto is_below = [&](std::int64_t k)
        { return grid.origin.z + static_cast<double>(k) * grid.step(2) < surface; };
        if (!trim_interval(first, last, box.begin[2], box.end[2] - 1, is_below)) return;
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
            out.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(first),
                           static_cast<std::uint32_t>(last) + 1});
    };
    return region;
}

} // namespace fppg::kinds
