#include "app/layer_gaps.h"

#include "meshes/point_grid.h"
#include "particles/initials.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace fppg
{
namespace
{

constexpr double closed_dp = 0.1;
constexpr double wide_dp = 1.8;
constexpr double in_closed_dp = 1.3; ///< to a row that closes the gap
/// Fluid so near to a gap can come into it, dp.
constexpr double beside_dp = 4;

/// Walls that face each other have normals that are so far opposed, cosine.
constexpr double facing = -0.7;

/// Calls visit(place, normal) with the surface before each particle of the first layer of a block.
template <typename Visit>
void for_each_foot(const CaseParticles& particles, const ParticleBlock& block, const Visit& visit)
{
    const OffLatticeParticles& all = particles.off_lattice;
    const Transform map = motion_of(block);
    for (const ParticleRun& run : block.runs)
    {
        if (!run.is_off_lattice) continue;
        for (std::uint64_t i = run.off_lattice_begin(); i < run.off_lattice_begin() + run.count;
             ++i)
        {
            if (all.layers[i] != 1) continue;
            const Vec3 outward{all.normals[i][0], all.normals[i][1], all.normals[i][2]};
            const Vec3 foot = all.positions[i] - outward * double{all.distances[i]};
            visit(map(foot), map(foot + outward) - map(foot));
        }
    }
}

Box3 box_of_fluid(const CaseParticles& particles)
{
    Box3 out;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type != ParticleType::Fluid) continue;
        const Transform map = motion_of(block);
        for (const ParticleRun& run : block.runs)
            for (const std::uint32_t k : {0U, run.count - 1})
                if (run.count > 0) out.add(map(place_in_run(particles, block, run, k)));
    }
    return out;
}

struct Gap
{
    double width = std::numeric_limits<double>::infinity(); ///< metres
    Vec3 place;
};

/// The surfaces of fixed walls, and how near they come to a place of another wall.
class FixedWalls
{
public:
    /// Those in a box, grown by the width of a gap.
    FixedWalls(const CaseParticles& particles, const Box3& near, double dp)
        : grid_(wide_dp * dp, 0), dp_(dp)
    {
        for (const ParticleBlock& block : particles.blocks)
            if (block.type == ParticleType::Fixed)
                for_each_foot(particles, block,
                              [&](const Vec3& p, const Vec3& n)
                              {
                                  if (!near.has(p, (beside_dp + wide_dp) * dp)) return;
                                  grid_.add(p);
                                  normals_.push_back(n);
                                  mks_.push_back(block.mk_type);
                              });
    }

    /// By mkbound, the widths of gaps that they leave before a place.
    std::map<std::uint16_t, double> gaps_at(const Vec3& p, const Vec3& normal) const
    {
        std::map<std::uint16_t, double> out;
        grid_.for_each_near(p, wide_dp * dp_,
                            [&](std::uint32_t at, double)
                            {
                                if (!(dot(normals_[at], normal) < facing)) return;
                                const double width = std::abs(dot(grid_.points()[at] - p, normal));
                                const auto [known, is_new] = out.try_emplace(mks_[at], width);
                                if (!is_new) known->second = std::min(known->second, width);
                            });
        std::erase_if(out, [&](const auto& gap) { return gap.second < closed_dp * dp_; });
        return out;
    }

private:
    PointGrid grid_;
    std::vector<Vec3> normals_;
    std::vector<std::uint16_t> mks_;
    double dp_;
};

} // namespace

std::vector<std::string> check_layer_gaps(const CaseDef& def, const CaseParticles& particles,
                                          const std::vector<GapParticle>& closed)
{
    const double dp = def.grid.dp;
    std::vector<std::string> out;
    if (def.solver.boundary != 2 || particles.off_lattice.layers.empty()) return out;
    const auto moves = [](const ParticleBlock& b) { return b.type == ParticleType::Moving; };
    if (std::none_of(particles.blocks.begin(), particles.blocks.end(), moves)) return out;
    const Box3 fluid = box_of_fluid(particles);
    if (fluid.is_empty()) return out;
    const FixedWalls fixed(particles, fluid, dp);
    PointGrid rows(wide_dp * dp, closed.size());
    for (const GapParticle& gap : closed) rows.add(gap.place);
    for (const ParticleBlock& block : particles.blocks)
    {
        if (!moves(block)) continue;
        std::map<std::uint16_t, Gap> gaps;
        for_each_foot(
            particles, block,
            [&](const Vec3& p, const Vec3& normal)
            {
                if (!fluid.has(p, beside_dp * dp) || rows.has_nearer(p, in_closed_dp * dp)) return;
                for (const auto& [other, width] : fixed.gaps_at(p, normal))
                    if (Gap& gap = gaps[other]; width < gap.width) gap = {width, p};
            });
        for (const auto& [other, gap] : gaps)
            out.push_back(fmt::format(
                "{}: mkbound {} moves {:.2g} dp from mkbound {}, at ({:g}, {:g}, {:g}): "
                "between layers of modified boundaries fluid goes through such a gap, which "
                "is closed on the lattice. Draw one part up to the other to close it.",
                def.file, block.mk_type, gap.width / dp, other, gap.place.x, gap.place.y,
                gap.place.z));
    }
    return out;
}

} // namespace fppg
