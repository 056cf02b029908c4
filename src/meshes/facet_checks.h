#pragma once

#include "fppg/mesh.h"

#include <cstddef>
#include <string>

namespace fppg
{

/// Facets that a thread takes at once.
inline constexpr std::size_t facets_per_block = 16384;

/// Leaves out facets with a coordinate that is not finite and warns of them, of coordinates beyond
/// 1e10, of facets without area, and, for numbers that a file holds as float32, of a mesh so far
/// from the origin that they blur it.
///
/// throws GeometryError if no facet is left
void check_facets(MeshFile& mesh, const std::string& path, bool has_float32, int threads);

} // namespace fppg
