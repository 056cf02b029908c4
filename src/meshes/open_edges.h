#pragma once

#include "fppg/mesh.h"

#include <cstdint>

namespace fppg
{

/// Edges of a mesh that are not run through as often in one way as in the other. Corners nearer
/// than a millionth of the mesh's size are one.
///
/// cost  O(n log n) for n facets
std::uint64_t open_edge_count(const TriangleSoup& soup);

} // namespace fppg
