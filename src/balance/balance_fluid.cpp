#include "fppg/balance.h"

#include "balance/balancer.h"
#include "balance/fluid_at_rest.h"
#include "balance/lattice_fall.h"
#include "balance/stable_packing.h"
#include "balance/take_places.h"
#include "balance/wall_pressure.h"
#include "particles/initials.h"
#include "relax/all_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace fppg
{
namespace
{

/// Where fluid on a stable lattice keeps more than this in the mean, the cubic one is tried too.
constexpr double calm_packed = 0.01;
/// Where more of the fluid near walls is not held by them, none is balanced.
constexpr double most_falling = 0.6;

/// Why a case is not balanced; empty where it is.
std::string reason_against(const CaseDef& def, const CaseConstants& constants,
                           const CaseParticles& particles)
{
    if (!def.balances()) return "the case does not ask for it";
    if (!(constants.b > 0)) return "constant B, and with it pressure, is not above zero";
    for (const ParticleBlock& block : particles.blocks)
    {
        if (!motion_of(block).is_identity() || scatters(block))
            return fmt::format("<initials> moves particles of mk {}", block.mk);
        if (block.type == ParticleType::Fluid && sets_density(block))
            return fmt::format("<initials> sets the density of mk {}", block.mk);
    }
    return {};
}

RestBoundary boundary_of(const CaseDef& def)
{
    if (def.solver.boundary != 2) return RestBoundary::Dbc;
    return def.solver.slip_mode == 1 ? RestBoundary::Mdbc : RestBoundary::Mdbc2;
}

std::size_t near_walls(const FluidAtRest& rest)
{
    return static_cast<std::size_t>(
        std::count(rest.roles.begin(), rest.roles.end(), RestRole::Moving));
}

/// Of the same fluid on two lattices.
bool is_calmer(const BalanceReport& a, const BalanceReport& b)
{
    if (a.is_balanced != b.is_balanced) return a.is_balanced;
    return a.after.mean < b.after.mean;
}

struct AtRest
{
    FluidAtRest fluid;
    BalanceReport report;
};

struct Balancing
{
    const CaseParticles& particles;
    RestWalls walls;
    int threads = 1;
    const std::function<bool(const BalanceProgress&)>& on_iteration;

    /// On the most stable lattice; nothing where it stays on its own.
    std::optional<AtRest> packed(const FluidAtRest& rest, const BalanceReport& report) const
    {
        const double gap = walls.boundary == RestBoundary::Dbc ? rest.dp / 2 : 0;
        std::optional<FluidAtRest> fluid = packed_stably(
            rest, particles, {walls.closest, least_distance_dp(walls.boundary) * rest.dp, gap},
            threads);
        if (!fluid) return std::nullopt;
        AtRest out{std::move(*fluid), report};
        out.report.is_packed = true;
        out.report.particles = near_walls(out.fluid);
        bring_to_rest(out.fluid, LatticeFall(), walls, threads, on_iteration, out.report);
        return out;
    }

    AtRest on_lattice(FluidAtRest rest, const BalanceReport& report, const LatticeGrid& grid,
                      double mass_fluid) const
    {
        double deepest = 0;
        for (std::size_t i = 0; i < rest.size(); ++i)
            if (rest.moves(i))
                deepest = std::max(deepest, rest.levels[i] - rest.height(rest.positions[i]));
        const LatticeFall fall(rest, grid, mass_fluid, deepest);
        AtRest out{std::move(rest), report};
        bring_to_rest(out.fluid, fall, walls, threads, on_iteration, out.report);
        return out;
    }

    /// What the walls hold of fluid that they do not hold as a whole: beside a hollow body without
    /// layers, say, and not the tank that it floats in.
    AtRest but_what_falls(AtRest all, const LatticeGrid& grid, double mass_fluid) const
    {
        if (static_cast<double>(all.report.falling) >
            most_falling * static_cast<double>(all.report.particles))
            return all;
        AtRest out = on_lattice(all.fluid, all.report, grid, mass_fluid);
        return out.report.is_balanced ? std::move(out) : std::move(all);
    }
};

} // namespace

BalanceReport balance_fluid(const CaseDef& def, const RunField& field,
                            const CaseConstants& constants, CaseParticles& particles, int threads,
                            const std::function<bool(const BalanceProgress&)>& on_iteration)
{
    BalanceReport report;
    report.why_not = reason_against(def, constants, particles);
    if (!report.why_not.empty() || !particles.off_lattice.has_walls()) return report;
    const AllWalls all(field.walls.bodies, field.grid, threads);
    if (all.is_empty()) return report;
    RestReach reach;
    reach.band_dp = balanced_bands(def);
    reach.threads = threads;
    reach.closest = [&](const Vec3& p, double within) { return all.closest_point(p, within); };
    FluidAtRest rest = gather_fluid(def, field, constants, particles, reach);
    report.particles = near_walls(rest);
    if (report.particles == 0) return report;
    report.held = hold_free_faces(rest, threads);
    if (near_walls(rest) == 0)
    {
        report.why_not = "all fluid near walls is at free faces, or where one depth meets another";
        report.particles = 0;
        return report;
    }
    RestWalls walls{reach.closest, boundary_of(def), def.solver.no_penetration};
    const std::vector<FittedBody>& bodies = field.walls.bodies;
    if (walls.boundary == RestBoundary::Dbc &&
        std::any_of(bodies.begin(), bodies.end(), [](const FittedBody& b) { return b.is_inside; }))
        walls.is_behind = [&](const Vec3& p, double within)
        { return bodies[all.closest(p, within).body].is_inside; };
    const Balancing balancing{particles, walls, threads, on_iteration};
    std::optional<AtRest> out;
    if (packs(def, particles)) out = balancing.packed(rest, report);
    if (!out || out->report.after.mean > calm_packed)
    {
        AtRest other =
            balancing.on_lattice(std::move(rest), report, field.grid, constants.mass_fluid);
        if (!other.report.is_balanced && (!out || !out->report.is_balanced))
            other = balancing.but_what_falls(std::move(other), field.grid, constants.mass_fluid);
        if (!out || is_calmer(other.report, out->report)) out = std::move(other);
    }
    take_over(def, out->fluid, threads, particles);
    return out->report;
}

} // namespace fppg
