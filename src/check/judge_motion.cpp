#include "check/judge_motion.h"

#include "particles/farthest_points.h"
#include "particles/motion_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace fppg
{

namespace
{

FarthestPoints farthest_points(const CheckParticles& particles, std::uint16_t mk)
{
    FarthestPoints out;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
        if (particles.mk[i] == mk && is_finite(particles.positions[i]))
            out.add(particles.positions[i]);
    return out;
}

struct Gap
{
    double least = 0;
    Vec3 place;
};

/// The least distance from a moving block to each other that does not move with it and is nearer
/// than 2 dp.
std::map<std::uint16_t, Gap> gaps_of(std::size_t own, const CheckParticles& particles,
                                     const CheckSetup& setup, const ParticleColumns& walls)
{
    const std::uint16_t mk = setup.moving[own].mk;
    const auto moves_with = [&](std::uint16_t other)
    {
        return std::any_of(
            setup.moving.begin(), setup.moving.end(),
            [&](const MovingBlock& b)
            { return b.mk == other && !b.places.empty() && b.places == setup.moving[own].places; });
    };
    std::map<std::uint16_t, Gap> out;
    for (std::size_t i = 0; i < particles.positions.size(); ++i)
    {
        if (particles.mk[i] != mk || !is_finite(particles.positions[i])) continue;
        walls.find_near(particles.positions[i], 2 * setup.dp,
                        [&](std::uint32_t j, const Vec3&, double squared)
                        {
                            const std::uint16_t other = particles.mk[j];
                            if (other == mk) return false;
                            const double distance = std::sqrt(squared);
                            const auto [at, is_new] =
                                out.try_emplace(other, Gap{distance, particles.positions[i]});
                            if (!is_new && distance < at->second.least)
                                at->second = {distance, particles.positions[i]};
                            return false;
                        });
    }
    std::erase_if(out, [&](const auto& gap) { return moves_with(gap.first); });
    return out;
}

} // namespace

std::vector<std::string> judge_motion(const CheckParticles& particles, const CheckSetup& setup,
                                      const ParticleColumns& walls)
{
    std::vector<std::string> out;
    for (std::size_t k = 0; k < setup.moving.size(); ++k)
    {
        const MovingBlock& block = setup.moving[k];
        const auto [speed, time] =
            top_speed(block.places, block.step, farthest_points(particles, block.mk).points());
        if (setup.speed_sound > 0 && 10 * speed > setup.speed_sound)
            out.push_back(fmt::format(
                "mk {}: its fastest particle has {:.3g} m/s at {:.3g} s, more than a tenth of the "
                "speed of sound, {:.3g} m/s: fluid beside it is compressed and gets into walls. "
                "Expected a speed of sound of {:.3g} m/s at least (speedsound).",
                block.mk, speed, time, setup.speed_sound, 10 * speed));
        for (const auto& [other, gap] : gaps_of(k, particles, setup, walls))
        {
            const bool is_told = std::any_of(
                setup.moving.begin(), setup.moving.begin() + static_cast<std::ptrdiff_t>(k),
                [&, o = other](const MovingBlock& b) { return b.mk == o; });
            if (is_told) continue;
            out.push_back(fmt::format(
                "mk {} and mk {} move against each other {:.2g} dp apart, at ({:.6g}, {:.6g}, "
                "{:.6g}): fluid that gets between them is pressed into them. A gap wants 2 dp at "
                "least.",
                block.mk, other, gap.least / setup.dp, gap.place.x, gap.place.y, gap.place.z));
        }
    }
    const double step = setup.speed_sound > 0 ? setup.cfl_number * setup.h / setup.speed_sound : 0;
    if (step > 0 && setup.least_step > step)
        out.push_back(
            fmt::format("DtMin is {:.3g} s, more than the step that the speed of sound allows "
                        "from the start, CFLnumber h / speedsound = {:.3g} s.",
                        setup.least_step, step));
    return out;
}

} // namespace fppg
