#pragma once

#include "fppg/surface_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// A facet or a piece of a facet of one of several meshes.
struct ArrangedFacet
{
    std::array<std::uint32_t, 3> corners{}; ///< in the order of its facet, outwards
    std::uint32_t part = 0;                 ///< index of the mesh
    std::uint32_t facet = 0;                ///< of that mesh
};

/// Several meshes cut along the lines where they meet, so that they share vertices and sides there.
struct Arrangement
{
    std::vector<Vec3> vertices;
    std::vector<ArrangedFacet> facets;  ///< by part, then facet
    std::uint64_t crossing_pairs = 0;   ///< facets of different meshes that meet in a line
    std::uint64_t coplanar_pairs = 0;   ///< of different meshes that overlap in one plane
    std::uint64_t lost_constraints = 0; ///< lines that rounding kept out of a facet
};

/// Cuts meshes along each other. What crosses within one mesh stays as it is.
///
/// Whether a side of a facet passes through another facet is decided by exact predicates; what is
/// nearer than merge_distance counts as touching: a vertex at a vertex, on a side or on a facet,
/// sides that meet. A vertex found by several facets is one vertex, so neighbours stay side to
/// side. Facets that overlap in one plane are cut up together, so that the part that they share is
/// made of the same pieces for both.
///
/// merge_distance  metres, above 0
/// threads         number of threads; the result does not depend on it
/// cost            O(n log n + pairs whose boxes overlap + k^1.5 for a facet with k cuts)
Arrangement arrange(const std::vector<const SurfaceMesh*>& meshes, double merge_distance,
                    int threads);

} // namespace fppg
