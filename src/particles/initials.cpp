#include "particles/initials.h"

#include "fppg/error.h"

#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fppg
{
namespace
{

double speed_at(const ProfileVelocity& profile, double z)
{
    double sum = 0;
    for (std::size_t i = 0; i < profile.z.size(); ++i)
    {
        double weight = 1; // Lagrange's polynomial that is 1 at z[i] and 0 at the others
        for (std::size_t j = 0; j < profile.z.size(); ++j)
            if (j != i) weight *= (z - profile.z[j]) / (profile.z[i] - profile.z[j]);
        sum += weight * profile.speeds[i];
    }
    return sum;
}

double value_at(const MeshValues& mesh, const Vec3& p)
{
    std::array<std::uint32_t, 3> low{};
    std::array<double, 3> share{};
    for (std::size_t a = 0; a < 3; ++a)
    {
        if (mesh.n[a] < 2) continue;
        const double along =
            dot(p - mesh.origin, mesh.steps[a]) / dot(mesh.steps[a], mesh.steps[a]);
        const double place = std::clamp(along, 0.0, static_cast<double>(mesh.n[a] - 1));
        low[a] = std::min(static_cast<std::uint32_t>(place), mesh.n[a] - 2);
        share[a] = place - low[a];
    }
    double sum = 0;
    for (unsigned corner = 0; corner < 8; ++corner)
    {
        double weight = 1;
        std::array<std::size_t, 3> node{};
        for (std::size_t a = 0; a < 3; ++a)
        {
            const unsigned up = corner >> a & 1U;
            weight *= up != 0 ? share[a] : 1 - share[a];
            node[a] = low[a] + up;
        }
        // Without weight a corner may lie beyond the last node.
        if (weight > 0)
            sum += weight * mesh.values[node[0] + mesh.n[0] * (node[1] + mesh.n[1] * node[2])];
    }
    return sum;
}

int moved_axes(const RandomMove& op)
{
    return (op.width.x > 0) + (op.width.y > 0) + (op.width.z > 0);
}

std::shared_ptr<const std::vector<std::uint32_t>> random_numbers(const RandomMove& op,
                                                                 std::uint64_t particles)
{
    std::mt19937 generator(op.seed);
    generator.discard(37);
    auto numbers = std::make_shared<std::vector<std::uint32_t>>(
        particles * static_cast<std::uint64_t>(moved_axes(op)));
    for (std::uint32_t& n : *numbers) n = static_cast<std::uint32_t>(generator());
    return numbers;
}

bool moves_particles(const InitialOp& op)
{
    return std::holds_alternative<MoveParticles>(op.what) ||
           std::holds_alternative<RandomMove>(op.what);
}

/// Runs one operation on a particle that it selects.
struct Applier
{
    InitialState& state;

    void operator()(const UniformVelocity& op) const { state.velocity = op.velocity; }
    void operator()(const ProfileVelocity& op) const
    {
        state.velocity = speed_at(op, state.position.z) * op.direction;
    }
    void operator()(const WaveVelocity& op) const
    {
        const double k = std::sqrt(3 * op.height / (4 * op.depth * op.depth * op.depth));
        const double sech = 1 / std::cosh(k * (state.position.x - op.x0));
        const double u = std::sqrt(op.gravity / op.depth) * op.height * sech * sech;
        state.velocity = {op.is_negative ? -u : u, 0, 0};
    }
    void operator()(const UniformDensity& op) const { state.rhop = op.rhop; }
    void operator()(const GradientDensity& op) const
    {
        const Vec3 along = op.pos2 - op.pos1;
        const double share =
            std::clamp(dot(state.position - op.pos1, along) / dot(along, along), 0.0, 1.0);
        state.rhop = op.rhop1 + share * (op.rhop2 - op.rhop1);
    }
    void operator()(const DepthDensity& op) const
    {
        const double g = norm(*op.gravity);
        const bool is_uniform = g == 0 || *op.b == 0;
        const double depth =
            is_uniform ? 0 : std::max(0.0, dot(state.position - *op.surface, *op.gravity) / g);
        state.rhop = is_uniform
                         ? *op.rhop0
                         : *op.rhop0 * std::pow(1 + *op.rhop0 * g * depth / *op.b, 1 / *op.gamma);
    }
    void operator()(const MeshVelocity& op) const
    {
        for (int axis = 0; axis < 3; ++axis)
            state.velocity[axis] =
                value_at(*op.components[static_cast<std::size_t>(axis)], state.position);
    }
    void operator()(const MeshDensity& op) const
    {
        state.rhop = value_at(*op.densities, state.position);
    }
    void operator()(const MoveParticles& op) const
    {
        state.position = op.map(state.position);
        Transform turn = op.map;
        turn.offset = {};
        state.velocity = turn(state.velocity);
    }
    void operator()(const RandomMove& op) const
    {
        const auto axes = static_cast<std::size_t>(moved_axes(op));
        std::size_t at = state.place * axes;
        for (int axis = 0; axis < 3; ++axis)
        {
            if (!(op.width[axis] > 0)) continue;
            const double u = static_cast<double>((*op.numbers)[at++]) * 0x1p-32;
            state.position[axis] += (u - 0.5) * op.width[axis];
        }
    }
};

bool turns(const ParticleBlock& block)
{
    return motion_of(block).linear != Transform{}.linear;
}

/// Calls body(state) with particles of a block before `<initials>` that hold all its extremes; with
/// all of them on request.
template <typename Body>
void for_places(const CaseParticles& particles, const ParticleBlock& block, bool all,
                const Body& body)
{
    std::uint64_t begin = 0;
    for (const ParticleRun& run : block.runs)
    {
        if (run.count == 0) continue;
        const std::uint32_t step = all || run.is_off_lattice ? 1 : std::max(1u, run.count - 1);
        for (std::uint32_t k = 0; k < run.count; k += step)
        {
            InitialState state;
            state.position = place_in_run(particles, block, run, k);
            state.place = begin + k;
            body(state);
        }
        begin += run.count;
    }
}

/// The selected particle that stands highest against gravity; nothing without one.
std::optional<Vec3> highest_place(const CaseParticles& particles, const ParticleBlock& block,
                                  const PositionFilter& only, const Vec3& gravity)
{
    std::optional<Vec3> best;
    for_places(particles, block, true,
               [&](InitialState state)
               {
                   apply_initials(block.initials, state);
                   if (!only.contains(state.position)) return;
                   if (!best || dot(state.position, gravity) < dot(*best, gravity))
                       best = state.position;
               });
    return best;
}

/// The operations of one mk; those before stand in block.initials already.
void add_initial(const CaseDef& def, const CaseConstants& constants, const CaseParticles& particles,
                 InitialOp op, ParticleBlock& block)
{
    const ConstantsDef& c = def.constants;
    if (auto* wave = std::get_if<WaveVelocity>(&op.what)) wave->gravity = norm(c.gravity);
    if (auto* depth = std::get_if<DepthDensity>(&op.what))
    {
        if (!depth->gravity) depth->gravity = c.gravity;
        if (!depth->rhop0) depth->rhop0 = c.rhop0;
        if (!depth->gamma) depth->gamma = c.gamma;
        if (!depth->b) depth->b = constants.b;
        if (!depth->surface)
            depth->surface = highest_place(particles, block, op.only, *depth->gravity)
                                 .value_or(Vec3{}); // where nothing is selected it is not used
    }
    if (auto* random = std::get_if<RandomMove>(&op.what))
        random->numbers = random_numbers(*random, block.count);
    block.initials.push_back(std::move(op));
}

} // namespace

bool scatters(const ParticleBlock& block)
{
    return std::any_of(block.initials.begin(), block.initials.end(),
                       [](const InitialOp& op)
                       { return std::holds_alternative<RandomMove>(op.what); });
}

bool sets_density(const ParticleBlock& block)
{
    return std::any_of(block.initials.begin(), block.initials.end(),
                       [](const InitialOp& op)
                       {
                           return std::holds_alternative<UniformDensity>(op.what) ||
                                  std::holds_alternative<GradientDensity>(op.what) ||
                                  std::holds_alternative<DepthDensity>(op.what) ||
                                  std::holds_alternative<MeshDensity>(op.what);
                       });
}

void set_limits(const CaseDef& def, CaseParticles& particles)
{
    Box3 all;
    for (const ParticleBlock& block : particles.blocks)
    {
        Box3 box;
        for_places(particles, block, turns(block) || scatters(block),
                   [&](InitialState state)
                   {
                       apply_initials(block.initials, state);
                       box.add(state.position);
                   });
        if (box.is_empty()) continue;
        all.add(box.min);
        all.add(box.max);
        if (motion_of(block).is_identity() && !scatters(block)) continue;
        for (int axis = 0; axis < 3; ++axis)
        {
            // Room for the rounding of the moves; GenCase v5.4.354 takes a node moved to pointmax.
            const double room = 1e-9 * def.grid.dp;
            const bool is_flat = def.grid.is_2d && axis == 1;
            const double low = def.case_pos_min[axis] - room;
            const double high = (is_flat ? def.case_pos_min : def.case_pos_max)[axis] + room;
            if (box.min[axis] >= low && box.max[axis] <= high) continue;
            const auto last =
                std::find_if(block.initials.rbegin(), block.initials.rend(), moves_particles);
            throw CaseError(
                def.file, last->line,
                fmt::format("<initials>: particles of mk{} {} are moved to {} = {:g}, outside the "
                            "domain {:g} to {:g}; check <move>, <moverandom> and <rotateaxis>",
                            block.type == ParticleType::Fluid ? "fluid" : "bound", block.mk_type,
                            "xyz"[axis], box.min[axis] < low ? box.min[axis] : box.max[axis],
                            low + room, high - room));
        }
    }
    if (all.is_empty()) return;
    particles.pos_min = all.min;
    particles.pos_max = all.max;
}

void apply_initials(const std::vector<InitialOp>& initials, InitialState& state)
{
    for (const InitialOp& op : initials)
        if (op.only.contains(state.position)) std::visit(Applier{state}, op.what);
}

Transform motion_of(const ParticleBlock& block)
{
    Transform map;
    for (const InitialOp& op : block.initials)
        if (const auto* move = std::get_if<MoveParticles>(&op.what)) map = move->map * map;
    return map;
}

void set_initials(const CaseDef& def, const CaseConstants& constants, CaseParticles& particles)
{
    bool moves = false;
    for (const InitialOp& op : def.initials)
        for (ParticleBlock& block : particles.blocks)
        {
            if (block.mk != op.mk) continue;
            add_initial(def, constants, particles, op, block);
            moves = moves || moves_particles(op);
        }
    if (moves) set_limits(def, particles);
}

} // namespace fppg
