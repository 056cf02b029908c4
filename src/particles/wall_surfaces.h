#pragma once

#include "fppg/fitted_walls.h"

#include <array>
#include <cstdint>
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
    /// Facets around the vertices of a mesh: those of v are [begin[v], begin[v + 1]).
    struct VertexFacets
    {
        std::vector<std::uint64_t> begin;
        std::vector<std::uint32_t> facets;
    };

    const FittedWalls& walls_;
    std::vector<VertexFacets> around_; ///< per body; empty for a body without corners

    Vec3 mean_at_corner(std::size_t body, std::uint32_t facet, const Vec3& p) const;
};

} // namespace fppg
