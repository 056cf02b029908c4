#pragma once

#include "check/ghost_fit.h"
#include "fppg/check.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace fppg
{

/// Where fluid can come within 2h of a boundary particle.
struct FluidNearWall
{
    float nearest = std::numeric_limits<float>::infinity(); ///< metres; infinity: none
    /// Metres along -n, in a cylinder of radius 0.75 dp; infinity: none.
    float behind = std::numeric_limits<float>::infinity();
    bool is_near = false;
    bool looks_away = false; ///< it is behind the particle
};

/// What was found of a boundary particle.
struct WallJudgement
{
    std::uint16_t faults = 0; ///< bit i: Fault i
    float thickness = 0;      ///< of a wall that is BothSides, metres
};

inline std::uint16_t bit_of(Fault fault)
{
    return static_cast<std::uint16_t>(1U << static_cast<unsigned>(fault));
}

/// Boundary particles and fluid, as the judgement asks for them.
struct WallScene
{
    const CheckParticles& particles;
    const CheckSetup& setup;
    const ParticleColumns& walls;
    FluidAround fluid;
    /// Per boundary particle of `particles`: its normal looks away from the fluid, so that nothing
    /// can be said of its sides. Empty until that is known.
    std::vector<std::uint8_t> looks_away;
};

/// The normal of a particle; zero for none.
Vec3 normal_of(const CheckParticles& particles, std::size_t i);

/// Looks for fluid around boundary particle i.
FluidNearWall look_around(const WallScene& scene, std::uint32_t i);

/// Judges the normal of boundary particle i, which is near fluid, by the rules at the head of
/// src/check/judge_walls.cpp.
WallJudgement judge_wall(const WallScene& scene, std::uint32_t i, const FluidNearWall& around);

/// Whether the solver stops at a boundary particle in a buffer zone: with DBC at any, with mDBC at
/// one without a normal.
bool stops_in_buffer(const CheckSetup& setup, const Vec3& position, const Vec3& normal);

} // namespace fppg
