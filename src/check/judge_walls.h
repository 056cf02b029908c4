#pragma once

#include "check/ghost_fit.h"
#include "fppg/check.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// What was found of a boundary particle.
struct WallJudgement
{
    std::uint16_t faults = 0;   ///< bit i: Fault i
    bool is_near_fluid = false; ///< fluid can come within 2h
    bool is_front = false;      ///< and within 1.9 dp
    float thickness = 0;        ///< of a wall that is BothSides, metres
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
};

/// The normal of a particle; zero for none.
Vec3 normal_of(const CheckParticles& particles, std::size_t i);

/// Judges the normal of boundary particle i by rules of src/check/judge_walls.cpp.
WallJudgement judge_wall(const WallScene& scene, std::uint32_t i);

/// Whether the solver stops at a boundary particle in a buffer zone: with DBC at any, with mDBC at
/// one without a normal.
bool stops_in_buffer(const CheckSetup& setup, const Vec3& position, const Vec3& normal);

} // namespace fppg
