#pragma once

#include "fppg/fitted_walls.h"

#include "relax/regions.h"

#include <cstddef>
#include <optional>

namespace fppg
{

/// Whether all bodies of a region have Placement::Inside.
bool is_inside(const FittedWalls& walls, const Region& region);

/// How many particles there must be for those of the bodies of a region to stand for their volume.
/// What the domain or later draws left of them has its part of that.
///
/// moving   particles that move now
/// nodes    of the region in the field
/// dp       metres
/// returns  nothing where not all bodies are filled
std::optional<double> wanted_number(const FittedWalls& walls, const Region& region,
                                    std::size_t moving, double nodes, double dp);

/// The bodies of a region share what its particles became more, by their volume.
void take_new_nodes(FittedWalls& walls, const Region& region, double more, double dp);

} // namespace fppg
