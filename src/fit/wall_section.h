#pragma once

#include "fppg/mesh.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// The lines in which the facets of a mesh meet a plane y = constant, one entry each in all arrays.
struct WallSection
{
    TriangleSoup soup;                 ///< each line from p to q as the triangle p, q, q
    std::vector<Vec3> normals;         ///< unit, in the plane, to the side where the facet looks
    std::vector<double> lengths;       ///< metres
    std::vector<std::uint32_t> facets; ///< of the mesh
};

/// Cuts every facet with the plane; y of all points is exactly that of the plane. Corners on the
/// plane count as below it, as in cut_column(); a mesh that only touches the plane with what is
/// below it is cut there as well. Facets that lie in the plane have no line.
WallSection wall_section(const SurfaceMesh& mesh, double plane_y);

} // namespace fppg
