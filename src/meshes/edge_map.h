#pragma once

#include <cstddef>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// Finds the edges and which facets meet there: fills edges, edge_facets, is_manifold, neighbours
/// and facet_edges anew from the facets.
///
/// threads  number of threads; the result does not depend on it
/// source   edge-face map of the FPPG paper, "Feature extraction and feature line particles"
void build_edges(SurfaceMesh& mesh, int threads);

/// Whether the edge has one facet only.
inline bool is_open(const SurfaceMesh& mesh, std::size_t edge)
{
    return mesh.edge_facets[edge][1] == no_index;
}

/// Whether the facet's side s runs from the smaller vertex to the larger one.
inline bool runs_upwards(const SurfaceMesh& mesh, std::size_t f, std::size_t s)
{
    return mesh.facets[f][s] < mesh.facets[f][(s + 1) % 3];
}

} // namespace fppg
