#include "relax/cut_nodes.h"

#include "core/parallel.h"
#include "nodes/spans.h"
#include "relax/region_volume.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fppg
{
namespace
{

/// Nodes that are missing for want of room are no farther behind the innermost layer, dp.
constexpr double missing_dp = 1.5;

/// Of what a later draw or a void cut out of a solid.
void add_cut_nodes(const RunField& field, const Region& region, const AllWalls& all, int threads,
                   PointGrid& cut)
{
    const LatticeGrid& grid = field.grid;
    const FittedWalls& walls = field.walls;
    double deepest = 0;
    for (std::uint32_t b = 0; b < walls.bodies.size(); ++b)
        if (region.band[walls.owner_of(b).mk] > 0)
            deepest = std::max(deepest, walls.bodies[b].depth);
    const double within = deepest + missing_dp * grid.dp;
    const std::size_t slabs = field.slabs.size();
    std::vector<Spans> taken(slabs), own(slabs);
    for (std::size_t x = 0; x < slabs; ++x)
    {
        for (const Run& run : field.slabs[x])
        {
            taken[x].push_back({run.y, run.z_begin, run.z_end});
            if (region.band[run.mk] > 0) own[x].push_back({run.y, run.z_begin, run.z_end});
        }
        sort_and_join(taken[x]);
    }
    std::vector<std::vector<Vec3>> found(slabs);
    parallel_for(slabs, threads,
                 [&](std::size_t x)
                 {
                     Spans beside;
                     if (x > 0) beside = own[x - 1];
                     if (x + 1 < slabs)
                         beside.insert(beside.end(), own[x + 1].begin(), own[x + 1].end());
                     for (const Span& s : own[x])
                     {
                         if (s.y > 0) beside.push_back({s.y - 1, s.z_begin, s.z_end});
                         if (s.y + 1 < grid.n[1]) beside.push_back({s.y + 1, s.z_begin, s.z_end});
                         beside.push_back({s.y, s.z_begin > 0 ? s.z_begin - 1 : 0,
                                           std::min<std::uint32_t>(s.z_end + 1, grid.n[2])});
                     }
                     sort_and_join(beside);
                     for (const Span& s : subtract(beside, taken[x]))
                         for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
                         {
                             const Vec3 p = place_of({static_cast<std::uint32_t>(x), s.y, z}, grid);
                             if (std::isinf(all.closest(p, within).distance)) found[x].push_back(p);
                         }
                 });
    for (const std::vector<Vec3>& places : found)
        for (const Vec3& p : places) cut.add(p);
}

} // namespace

PointGrid places_of_cuts(const RunField& field, const Region& region, const AllWalls& all,
                         int threads)
{
    const FittedWalls& walls = field.walls;
    PointGrid cut(reach_of_cuts_dp * field.grid.dp, walls.cut.size() + walls.second_sheets.size());
    for (const Vec3& p : walls.cut) cut.add(p);
    // Before layers fluid sees the surface, however many of them a thin part has.
    const WallParticles& second = walls.second_sheets;
    if (!region.is_solid || !is_inside(walls, region))
        for (std::size_t i = 0; i < second.size(); ++i)
            if (region.is_solid || !walls.bodies[second.bodies[i]].is_layer())
                cut.add(second.positions[i]);
    if (region.is_solid) add_cut_nodes(field, region, all, threads, cut);
    return cut;
}

} // namespace fppg
