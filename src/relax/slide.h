#pragma once

#include "fit/work_mesh.h"

namespace fppg
{

/// A place on a work mesh.
struct SlidePlace
{
    Vec3 position;
    std::uint32_t facet = no_index;
};

/// Moves a point over the facets: straight on across edges that are no border, along those that
/// are.
///
/// step    metres, in the plane of the facet
/// inside  metres: how far within a border it is kept; tiny
/// returns whether it has arrived; false, and the place as it was, where more than 64 facets would
///         have to be crossed
bool slide(const WorkMesh& mesh, SlidePlace& place, const Vec3& step, double inside);

/// The nearest place on a facet of a mesh to a point that belongs to it but may stand off its
/// plane; beyond a side, a place near that.
SlidePlace place_on_facet(const WorkMesh& mesh, std::uint32_t parent, const Vec3& point);

} // namespace fppg
