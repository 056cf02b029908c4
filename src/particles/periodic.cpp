#include "fppg/periodic.h"

#include "fppg/case_def.h"

#include "meshes/point_grid.h"
#include "nodes/domain.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

/// Of a pair nearer than this across the end of a period one goes, dp.
constexpr double least_gap_dp = 0.5;
/// The solver takes no particle just at the end of a period: rounding puts it out of the domain.
constexpr double off_end_dp = 1e-4;
/// Particles this near to the first or last node reach to it, dp.
constexpr double reach_dp = 0.75;

/// Which of some particles have another one too near one period on.
///
/// next  from a place to the next copy of it
std::vector<char> near_next_copy(const std::vector<Vec3>& positions, const LatticeGrid& grid,
                                 int axis, const Vec3& next)
{
    const double gap = least_gap_dp * grid.dp;
    const double first = grid.origin[axis];
    const double last = first + (grid.n[static_cast<std::size_t>(axis)] - 1) * grid.dp;
    std::vector<Vec3> copies; // of those at the begin of the period
    for (const Vec3& p : positions)
        if (p[axis] < first + grid.dp) copies.push_back(p + next);
    PointGrid near(gap, copies.size());
    for (const Vec3& p : copies) near.add(p);
    std::vector<char> out(positions.size(), 0);
    for (std::size_t i = 0; i < positions.size(); ++i)
        out[i] = positions[i][axis] > last - grid.dp && near.has_nearer(positions[i], gap) ? 1 : 0;
    return out;
}

template <typename Values>
void take_out(Values& values, const std::vector<char>& is_out)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (is_out[i] == 0) values[count++] = values[i];
    values.resize(count);
}

} // namespace

SeamsClosed close_seams(const CaseDef& def, RunField& field)
{
    const LatticeGrid& grid = field.grid;
    WallParticles& walls = field.walls.particles;
    VolumeParticles& volume = field.walls.volume;
    SeamsClosed done;
    if (std::find(grid.is_periodic.begin(), grid.is_periodic.end(), true) == grid.is_periodic.end())
        return done;
    std::vector<char> is_beyond(walls.size());
    for (std::size_t i = 0; i < walls.size(); ++i)
        is_beyond[i] = is_in_domain(walls.positions[i], grid) ? 0 : 1;
    walls.erase(is_beyond);
    const std::size_t before = walls.size() + volume.size();
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        if (!grid.is_periodic[a]) continue;
        Vec3 next = def.period_shift[a];
        next[axis] = grid.n[a] * grid.dp;
        const double low = grid.origin[axis] - 0.5 * grid.dp;
        for (Vec3& p : volume.positions)
        {
            if (p[axis] >= low && p[axis] < low + next[axis]) continue;
            p = p[axis] < low ? p + next : p - next;
            ++done.moved;
        }
        walls.erase(near_next_copy(walls.positions, grid, axis, next));
        const std::vector<char> is_out = near_next_copy(volume.positions, grid, axis, next);
        take_out(volume.positions, is_out);
        take_out(volume.mk, is_out);
        take_out(volume.distances, is_out);
        for (auto* positions : {&walls.positions, &volume.positions})
            for (Vec3& p : *positions)
                p[axis] = std::clamp(p[axis], low + off_end_dp * grid.dp,
                                     low + next[axis] - off_end_dp * grid.dp);
    }
    done.left_out = before - walls.size() - volume.size();
    return done;
}

void set_period(const CaseDef& def, CaseParticles& particles, std::vector<std::string>& warnings)
{
    if (particles.off_lattice.size() == 0) return;
    const LatticeGrid& grid = def.grid;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        if (!grid.is_periodic[a]) continue;
        const double first = grid.origin[axis];
        const double last = first + (grid.n[a] - 1) * grid.dp;
        const double reach = reach_dp * grid.dp;
        if (particles.pos_min[axis] <= first + reach && particles.pos_max[axis] >= last - reach)
        {
            particles.pos_min[axis] = first;
            particles.pos_max[axis] = last;
            continue;
        }
        warnings.push_back(fmt::format(
            "{}: the case is periodic along {}, but its particles, {:g} to {:g} m, do not reach "
            "from the first to the last node of the lattice ({:g} and {:g}): the solver's period, "
            "their extent and dp, is {:g} m. Let <definition> end where the period does.",
            def.file, "xyz"[axis], particles.pos_min[axis], particles.pos_max[axis], first, last,
            particles.pos_max[axis] - particles.pos_min[axis] + grid.dp));
    }
}

} // namespace fppg
