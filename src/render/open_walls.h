#pragma once

#include "fppg/read_particles.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Takes out the walls between the camera and the rest. Fixed mks that reach along less than 0.75
/// of the rest on two axes are no walls and stay. Each side of the box around the walls that looks
/// to the camera is taken away, 4.5 dp deep, where some of it hides a particle that is not fixed;
/// where more than half of these stay hidden (a round tank), all wall particles that hide one.
/// Fluid that hides all other parts, 0.95 of their outline, is cut at their middle, and walls that
/// hide any of the rest go too. Nothing is done without types, or without particles that are not
/// fixed.
///
/// towards  unit vector from the particles to the camera
/// right    and `up`: unit vectors of the picture
/// chosen   indices of the particles to draw
void open_walls(const ParticleCloud& cloud, const Vec3& towards, const Vec3& right, const Vec3& up,
                std::vector<std::uint32_t>& chosen);

} // namespace fppg
