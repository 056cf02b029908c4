#pragma once

#include "fppg/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// The line in which a facet meets the plane: from the edge at which the facet's boundary goes down
/// through the plane to the one at which it comes up again. The next facet goes down where this one
/// comes up.
struct PlanePiece
{
    std::uint32_t facet = 0;
    std::uint32_t from_edge = 0;
    std::uint32_t to_edge = 0;
};

/// Cuts every facet with the plane. Corners on the plane count as above it; in a shell that touches
/// the plane from above only they count as below, so that it is cut along the touch. Facets that
/// lie in the plane have no piece.
std::vector<PlanePiece> cut_with_plane(const SurfaceMesh& mesh, double plane_y);

/// Where an edge that crosses the plane meets it; the same for all its facets.
Vec3 plane_crossing(const SurfaceMesh& mesh, std::uint32_t edge, double plane_y);

} // namespace fppg
