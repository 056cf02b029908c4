#pragma once

#include "fppg/surface_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// Where on a facet a point lies.
struct FacetPlace
{
    int corner = -1; ///< 0 to 2, or -1
    int side = -1;   ///< 0 to 2, or -1; not at a corner
};

/// Normals of a surface at its edges and vertices: the sum of those of the facets that meet there,
/// weighted by their angles (Baerentzen and Aanaes, "Signed distance computation using the angle
/// weighted pseudonormal", 2005).
class PseudoNormals
{
public:
    /// mesh  connected; must outlive the object
    explicit PseudoNormals(const SurfaceMesh& mesh);

    /// Not of unit length; near zero where the facets cancel out.
    Vec3 at_vertex(std::uint32_t vertex) const;
    /// side  0 to 2 of the facet
    Vec3 at_side(std::uint32_t facet, int side) const;
    /// The normal of the facet, or that of its side or corner.
    Vec3 at(std::uint32_t facet, const FacetPlace& place) const;

    /// Whether a point on a facet is on one of its sides or corners.
    ///
    /// room  metres
    FacetPlace place_on_facet(std::uint32_t facet, const Vec3& p, double room) const;
    /// On which side of the surface a point is: above 0 where the facets look. By the facet where
    /// the point is straight over it, else by the normal at the side or corner.
    ///
    /// foot   the point of the surface nearest to p, on this facet
    /// room   metres
    /// place  of the foot; left as it is where p is straight over the facet
    double side_of(const Vec3& p, std::uint32_t facet, const Vec3& foot, double room,
                   FacetPlace& place) const;
    /// Whether an open edge runs along the side, or through the corner.
    bool is_open_at(std::uint32_t facet, const FacetPlace& place) const;

    std::span<const std::uint32_t> facets_around(std::uint32_t vertex) const
    {
        return {around_.data() + begin_[vertex], around_.data() + begin_[vertex + 1]};
    }

    /// The corner of a facet, and the side, nearest to a point.
    int nearest_corner(std::uint32_t facet, const Vec3& p) const;
    int nearest_side(std::uint32_t facet, const Vec3& p) const;

private:
    const SurfaceMesh& mesh_;
    /// Facets around vertices: those of v are [begin_[v], begin_[v + 1]).
    std::vector<std::uint64_t> begin_;
    std::vector<std::uint32_t> around_;
};

} // namespace fppg
