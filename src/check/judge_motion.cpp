#include "check/judge_motion.h"

#include "check/judge_walls.h"
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

/// Gaps narrower than this are told, dp, and normals longer than this are not those of a first
/// layer.
constexpr double narrow_dp = 2;
constexpr double first_layer_dp = 0.75;
/// With modified boundaries nothing goes through a gap narrower than this, dp.
constexpr double closed_dp = 0.1;

/// Where the surface of a wall is: with modified boundaries at the end of the normals of its first
/// layer.
Vec3 surface_place(const CheckParticles& particles, const CheckSetup& setup, std::size_t i)
{
    const Vec3& p = particles.positions[i];
    if (setup.boundary != 2) return p;
    const Vec3 n = normal_of(particles, i);
    return norm(n) <= first_layer_dp * setup.dp ? p + n : p;
}

/// The least distance from a moving block to each other that does not move with it and is nearer
/// than narrow_dp.
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
        const Vec3 here = surface_place(particles, setup, i);
        walls.find_near(here, (narrow_dp + first_layer_dp) * setup.dp,
                        [&](std::uint32_t j, const Vec3&, double)
                        {
                            const std::uint16_t other = particles.mk[j];
                            if (other == mk) return false;
                            const double distance = norm(surface_place(particles, setup, j) - here);
                            if (distance > narrow_dp * setup.dp) return false;
                            const auto [at, is_new] = out.try_emplace(other, Gap{distance, here});
                            if (!is_new && distance < at->second.least)
                                at->second = {distance, here};
                            return false;
                        });
    }
    const double closed = setup.boundary == 2 ? closed_dp * setup.dp : 0;
    std::erase_if(
        out, [&](const auto& gap) { return moves_with(gap.first) || gap.second.least < closed; });
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
                "{:.6g}): {} A gap wants 2 dp at least.",
                block.mk, other, gap.least / setup.dp, gap.place.x, gap.place.y, gap.place.z,
                setup.boundary == 2
                    ? "with modified boundaries fluid goes through such a gap. Draw one part up to "
                      "the other to close it."
                    : "fluid that gets between them is pressed into them."));
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
