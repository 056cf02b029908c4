#include "particles/floating.h"

#include "particles/initials.h"
#include "particles/run_positions.h"

namespace fppg
{
namespace
{

/// Calls body(place, share) for the particles of a block in id order.
template <typename Body>
void for_each_place(const CaseParticles& particles, const ParticleBlock& block,
                    const std::vector<InitialOp>& initials, const Body& body)
{
    InitialState state;
    std::uint64_t place = 0;
    for (const ParticleRun& run : block.runs)
        for (std::uint32_t k = 0; k < run.count; ++k)
        {
            state.position = place_in_run(particles, block, run, k);
            state.place = place++;
            if (!initials.empty()) apply_initials(initials, state);
            const bool has_share = run.is_off_lattice && !particles.off_lattice.shares.empty();
            body(state.position,
                 has_share ? double{particles.off_lattice.shares[run.off_lattice_begin() + k]}
                           : 1.0);
        }
}

} // namespace

FloatingBody floating_body(const FloatingDef& def, const CaseParticles& nodes,
                           std::size_t block_index, const std::vector<InitialOp>& initials,
                           double rhop0)
{
    const ParticleBlock& block = nodes.blocks[block_index];
    const double dp = nodes.grid.dp;
    const double volume = nodes.grid.is_2d ? dp * dp : dp * dp * dp;
    Vec3 sum;
    double n = 0; // of whole particles
    for_each_place(nodes, block, initials,
                   [&](const Vec3& p, double share)
                   {
                       n += share;
                       sum = sum + share * p;
                   });

    FloatingBody body;
    body.block = block_index;
    body.mass_body = def.mass_body ? *def.mass_body : def.rhop_body.value_or(0) * n * volume;
    body.mass_part = def.distribute_mass ? body.mass_body / static_cast<double>(block.count)
                                         : def.mass_part.value_or(rhop0 * volume);
    body.center = def.center.value_or(sum / n);
    if (def.inertia)
    {
        body.inertia = *def.inertia;
        return body;
    }
    std::array<Vec3, 3> rows{};
    for_each_place(nodes, block, initials,
                   [&](const Vec3& p, double share)
                   {
                       const Vec3 d = p - body.center;
                       const Vec3 by_share = share * d;
                       rows[0].x += by_share.y * d.y + by_share.z * d.z;
                       rows[1].y += by_share.x * d.x + by_share.z * d.z;
                       rows[2].z += by_share.x * d.x + by_share.y * d.y;
                       rows[0].y -= by_share.x * d.y;
                       rows[0].z -= by_share.x * d.z;
                       rows[1].z -= by_share.y * d.z;
                   });
    rows[1].x = rows[0].y;
    rows[2].x = rows[0].z;
    rows[2].y = rows[1].z;
    for (std::size_t i = 0; i < 3; ++i) body.inertia[i] = body.mass_body / n * rows[i];
    return body;
}

} // namespace fppg
