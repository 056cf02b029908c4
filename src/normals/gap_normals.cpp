#include "normals/gap_normals.h"

#include "meshes/point_grid.h"

#include <cstdint>

namespace fppg
{
namespace
{

constexpr double beside_mouth = 1.75;  ///< dp, from the end of a wall to particles of its face
constexpr double reach_of_mouth = 3.6; ///< dp, to these from the gap
constexpr double same_place = 1e-3;    ///< dp
constexpr double same_way = 0.95;      ///< cosine

/// A particle that closes a gap at its mouth.
struct Mouth
{
    const GapParticle* gap = nullptr;
    bool is_wet = false;            ///< a particle of the wall looks out beside it
    std::vector<std::size_t> turns; ///< ids
};

} // namespace

void turn_to_mouths(const RunField& field, const CaseParticles& particles,
                    std::vector<std::array<float, 3>>& normals)
{
    const double dp = field.grid.dp;
    const OffLatticeParticles& all = particles.off_lattice;
    std::vector<Mouth> mouths;
    PointGrid grid(reach_of_mouth * dp, 0);
    for (const GapParticle& gap : field.walls.gaps)
        if (gap.to_mouth != Vec3{} && !normals.empty())
        {
            mouths.push_back({&gap, false, {}});
            grid.add(gap.place);
        }
    if (mouths.empty()) return;
    const auto is_at = [&](const Vec3& p, const Vec3& q) { return norm(p - q) < same_place * dp; };
    std::size_t id = 0;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type == ParticleType::Fluid) break; // behind all others
        for (const ParticleRun& run : block.runs)
        {
            for (std::uint32_t k = 0; k < run.count && run.is_off_lattice; ++k, ++id)
            {
                const std::uint64_t i = run.off_lattice_begin() + k;
                const Vec3 n{normals[id][0], normals[id][1], normals[id][2]};
                grid.for_each_near(
                    all.positions[i], reach_of_mouth * dp,
                    [&](std::uint32_t m, double)
                    {
                        const GapParticle& gap = *mouths[m].gap;
                        if (is_at(all.positions[i], gap.place) || is_at(all.positions[i], gap.wall))
                            mouths[m].turns.push_back(id);
                        else if (norm(all.positions[i] - gap.wall) < beside_mouth * dp &&
                                 all.layers[i] == 1 && all.kinds[i] == FitKind::Surface &&
                                 dot(n, gap.to_mouth) > same_way * norm(n) * norm(gap.to_mouth))
                            mouths[m].is_wet = true;
                    });
            }
            if (!run.is_off_lattice) id += run.count;
        }
    }
    for (const Mouth& mouth : mouths)
        for (const std::size_t at : mouth.turns)
            if (mouth.is_wet)
                for (int axis = 0; axis < 3; ++axis)
                    normals[at][static_cast<std::size_t>(axis)] =
                        static_cast<float>(mouth.gap->to_mouth[axis]);
}

} // namespace fppg
