#pragma once

#include "relax/volume_band.h"

#include <cstddef>

namespace fppg
{

/// Marks the particles at a free surface and those within 2 h of them as held; returns their
/// number. At the surface are those that lack a neighbour along an axis where no wall is the cause,
/// and those beside them, up to the wall, that lack the same one.
///
/// list  of the particles as they stand on their lattice
std::size_t hold_free_surface(Band& band, const NeighbourList& list,
                              const VolumeSurroundings& around, const RelaxVolumeOptions& options,
                              int threads);

} // namespace fppg
