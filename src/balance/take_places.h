#pragma once

#include "fppg/particles.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// A fluid particle with the place and density that it gets.
struct NewPlace
{
    std::uint64_t id = 0;
    Vec3 position;
    float rhop = 0;
};

/// Puts fluid particles at new places. Those on nodes become particles off the lattice; ids stay.
///
/// places  in the order of ids
void take_places(CaseParticles& particles, const std::vector<NewPlace>& places);

} // namespace fppg
