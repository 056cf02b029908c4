#include "balance/fluid_at_rest.h"

#include "balance/pressure_sums.h"
#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "particles/run_positions.h"
#include "relax/lattice_strips.h"
#include "relax/near_blocks.h"

#include <algorithm>

namespace fppg
{
namespace
{

constexpr double list_skin_dp = 0.6;

struct NearParticle
{
    std::uint64_t id = 0;
    const ParticleBlock* block = nullptr;
    Vec3 position;
    float rhop = 0;
};

/// Particles in the blocks of nodes around fitted walls, in the order of ids.
template <typename Wanted>
std::vector<NearParticle> near_particles(const CaseParticles& particles, const NearBlocks& blocks,
                                         float rhop0, const Wanted& wanted)
{
    std::vector<NearParticle> out;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (!wanted(block)) continue;
        std::uint64_t id = block.begin;
        for (const ParticleRun& run : block.runs)
        {
            const auto take = [&](std::uint32_t k)
            {
                out.push_back({id + k, &block, place_in_run(particles, block, run, k),
                               density_in_run(particles, block, run, k, id + k, rhop0)});
            };
            if (run.is_off_lattice)
                for (std::uint32_t k = 0; k < run.count; ++k) take(k);
            else
            {
                Run nodes;
                nodes.y = run.y;
                nodes.z_begin = block.run_descending ? run.z + 1 - run.count : run.z;
                nodes.z_end = nodes.z_begin + run.count;
                blocks.for_each_stretch(run.x, nodes,
                                        [&](std::uint32_t begin, std::uint32_t end)
                                        {
                                            for (std::uint32_t z = begin; z < end; ++z)
                                                take(block.run_descending ? run.z - z : z - run.z);
                                        });
            }
            id += run.count;
        }
    }
    return out;
}

void add(const NearParticle& p, RestRole role, double mass, FluidAtRest& rest)
{
    rest.ids.push_back(p.id);
    rest.roles.push_back(role);
    rest.positions.push_back(p.position);
    rest.masses.push_back(mass);
    const bool is_fluid = role != RestRole::Bound;
    const double pressure = is_fluid ? rest.pressure_of_density(double{p.rhop}) : 0;
    rest.pressures.push_back(pressure);
    rest.densities.push_back(is_fluid ? double{p.rhop} : rest.rhop0);
    rest.levels.push_back(rest.height(p.position) + pressure / rest.pressure_per_depth());
}

/// Puts all arrays into the order of a Morton curve over cells of eight particles.
void sort_along_curve(FluidAtRest& rest, int threads)
{
    const std::vector<std::uint32_t> order = morton_order(rest.in_dp(rest.positions), 2, threads);
    const auto permute = [&](auto& values)
    {
        auto sorted = values;
        for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
        values.swap(sorted);
    };
    permute(rest.ids);
    permute(rest.roles);
    permute(rest.positions);
    permute(rest.levels);
    permute(rest.masses);
    permute(rest.pressures);
    permute(rest.densities);
    permute(rest.ghosts);
}

double mass_of(const NearParticle& p, const CaseConstants& constants,
               const CaseParticles& particles)
{
    if (p.block->type == ParticleType::Fluid) return constants.mass_fluid;
    for (const FloatingBody& body : particles.floatings)
        if (&particles.blocks[body.block] == p.block) return body.mass_part;
    return constants.mass_bound;
}

} // namespace

PointArrays FluidAtRest::in_dp(std::span<const Vec3> points) const
{
    PointArrays out;
    out.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        const Vec3 at = (points[i] - origin) / dp;
        out.x[i] = static_cast<float>(at.x);
        out.y[i] = static_cast<float>(at.y);
        out.z[i] = static_cast<float>(at.z);
    }
    return out;
}

