#include "balance/fluid_at_rest.h"

#include "fppg/balance.h"

#include "balance/pressure_sums.h"
#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "particles/particle_stream.h"
#include "particles/run_positions.h"
#include "relax/group_list.h"
#include "relax/lattice_strips.h"
#include "relax/near_blocks.h"

#include <algorithm>

namespace fppg
{
namespace
{

constexpr double list_skin_dp = 0.6;
constexpr std::uint32_t whole_lattice = 1U << 20U; ///< nodes a side of a block that holds all

struct NearParticle
{
    std::uint64_t id = 0;
    const ParticleBlock* block = nullptr;
    Vec3 position;
    float rhop = 0;
};

/// Those of particles [first, last) that lie in the blocks of nodes around fitted walls, run after
/// run.
RawArray<NearParticle> near_particles(const CaseParticles& particles, const NearBlocks& blocks,
                                      float rhop0, std::uint64_t first, std::uint64_t last,
                                      int threads)
{
    const ParticleStream stream(particles, first, last, particles_per_piece);
    std::vector<std::vector<NearParticle>> of_piece(stream.pieces());
    const auto gather = [&](const ParticleSegment& part, std::vector<NearParticle>& out)
    {
        const ParticleRun& run = *part.run;
        const ParticleBlock& block = *part.block;
        const std::uint32_t end = part.offset + part.count;
        const auto take = [&](std::uint32_t k)
        {
            const std::uint64_t id = part.id + (k - part.offset);
            out.push_back({id, &block, place_in_run(particles, block, run, k),
                           density_in_run(particles, block, run, k, id, rhop0)});
        };
        if (run.is_off_lattice)
        {
            for (std::uint32_t k = part.offset; k < end; ++k) take(k);
            return;
        }
        Run nodes;
        nodes.y = run.y;
        nodes.z_begin = block.run_descending ? run.z + 1 - end : run.z + part.offset;
        nodes.z_end = nodes.z_begin + part.count;
        blocks.for_each_stretch(run.x, nodes,
                                [&](std::uint32_t z, std::uint32_t z_end)
                                {
                                    for (; z < z_end; ++z)
                                        take(block.run_descending ? run.z - z : z - run.z);
                                });
    };
    parallel_for(stream.pieces(), threads,
                 [&](std::size_t p) {
                     stream.for_each_segment(
                         p, [&](const ParticleSegment& part) { gather(part, of_piece[p]); });
                 });
    std::vector<std::size_t> begin(stream.pieces() + 1, 0);
    for (std::size_t p = 0; p < stream.pieces(); ++p) begin[p + 1] = begin[p] + of_piece[p].size();
    RawArray<NearParticle> out(begin.back());
    parallel_for(stream.pieces(), threads,
                 [&](std::size_t p)
                 {
                     std::copy(of_piece[p].begin(), of_piece[p].end(),
                               out.begin() + static_cast<std::ptrdiff_t>(begin[p]));
                     of_piece[p] = {};
                 });
    return out;
}

double mass_of(const NearParticle& p, const CaseConstants& constants,
               const CaseParticles& particles)
{
    if (p.block->type == ParticleType::Fluid) return constants.mass_fluid;
    for (const FloatingBody& body : particles.floatings)
        if (&particles.blocks[body.block] == p.block) return body.mass_part;
    return constants.mass_bound;
}

/// A particle of the result.
struct Taken
{
    const NearParticle* particle = nullptr;
    RestRole role{};
};

/// Fills all arrays, in the order of a Morton curve over cells of eight particles.
void take_all(const RawArray<Taken>& taken, const CaseConstants& constants,
              const CaseParticles& particles, int threads, FluidAtRest& rest)
{
    constexpr std::size_t chunk = 4096;
    const std::size_t n = taken.size();
    PointArrays points;
    points.resize(n);
    rest.set_in_dp([&](std::size_t i) { return taken[i].particle->position; }, threads, points);
    const std::vector<std::uint32_t> order = morton_order(points, 2, threads);
    rest.resize(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const NearParticle& p = *taken[order[i]].particle;
            const RestRole role = taken[order[i]].role;
            const bool is_fluid = role != RestRole::Bound;
            const double pressure = is_fluid ? rest.pressure_of_density(double{p.rhop}) : 0;
            rest.ids[i] = p.id;
            rest.roles[i] = role;
            rest.positions[i] = p.position;
            rest.masses[i] = mass_of(p, constants, particles);
            rest.pressures[i] = pressure;
            rest.densities[i] = is_fluid ? double{p.rhop} : rest.rhop0;
            rest.levels[i] = rest.height(p.position) + pressure / rest.pressure_per_depth();
            rest.ghosts[i] = {};
            if (is_fluid || particles.bound_normals.empty()) return;
            const auto& normal = particles.bound_normals[p.id];
            rest.ghosts[i] = 2.0 * Vec3{double{normal[0]}, double{normal[1]}, double{normal[2]}};
        },
        chunk);
}

/// All fluid that is joined to what moves near walls moves along; what falls through the air stays.
void take_joined(const RawArray<NearParticle>& fluid, const std::vector<char>& may_move, double dp,
                 std::vector<RestRole>& roles)
{
    PointGrid grid(joined_dp * dp, fluid.size());
    std::vector<std::uint32_t> next;
    for (std::uint32_t i = 0; i < fluid.size(); ++i)
    {
        grid.add(fluid[i].position);
        if (roles[i] == RestRole::Moving) next.push_back(i);
    }
    while (!next.empty())
    {
        const std::uint32_t i = next.back();
        next.pop_back();
        grid.for_each_near(fluid[i].position, joined_dp * dp,
                           [&](std::uint32_t other, double)
                           {
                               if (may_move[other] == 0 || roles[other] != RestRole::Held) return;
                               roles[other] = RestRole::Along;
                               next.push_back(other);
                           });
    }
}

/// Far from fitted walls, fluid beside other ones stays on the lattice with them.
void hold_at_other_walls(const RawArray<NearParticle>& fluid, const RawArray<NearParticle>& bound,
                         const std::vector<char>& near_bound, double reach,
                         std::vector<RestRole>& roles)
{
    PointGrid walls(reach, bound.size());
    for (std::size_t i = 0; i < bound.size(); ++i)
        if (near_bound[i] != 0) walls.add(bound[i].position);
    for (std::size_t i = 0; i < fluid.size(); ++i)
        if (roles[i] == RestRole::Along && walls.has_nearer(fluid[i].position, reach))
            roles[i] = RestRole::Held;
}

} // namespace

