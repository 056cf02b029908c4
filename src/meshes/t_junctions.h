#pragma once

#include <cstdint>
#include <vector>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// A vertex inside an open edge, at a share of the way from the edge's first vertex.
struct Junction
{
    std::uint32_t edge;
    std::uint32_t vertex;
    double share;
};

/// Finds the vertices of open edges that lie inside another open edge, within the rounding of
/// float32, but never more than a hundredth of the edge. Sorted by edge, then along it.
///
/// least    metres; within this distance where the rounding is less
/// most     metres; within this distance where the rounding is more
/// threads  number of threads; the result does not depend on it
std::vector<Junction> find_t_junctions(const SurfaceMesh& mesh, double least, double most,
                                       int threads);

/// Splits the facets of open edges at the vertices inside them. The edge map is to be built anew.
///
/// junctions  as find_t_junctions() returns them
void split_at(const std::vector<Junction>& junctions, SurfaceMesh& mesh);

} // namespace fppg
