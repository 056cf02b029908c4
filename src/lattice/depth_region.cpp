#include "lattice/depth_region.h"

#include "fppg/shapes.h"

#include "shapes/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace fppg
{

SlabRegion depth_region(const TriangleSoup& soup, double depth_min, double depth_max,
                        const LatticeGrid& grid, int threads)
{
    const auto query = std::make_shared<const MeshQuery>(soup, threads);
    const auto inside = std::make_shared<const SpanSet>(inside_spans(soup, grid, threads));
    SlabRegion region;
    region.x_begin = inside->x_begin;
    region.x_end = inside->x_begin + static_cast<std::uint32_t>(inside->slabs.size());
    region.emit = [=](std::uint32_t slab, Spans& out)
    {
        const double x = grid.origin.x + slab * grid.dp;
        for (const Span& s : inside->slabs[slab - inside->x_begin])
        {
            const double y = grid.origin.y + s.y * grid.dp;
            for (std::uint32_t z = s.z_begin; z < s.z_end;)
            {
                const double depth =
                    query->closest_point({x, y, grid.origin.z + z * grid.dp}).distance;
                const bool is_taken = depth >= depth_min && depth <= depth_max;
                // A node k steps on is at most k dp nearer or farther: those that cannot have
                // another answer are not asked.
                double sure = 0;
                if (is_taken)
                    sure = std::min(depth - depth_min, depth_max - depth);
                else
                    sure = depth < depth_min ? depth_min - depth : depth - depth_max;
                const double steps = std::min(std::ceil(sure / grid.dp * (1 - 1e-9)), 1e9);
                const std::uint32_t end =
                    std::min(s.z_end, z + std::max<std::uint32_t>(
                                              1, static_cast<std::uint32_t>(std::max(0.0, steps))));
                if (is_taken) out.push_back({s.y, z, end});
                z = end;
            }
        }
    };
    return region;
}

} // namespace fppg