std::optional<int> vertical_axis(const FluidAtRest& rest)
{
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(rest.gravity[axis]) > (1 - 1e-9) * norm(rest.gravity)) return axis;
    return std::nullopt;
}

std::vector<double> balanced_bands(const CaseDef& def)
{
    // Farther from walls than the reach of kernels, fluid lies as even as it was made.
    const double least = 2 * def.h / def.grid.dp + 1.5;
    std::vector<double> out(65536, 0);
    for (std::uint16_t mk = 0; mk < def.mk_bound_first; ++mk)
        if (const FluidBand* band = fluid_band(def, mk))
            out[mk] = band->is_active && band->balances ? std::max(least, band->width_dp) : 0;
    return out;
}

bool packs(const CaseDef& def, const CaseParticles& particles)
{
    return std::all_of(particles.blocks.begin(), particles.blocks.end(),
                       [&](const ParticleBlock& block)
                       {
                           if (block.type != ParticleType::Fluid) return true;
                           const FluidBand* band = fluid_band(def, block.mk);
                           return band == nullptr || band->packs;
                       });
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
    rest.gravity = def.constants.rest_gravity();
    rest.is_2d = constants.is_2d;
    rest.is_cubic = def.solver.kernel == 1;

    double widest = 0;
    for (const double band : reach.band_dp) widest = std::max(widest, band);
    const double forces = rest_reach_dp(rest) + list_skin_dp + 0.1;
    const auto side = static_cast<std::uint32_t>(std::ceil(std::max(widest, forces))) + 1;
    const bool is_whole = particles.n_fluid <= most_balanced_whole;
    const auto rhop0 = static_cast<float>(constants.rhop0);
    const OffLatticeParticles& off_lattice = particles.off_lattice;
    const NearBlocks blocks(off_lattice.positions, field.grid, is_whole ? whole_lattice : side, 2,
                            reach.threads,
                            [&](std::size_t i) { return off_lattice.is_of_wall(i); });

    const std::uint64_t first_fluid = particles.np - particles.n_fluid;
    const RawArray<NearParticle> fluid =
        near_particles(particles, blocks, rhop0, first_fluid, particles.np, reach.threads);
    const LatticeStrips strips(def, field);
    std::vector<RestRole> roles(fluid.size(), RestRole::Held);
    std::vector<char> may_move(fluid.size(), 0);
    parallel_for(
        fluid.size(), reach.threads,
        [&](std::size_t i)
        {
            const double band = reach.band_dp[fluid[i].block->mk] * rest.dp;
            const Vec3& p = fluid[i].position;
            if (band <= 0 || strips.has(p)) return;
            may_move[i] = 1;
            if (norm(reach.closest(p, band) - p) <= band) roles[i] = RestRole::Moving;
        },
        256);
    if (is_whole) take_joined(fluid, may_move, rest.dp, roles);
    const auto moving = static_cast<std::size_t>(
        roles.size() - std::count(roles.begin(), roles.end(), RestRole::Held));
    if (moving == 0) return rest;
    PointGrid movers(forces * rest.dp, moving);
    for (std::size_t i = 0; i < fluid.size(); ++i)
        if (roles[i] != RestRole::Held) movers.add(fluid[i].position);
    rest.origin = movers.points().front();
    const auto near_of = [&](const RawArray<NearParticle>& from, const auto& is_taken)
    {
        std::vector<char> is_near(from.size(), 0);
        parallel_for(
            from.size(), reach.threads,
            [&](std::size_t i)
            { is_near[i] = is_taken(i) || movers.has_nearer(from[i].position, forces * rest.dp); },
            256);
        return is_near;
    };
    const std::vector<char> near_fluid =
        near_of(fluid, [&](std::size_t i) { return roles[i] != RestRole::Held; });
    const NearBlocks around(movers.points(), field.grid,
                            static_cast<std::uint32_t>(std::ceil(forces)) + 1, 1, reach.threads);
    const RawArray<NearParticle> bound =
        near_particles(particles, around, rhop0, 0, first_fluid, reach.threads);
    const std::vector<char> near_bound = near_of(bound, [](std::size_t) { return false; });
    if (is_whole) hold_at_other_walls(fluid, bound, near_bound, forces * rest.dp, roles);
    RawArray<Taken> taken;
    taken.reserve(static_cast<std::size_t>(std::count(near_fluid.begin(), near_fluid.end(), 1) +
                                           std::count(near_bound.begin(), near_bound.end(), 1)));
    for (std::size_t i = 0; i < fluid.size(); ++i)
        if (near_fluid[i]) taken.push_back({&fluid[i], roles[i]});
    for (std::size_t i = 0; i < bound.size(); ++i)
        if (near_bound[i]) taken.push_back({&bound[i], RestRole::Bound});
    take_all(taken, constants, particles, reach.threads, rest);
    return rest;
}

