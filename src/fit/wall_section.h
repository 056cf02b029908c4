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

/// The pieces of cut_with_plane() as lines; y of all points is exactly that of the plane.
WallSection wall_section(const SurfaceMesh& mesh, double plane_y);

} // namespace fppg
