#include "relax/lattice_strips.h"

#include "fppg/vres.h"

#include "relax/inlet_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

Box3 grown(const Box3& box, double by)
{
    return {box.min - Vec3{by, by, by}, box.max + Vec3{by, by, by}};
}

bool contains(const Box3& box, const Vec3& p)
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) return false;
    return true;
}

/// The box of all nodes of runs and particles of walls.
Box3 extent_of(const RunField& field)
{
    const LatticeGrid& grid = field.grid;
    Box3 box;
    for (std::size_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& run : field.slabs[x])
            for (const std::uint32_t z : {run.z_begin, run.z_end - 1})
                box.add(grid.place(
                    {static_cast<double>(x), static_cast<double>(run.y), static_cast<double>(z)}));
    for (const Vec3& p : field.walls.particles.positions) box.add(p);
    return box;
}

} // namespace

LatticeStrips::LatticeStrips(const CaseDef& def, const RunField& field)
    : reach_(2 * def.h + def.grid.dp),
      before_inlet_(off_inlets_dp * def.grid.dp),
      is_2d_(def.vres.is_2d),
      points_(reach_, 16)
{
    constexpr double far = std::numeric_limits<double>::infinity();
    inside_ = {{-far, -far, -far}, {far, far, far}};
    const LatticeGrid& grid = field.grid;
    const std::array<bool, 3>& is_periodic = grid.is_periodic;
    if (is_periodic != std::array<bool, 3>{})
    {
        // Particles may end before the lattice does (set_period() warns of it).
        const Box3 extent = extent_of(field);
        const Vec3 first = grid.origin;
        const Vec3 last = grid.place({grid.n[0] - 1.0, grid.n[1] - 1.0, grid.n[2] - 1.0});
        for (int axis = 0; axis < 3; ++axis)
        {
            if (!is_periodic[static_cast<std::size_t>(axis)]) continue;
            const double half = grid.step(axis) / 2;
            inside_.min[axis] = std::max(first[axis], extent.min[axis]) - half + reach_;
            inside_.max[axis] = std::min(last[axis], extent.max[axis]) + half - reach_;
        }
    }
    for (const InletNode& node : inlet_nodes(def.solver.inout, field))
    {
        points_.add(node.place);
        point_ways_.push_back(node.zone.way);
    }
    for (const InletShape& shape : def.solver.inout.shapes)
    {
        zones_.push_back(grown(shape.box, reach_));
        zone_ways_.push_back(shape.way);
    }
    for (std::size_t z = 0; z < def.vres.zones.size(); ++z)
        if (def.vres.zones[z].parent == static_cast<int>(def.zone))
            children_.push_back(resized(def.vres.zones[z].outer_begin, reach_, def.vres.is_2d));
    if (def.zone > 0 && def.zone < def.vres.zones.size())
        own_ = resized(def.vres.zones[def.zone].inner, -reach_, def.vres.is_2d);
}

bool LatticeStrips::has(const Vec3& p) const
{
    return !contains(inside_, p) || has_beside_buffer(p) || has_beside_inlet(p);
}

bool LatticeStrips::has_beside_inlet(const Vec3& p) const
{
    return std::any_of(zones_.begin(), zones_.end(),
                       [&](const Box3& zone) { return contains(zone, p); }) ||
           points_.has_nearer(p, reach_);
}

bool LatticeStrips::is_behind_inlet(const Vec3& p) const
{
    for (std::size_t z = 0; z < zones_.size(); ++z)
    {
        const Box3 box = grown(zones_[z], -reach_);
        const Vec3 half = 0.5 * (box.max - box.min);
        const Vec3& way = zone_ways_[z];
        const double face =
            half.x * std::abs(way.x) + half.y * std::abs(way.y) + half.z * std::abs(way.z);
        if (contains(zones_[z], p) && dot(p - (box.min + half), way) < face + before_inlet_)
            return true;
    }
    const std::optional<std::uint32_t> near = points_.nearest(p, reach_);
    return near && dot(p - points_.points()[*near], point_ways_[*near]) < before_inlet_;
}

bool LatticeStrips::has_beside_buffer(const Vec3& p) const
{
    const auto is_in = [&](const ZoneBox& box) { return is_within(box, p, is_2d_); };
    return (own_ && !is_in(*own_)) || std::any_of(children_.begin(), children_.end(), is_in);
}

} // namespace fppg
