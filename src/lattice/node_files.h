#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

namespace fppg
{

/// The places of the nodes of an mk (0: those that carry none) that have a face neighbour of
/// another mk or none at all, sorted by z, y, x: what GenCase v5.4.354 writes for `pointsmkout`. In
/// 2D neighbours along y do not count.
std::vector<Vec3> border_nodes(const RunField& field, std::uint16_t mk);

} // namespace fppg
