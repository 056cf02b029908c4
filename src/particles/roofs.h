#pragma once

#include "fppg/particles.h"

#include "particles/depths.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace fppg
{

/// Raises the depth of water under roofs to that of the water it is connected with. GenCase takes
/// depths from the top of each column, so that water under a roof, in a tilted cup or in a closed
/// tank has the pressure of the roof's height, and below a floating body that of the body's height;
/// at rest it has that of the open surface.
///
/// A column is roofed where a node or a particle of a wall or a floating body is above its top
/// within 2.2 dp. Columns are connected where they stand side by side and share a height. Columns
/// that end in the air keep their depth, as their water is meant to fall. Gravity is along -z.
///
/// off_lattice  holds the particles of walls
/// place  where one of its places is in the field, whose z is up
/// top   per run of each slab, steps from its highest node to the top of its column
///       (DepthMeter::depths_along_z()); changed
/// cost  O(n log n) for n runs, on one thread
void raise_roofed_depths(const RunField& field, const OffLatticeParticles& off_lattice,
                         const std::function<Vec3(const Vec3&)>& place, const DepthMeter& meter,
                         std::vector<std::vector<std::uint32_t>>& top);

} // namespace fppg
