#pragma once

#include "shapes/kinds.h"
#include "shapes/round_facets.h"

#include <array>

namespace fppg::test
{

/// The surface of a shape in face mode.
template <typename Kind>
ShapeMesh face_of(const Kind& kind, double dp)
{
    DrawState state;
    state.mode = DrawMode::Face;
    LatticeGrid grid;
    grid.dp = dp;
    return kinds::surfaces_of(kind, {state, grid}).at(0);
}

inline ShapeMesh sphere_mesh(const Vec3& center, double radius, double dp)
{
    return face_of(SphereOp{center, radius, {}}, dp);
}

inline ShapeMesh cylinder_mesh(const Vec3& p0, const Vec3& p1, double radius,
                               const std::array<bool, 3>& is_visible, double dp)
{
    return face_of(CylinderOp{p0, p1, radius, is_visible, {}}, dp);
}

inline ShapeMesh ellipsoid_mesh(const Vec3& focus0, const Vec3& focus1, double sum, double dp)
{
    return face_of(EllipsoidOp{focus0, focus1, sum}, dp);
}

} // namespace fppg::test
