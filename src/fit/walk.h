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

/// Follows the straight line from a ray over the facets, unfolding it at every edge.
///
/// length   metres
/// returns  the point reached, with the direction of arrival; its facet is no_index if a border
///          was in the way
/// cost     O(1) a facet crossed
SurfaceRay walk(const WorkMesh& mesh, SurfaceRay ray, double length);

} // namespace fppg
