#include "relax/open_levels.h"

#include "core/parallel.h"
#include "nodes/run_at.h"
#include "relax/wall_planes.h"

#include <algorithm>

namespace fppg
{
namespace
{

constexpr double reach_of_roofs = 2.2; ///< above the highest node of a column, dp
/// Less than this of the way to a wall is upwards: it is beside the column.
constexpr double leaning = 0.05;
constexpr std::uint32_t nodes_of_roofs = 2; ///< the same of walls on nodes

} // namespace

OpenLevels::OpenLevels(const RunField& given, const UpAxis& up, std::uint16_t bound_first,
                       const ClosestWallPoint& closest, int threads)
    : upward_(std::in_place, given, up, threads), bound_first_(bound_first)
{
    const RunField& field = upward_->field();
    const std::size_t slabs = field.slabs.size();
    first_.assign(slabs + 1, 0);
    for (std::size_t x = 0; x < slabs; ++x) first_[x + 1] = first_[x] + field.slabs[x].size();
    DisjointSets<std::size_t> sets(first_.back());
    for (std::size_t x = 0; x < slabs; ++x)
    {
        join_columns(sets, x, x, 0);
        join_columns(sets, x, x, 1);
        if (x + 1 < slabs) join_columns(sets, x, x + 1, 0);
    }
    levels_.assign(first_.back(), no_level);
    parallel_for(slabs, threads,
                 [&](std::size_t x)
                 {
                     for (std::size_t i = 0; i < field.slabs[x].size(); ++i)
                         if (is_open(x, i, closest))
                             levels_[first_[x] + i] =
                                 static_cast<std::int64_t>(field.slabs[x][i].z_end) - 1;
                 });
    for (std::size_t i = 0; i < levels_.size(); ++i)
    {
        std::int64_t& level = levels_[sets.find(i)];
        level = std::max(level, levels_[i]);
    }
    for (std::size_t i = 0; i < levels_.size(); ++i) levels_[i] = levels_[sets.find(i)];
}

/// Joins the runs of fluid of a slab with those at the same height in the columns beside, or above.
///
/// to_x, to_y  the slab of those columns, and how much farther along y they are
void OpenLevels::join_columns(DisjointSets<std::size_t>& sets, std::size_t x, std::size_t to_x,
                              std::uint32_t to_y) const
{
    const std::vector<Run>& from = upward_->field().slabs[x];
    const std::vector<Run>& to = upward_->field().slabs[to_x];
    const std::uint32_t touching = x == to_x && to_y == 0 ? 1 : 0;
    std::size_t next = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
    {
        const Run& a = from[i];
        if (!is_fluid(a)) continue;
        const std::uint32_t y = a.y + to_y;
        while (next < to.size() &&
               (to[next].y < y || (to[next].y == y && to[next].z_end + touching <= a.z_begin)))
            ++next;
        for (std::size_t k = next;
             k < to.size() && to[k].y == y && to[k].z_begin < a.z_end + touching; ++k)
            if (is_fluid(to[k])) sets.join(first_[x] + i, first_[to_x] + k);
    }
}

bool OpenLevels::is_open(std::size_t x, std::size_t i, const ClosestWallPoint& closest) const
{
    const std::vector<Run>& runs = upward_->field().slabs[x];
    const Run& run = runs[i];
    if (!is_fluid(run)) return false;
    if (i + 1 < runs.size() && runs[i + 1].y == run.y &&
        runs[i + 1].z_begin < run.z_end + nodes_of_roofs)
        return false;
    const LatticeGrid& grid = upward_->field().grid;
    const Vec3 top = grid.place(
        {static_cast<double>(x), static_cast<double>(run.y), static_cast<double>(run.z_end - 1)});
    const WallPlanes walls =
        find_wall_planes(upward_->turned_back(top), reach_of_roofs * grid.dp, closest);
    return std::none_of(walls.begin(), walls.end(),
                        [&](const WallPlane& wall)
                        { return upward_->turned(wall.normal).z > leaning; });
}

bool OpenLevels::is_above(const Node& node, const Node& of_fluid) const
{
    if (!upward_) return false;
    const Node at = upward_->turned(of_fluid);
    const Run* run = run_at(upward_->field(), at);
    if (run == nullptr) return false;
    const auto x = static_cast<std::size_t>(at.x);
    const auto i = static_cast<std::size_t>(run - upward_->field().slabs[x].data());
    const std::int64_t level = levels_[first_[x] + i];
    return level != no_level && upward_->turned(node).z > level;
}

} // namespace fppg
