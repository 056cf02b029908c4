#include "convert/body_names.h"
#include "particles/initials.h"
#include "particles/particle_stream.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace fppg
{

namespace
{

static_assert(feed_piece == particles_per_piece);

/// Runs `<initials>` on the particles of a segment, which stand from `at` on in the piece.
void start_particles(const ParticleSegment& segment, std::size_t at, ParticlePiece& out)
{
    for (std::uint32_t k = 0; k < segment.count; ++k)
    {
        InitialState state{out.positions[at + k],
                           {},
                           out.densities[at + k],
                           segment.id + k - segment.block->begin};
        apply_initials(segment.block->initials, state);
        out.positions[at + k] = state.position;
        out.densities[at + k] = static_cast<float>(state.rhop);
        for (std::size_t a = 0; a < 3; ++a)
            out.velocities[at + k][a] = static_cast<float>(state.velocity[static_cast<int>(a)]);
    }
}

/// Kinds, volumes and outward normals of particles off the lattice.
void read_wall_facts(const CaseParticles& particles, const ParticleSegment& segment, std::size_t at,
                     ParticlePiece& out)
{
    const ParticleRun& run = *segment.run;
    if (!run.is_off_lattice) return;
    const OffLatticeParticles& from = particles.off_lattice;
    Transform turn = motion_of(*segment.block);
    turn.offset = {};
    for (std::size_t k = 0; k < segment.count; ++k)
    {
        const std::size_t i = run.off_lattice_begin() + segment.offset + k;
        out.kinds[at + k] = static_cast<std::uint8_t>(from.kinds[i]);
        if (!from.shares.empty()) out.volumes[at + k] *= double{from.shares[i]};
        if (out.normals.empty()) continue;
        const std::array<float, 3>& n = from.normals[i];
        const Vec3 normal = turn({n[0], n[1], n[2]});
        for (std::size_t a = 0; a < 3; ++a)
            out.normals[at + k][a] = static_cast<float>(normal[static_cast<int>(a)]);
    }
}

/// Where the case asks for normals of boundaries, these count.
void read_bound_normals(const CaseParticles& particles, ParticlePiece& out)
{
    const std::vector<std::array<float, 3>>& normals = particles.bound_normals;
    for (std::size_t k = 0; k < out.size() && out.first + k < normals.size(); ++k)
    {
        const std::array<float, 3>& n = normals[out.first + k];
        const double length = std::hypot(double{n[0]}, double{n[1]}, double{n[2]});
        for (std::size_t a = 0; a < 3; ++a)
            out.normals[k][a] = length > 0 ? static_cast<float>(n[a] / length) : 0;
    }
}

/// All of a segment that stands from `at` on in the piece but its positions and its body.
void read_segment(const CaseParticles& particles, float rhop0, const ParticleSegment& segment,
                  std::size_t at, ParticlePiece& out)
{
    for_each_density(particles, rhop0, segment,
                     [&](std::uint32_t k, float value) { out.densities[at + k] = value; });
    if (!segment.block->initials.empty()) start_particles(segment, at, out);
    if (out.wanted == PieceContent::All) read_wall_facts(particles, segment, at, out);
}

void read_case(const CaseParticles& particles, const ParticleFeed& facts,
               const ParticleStream& stream, std::size_t piece, ParticlePiece& out)
{
    const std::size_t n = stream.end(piece) - stream.begin(piece);
    const bool is_all = out.wanted == PieceContent::All;
    out.first = stream.begin(piece);
    out.positions.resize(n);
    out.densities.resize(n);
    out.bodies.resize(n);
    out.velocities.resize(n);
    if (is_all)
    {
        std::fill(out.velocities.begin(), out.velocities.end(), std::array<float, 3>{});
        out.volumes.assign(n, facts.unit_volume());
        out.normals.assign(facts.has_normals ? n : 0, {});
        out.ids.resize(n);
        out.kinds.assign(n, static_cast<std::uint8_t>(FitKind::Volume));
        for (std::size_t k = 0; k < n; ++k) out.ids[k] = static_cast<std::uint32_t>(out.first + k);
    }
    stream.for_each_segment(
        piece,
        [&](const ParticleSegment& segment)
        {
            const std::size_t at = segment.id - out.first;
            const auto body = static_cast<std::uint16_t>(segment.block - particles.blocks.data());
            if (out.wanted != PieceContent::Positions)
                std::fill_n(out.bodies.begin() + static_cast<std::ptrdiff_t>(at), segment.count,
                            body);
            if (out.wanted == PieceContent::Bodies) return;
            for_each_position(particles, segment,
                              [&](std::int64_t k, double x, double y, double z) {
                                  out.positions[at + static_cast<std::size_t>(k)] = {x, y, z};
                              });
            // <initials> may move particles.
            if (is_all || !segment.block->initials.empty())
                read_segment(particles, static_cast<float>(facts.rhop0), segment, at, out);
        });
    if (is_all && facts.has_normals) read_bound_normals(particles, out);
}

/// How many particles of volume dp^3 a body amounts to.
double shares_of(const CaseParticles& particles, const ParticleBlock& block)
{
    const std::vector<float>& shares = particles.off_lattice.shares;
    double sum = 0;
    for (const ParticleRun& run : block.runs)
    {
        if (!run.is_off_lattice || shares.empty())
        {
            sum += run.count;
            continue;
        }
        for (std::size_t k = 0; k < run.count; ++k)
            sum += double{shares[run.off_lattice_begin() + k]};
    }
    return sum;
}

} // namespace

ParticleFeed feed_of_case(const CaseDef& def, const CaseParticles& particles,
                          const CaseConstants& constants)
{
    ParticleFeed feed;
    feed.case_name = def.case_name;
    feed.count = particles.np;
    feed.is_2d = constants.is_2d;
    feed.y_2d = constants.y_2d;
    feed.dp = constants.dp;
    feed.h = constants.h;
    feed.rhop0 = constants.rhop0;
    feed.gamma = constants.gamma;
    feed.b = constants.b;
    feed.has_velocities = true;
    feed.has_normals = particles.has_walls || !particles.bound_normals.empty();
    feed.has_kinds = true;
    feed.has_volumes = true;
    std::vector<std::uint16_t> mk_types;
    for (const ParticleBlock& block : particles.blocks)
    {
        feed.bodies.push_back(
            {"", block.mk, block.type,
             block.type == ParticleType::Fluid ? constants.mass_fluid : constants.mass_bound});
        mk_types.push_back(block.mk_type);
    }
    for (const FloatingBody& floating : particles.floatings)
        feed.bodies[floating.block].mass =
            floating.mass_body / shares_of(particles, particles.blocks[floating.block]);
    name_bodies(def.casedef, mk_types, feed.bodies);
    const ParticleFeed facts = feed;
    const auto stream =
        std::make_shared<const ParticleStream>(particles, 0, particles.np, feed_piece);
    feed.read = [&particles, facts, stream](std::size_t piece, ParticlePiece& out)
    { read_case(particles, facts, *stream, piece, out); };
    return feed;
}

} // namespace fppg