std::size_t hold_around(FluidAtRest& rest, const std::vector<char>& is_meant, int threads)
{
    PointGrid meant(2 * rest.h,
                    static_cast<std::size_t>(std::count_if(is_meant.begin(), is_meant.end(),
                                                           [](char m) { return m != 0; })));
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (is_meant[i] != 0) meant.add(rest.positions[i]);
    std::vector<char> is_held(rest.size(), 0);
    parallel_for(
        rest.size(), threads,
        [&](std::size_t i)
        { is_held[i] = rest.moves(i) && meant.has_nearer(rest.positions[i], 2 * rest.h) ? 1 : 0; },
        1024);
    std::size_t count = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
        if (is_held[i] == 0) continue;
        count += rest.roles[i] == RestRole::Moving ? 1 : 0;
        rest.roles[i] = RestRole::Held;
    }
    return count;
}

std::size_t hold_free_faces(FluidAtRest& rest, int threads)
{
    // Of a lattice, the rows at a free face have 0.6 to 0.7 / h, those at a sheet 0.5 at most.
    constexpr double least = 0.55;
    constexpr double level_cosine = 0.7;
    // Neighbours in one basin have levels that differ by less: columns end at nodes.
    constexpr double beside_dp = 1.5;
    constexpr double level_jump_dp = 2;
    const auto levels_jump = [&](std::size_t i, std::size_t j)
    {
        return rest.roles[j] != RestRole::Bound &&
               std::abs(rest.levels[i] - rest.levels[j]) > level_jump_dp * rest.dp &&
               norm(rest.positions[i] - rest.positions[j]) < beside_dp * rest.dp;
    };
    const Vec3 up = rest.gravity / -norm(rest.gravity);
    const double scale = rest.slope_scale();
    // Volumes of 1 and pressures that add up to 1: the sums are those of the kernel's slope.
    PressureField field;
    field.resize(rest.size());
    rest.set_in_dp([&](std::size_t i) { return rest.positions[i]; }, threads, field.points);
    parallel_for(
        rest.size(), threads,
        [&](std::size_t i)
        {
            field.pressures[i] = 0.5F;
            field.packed[i] =
                PackedPoint{field.points.x[i], field.points.y[i], field.points.z[i], 1};
        },
        4096);
    GroupList list(static_cast<float>(rest_reach_dp(rest)), 0);
    list.build(
        field.points, threads, [&](std::size_t i) { return rest.moves(i); },
        [](std::size_t) { return true; });
    const PairShape shape{static_cast<float>(rest.h / rest.dp), rest.is_cubic};
    std::vector<char> is_face(rest.size(), 0);
    list.for_each_group(
        threads,
        [&](const PointGroup& group)
        {
            const PressureSums sums = pressure_sums(field, group, shape);
            for (std::size_t l = 0; l < group.count; ++l)
            {
                const Vec3 outward = -scale * sums.of(l);
                const double size = norm(outward);
                const std::uint32_t i = group.points[l];
                is_face[i] = (size * rest.h > least && dot(outward, up) < level_cosine * size) ||
                             std::any_of(group.near.begin(), group.near.end(),
                                         [&](std::uint32_t j) { return levels_jump(i, j); });
            }
        });
    return hold_around(rest, is_face, threads);
}

} // namespace fppg
