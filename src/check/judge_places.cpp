#include "check/judge_places.h"

#include "check/ghost_fit.h"
#include "check/judge_walls.h"
#include "core/parallel.h"

#include <atomic>

namespace fppg
{

std::uint64_t judge_places(const CheckParticles& particles, const CheckSetup& setup,
                           const ParticleColumns& walls, const ParticleColumns& fluid,
                           std::vector<std::uint16_t>& masks, int threads)
{
    // Distances of exactly that are none, also where files hold places in single precision.
    const double near_wall = 0.499 * setup.dp;
    const double close = 0.299 * setup.dp;
    const std::vector<Vec3> ways = periodic_ways(setup);
    std::atomic<std::uint64_t> pairs{0};
    parallel_for(
        particles.positions.size(), threads,
        [&](std::size_t i)
        {
            if ((masks[i] & bit_of(Fault::OutsideDomain)) != 0 &&
                !is_finite(particles.positions[i]))
                return;
            const bool is_fluid = particles.type[i] == ParticleType::Fluid;
            std::uint64_t later = 0;
            const auto look = [&](std::uint32_t j, const Vec3&, double squared)
            {
                const bool is_other_kind = is_fluid != (particles.type[j] == ParticleType::Fluid);
                if (is_fluid && is_other_kind && squared < near_wall * near_wall)
                    masks[i] |= bit_of(Fault::FluidNearWall);
                if (j == i || squared >= close * close) return false;
                masks[i] |= bit_of(Fault::ClosePair);
                if (i < j) ++later;
                return false;
            };
            for (const Vec3& way : ways)
            {
                const Vec3 p = particles.positions[i] + way;
                walls.find_near(p, is_fluid ? near_wall : close, look);
                fluid.find_near(p, close, look);
            }
            if (later > 0) pairs.fetch_add(later, std::memory_order_relaxed);
        },
        4096);
    return pairs;
}

} // namespace fppg
