#pragma once

#include "fppg/vres.h"

#include "nodes/spans.h"

#include <cstddef>
#include <vector>

namespace fppg
{

/// The nodes with particles that zone `zone` of `<vres>` has not: those outside its own box where
/// that is turned, and those inside the zones in it, more than a dp beyond where the buffer ends. A
/// list per slab of the field.
///
/// cost  O(runs + columns of the boxes); where a box is turned, its nodes
std::vector<Spans> nodes_beyond_zone(const VresDef& vres, std::size_t zone, const RunField& field);

/// The same of a particle off the lattice: its nearest node decides.
bool is_beyond_zone(const VresDef& vres, std::size_t zone, const LatticeGrid& grid, const Vec3& p);

} // namespace fppg
