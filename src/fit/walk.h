#pragma once

#include "fit/work_mesh.h"

namespace fppg
{

/// A point on a work mesh with a unit direction in its facet's plane.
struct SurfaceRay
{
    Vec3 position;
    std::uint32_t facet = no_index;
    Vec3 direction;
};

/// Where a straight line leaves a facet.
struct FacetExit
{
    std::size_t side = 3; ///< 3: the line ends within the facet
    double length = 0;    ///< metres to there
};

/// entered  the side that the line came in by, which it does not leave by; 3: none
/// length   metres to the end of the line
FacetExit find_exit(const WorkFacet& facet, const SurfaceRay& ray, std::size_t entered,
                    double length);

/// Takes a ray that stands on a side with a neighbour into that neighbour, unfolding its direction.
///
/// returns  the side of the neighbour that the ray came in by
std::size_t cross_side(const WorkMesh& mesh, SurfaceRay& ray, std::size_t side);

/// Takes a point back into the plane of a facet, from which crossings part it by rounding.
inline Vec3 onto_plane(const WorkFacet& facet, const Vec3& point)
{
    return point - facet.normal * dot(point - facet.corners[0], facet.normal);
}

/// Follows the straight line from a ray over the facets, unfolding it at every edge.
///
/// length   metres
/// returns  the point reached, with the direction of arrival; its facet is no_index if a border
///          was in the way
/// cost     O(1) a facet crossed
SurfaceRay walk(const WorkMesh& mesh, SurfaceRay ray, double length);

} // namespace fppg
