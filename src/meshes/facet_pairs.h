#pragma once

#include <array>
#include <cstdint>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Facets that cross each other.
struct FacetPairs
{
    std::size_t count = 0;
    std::array<std::uint32_t, 2> first{no_index, no_index}; ///< smallest first facet, then second
};

/// Counts the pairs of facets without a common vertex where a side of one passes through the inside
/// of the other. Exact; facets that only touch, as where a fin stands on a wall, and facets that
/// overlap in one plane, do not count.
///
/// threads  number of threads; the result does not depend on it
/// cost     O(n log n + pairs whose boxes overlap)
FacetPairs find_crossing_facets(const SurfaceMesh& mesh, int threads);

/// The same of facets of one shell alone, where a side reaches farther than `depth` (metres) on
/// both sides of the other facet: what rounding makes of surfaces that touch does not count.
FacetPairs find_folded_facets(const SurfaceMesh& mesh, double depth, int threads);

} // namespace fppg