FluidAtRest gather_fluid(const CaseDef& def, const RunField& field, const CaseConstants& constants,
                         const CaseParticles& particles, const RestReach& reach)
{
    FluidAtRest rest;
    rest.dp = constants.dp;
    rest.h = constants.h;
    rest.rhop0 = constants.rhop0;
    rest.gamma = constants.gamma;
    rest.b = constants.b;
    rest.fullness = def.fluid_fullness;
    rest.gravity = constants.gravity;
    rest.is_2d = constants.is_2d;
    rest.is_cubic = def.solver.kernel == 1;

    double widest = 0;
    for (const double band : reach.band_dp) widest = std::max(widest, band);
    const double forces = rest_reach_dp(rest) + list_skin_dp + 0.1;
    const auto side = static_cast<std::uint32_t>(std::ceil(std::max(widest, forces))) + 1;
    const auto rhop0 = static_cast<float>(constants.rhop0);
    const NearBlocks blocks(field.walls.particles.positions, field.grid, side, 2);

    const std::vector<NearParticle> fluid = near_particles(
        particles, blocks, rhop0,
        [](const ParticleBlock& block) { return block.type == ParticleType::Fluid; });
    const LatticeStrips strips(def, field);
    std::vector<char> moves(fluid.size(), 0);
    parallel_for(
        fluid.size(), reach.threads,
        [&](std::size_t i)
        {
            const double band = reach.band_dp[fluid[i].block->mk] * rest.dp;
            if (band <= 0) return;
            const Vec3& p = fluid[i].position;
            moves[i] = norm(reach.closest(p, band) - p) <= band && !strips.has(p);
        },
        256);
    const auto moving = static_cast<std::size_t>(std::count(moves.begin(), moves.end(), 1));
    if (moving == 0) return rest;
    PointGrid movers(forces * rest.dp, moving);
    for (std::size_t i = 0; i < fluid.size(); ++i)
        if (moves[i]) movers.add(fluid[i].position);
    rest.origin = movers.points().front();
    const auto add_near = [&](const std::vector<NearParticle>& from, RestRole role, auto&& taken)
    {
        std::vector<char> is_near(from.size(), 0);
        parallel_for(
            from.size(), reach.threads,
            [&](std::size_t i)
            { is_near[i] = taken(i) || movers.has_nearer(from[i].position, forces * rest.dp); },
            256);
        for (std::size_t i = 0; i < from.size(); ++i)
            if (is_near[i])
                add(from[i], taken(i) ? RestRole::Moving : role,
                    mass_of(from[i], constants, particles), rest);
    };
    add_near(fluid, RestRole::Held, [&](std::size_t i) { return moves[i] != 0; });
    rest.ghosts.resize(rest.size());
    const std::vector<NearParticle> bound = near_particles(
        particles, blocks, rhop0,
        [](const ParticleBlock& block) { return block.type != ParticleType::Fluid; });
    add_near(bound, RestRole::Bound, [](std::size_t) { return false; });
    for (std::size_t i = rest.ghosts.size(); i < rest.size(); ++i)
    {
        Vec3 ghost;
        if (!particles.bound_normals.empty())
        {
            const auto& n = particles.bound_normals[rest.ids[i]];
            ghost = 2.0 * Vec3{double{n[0]}, double{n[1]}, double{n[2]}};
        }
        rest.ghosts.push_back(ghost);
    }
    sort_along_curve(rest, reach.threads);
    return rest;
}

std::size_t hold_free_faces(FluidAtRest& rest, const GroupList& list, int threads)
{
    // Of a lattice, the rows at a free face have 0.6 to 0.7 / h, those at a sheet 0.5 at most.
    constexpr double least = 0.55;
    constexpr double level_cosine = 0.7;
    const Vec3 up = rest.gravity / -norm(rest.gravity);
    const double scale = rest.slope_scale();
    // Volumes of 1 and pressures that add up to 1: the sums are those of the kernel's slope.
    PressureField field;
    field.points = rest.in_dp(rest.positions);
    field.pressures.assign(rest.size(), 0.5F);
    for (std::size_t i = 0; i < rest.size(); ++i)
        field.packed.push_back(
            PackedPoint{field.points.x[i], field.points.y[i], field.points.z[i], 1});
    const PairShape shape{static_cast<float>(rest.h / rest.dp), rest.is_cubic};
    std::vector<char> is_face(rest.size(), 0);
    list.for_each_group(threads,
                        [&](const PointGroup& group)
                        {
                            const PressureSums sums = pressure_sums(field, group, shape);
                            for (std::size_t l = 0; l < group.count; ++l)
                            {
                                const Vec3 outward = -scale * sums.of(l);
                                const double size = norm(outward);
                                is_face[group.points[l]] =
                                    size * rest.h > least && dot(outward, up) < level_cosine * size;
                            }
                        });
    std::vector<char> is_held = is_face;
    list.for_each_group(
        threads,
        [&](const PointGroup& group)
        {
            for (const std::uint32_t j : group.near)
                for (std::size_t l = 0; is_face[j] != 0 && l < group.count; ++l)
                    if (norm(rest.positions[group.points[l]] - rest.positions[j]) < 2 * rest.h)
                        is_held[group.points[l]] = 1;
        });
    std::size_t count = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (is_held[i])
        {
            rest.roles[i] = RestRole::Held;
            ++count;
        }
    return count;
}

} // namespace fppg
