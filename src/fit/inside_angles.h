#pragma once

#include "fppg/fit.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <span>

namespace fppg
{

/// Particles on a surface; the spans are equally long.
struct PlacedOnSurface
{
    std::span<const Vec3> positions;
    std::span<const FitKind> kinds;
    std::span<const std::uint32_t> facets; ///< of the mesh that they lie on
};

/// How much of what particles on a closed surface stand for is inside it, the mean: on edges the
/// dihedral angle inside over 2 pi (a quarter on those of a box, three quarters on concave ones),
/// on corners the solid angle over 4 pi, elsewhere one half; one half too at open edges and where
/// more than two facets meet. A box of nodes has the volume of its cells so.
///
/// is_2d    the particles lie on a section with a plane of constant y, and angles are those in it
/// returns  0 to 1; one half without particles
/// cost     O(facets + particles)
double mean_share_inside(const SurfaceMesh& mesh, const PlacedOnSurface& particles, bool is_2d);

} // namespace fppg
