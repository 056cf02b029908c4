#pragma once

#include "fppg/fitted_walls.h"

#include "meshes/pseudo_normals.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace fppg
{

/// The surface at a particle of a wall.
struct SurfacePlace
{
    std::array<float, 3> normal{}; ///< outward unit vector
    float distance = 0;            ///< metres from the surface to the particle, negative inside
};

/// Normals and distances of the particles of fitted walls.
///
/// Distances are to the plane of the particle's facet, on spheres and cylinders to the true shape.
/// The normal is that of the same surface; at edges and corners it is the sum of the normals of the
/// facets that meet there, weighted by their angles (Baerentzen and Aanaes, "Signed distance
/// computation using the angle weighted pseudonormal", 2005), and that of the particle's own facet
/// where they cancel out.
class WallSurfaces
{
public:
    /// walls  must outlive the object
    explicit WallSurfaces(const FittedWalls& walls);

    /// particle  index into walls.particles
    SurfacePlace at(std::size_t particle) const;

private:
    const FittedWalls& walls_;
    std::vector<std::unique_ptr<PseudoNormals>> normals_; ///< per body with corners or edges
};

} // namespace fppg
