#pragma once

#include "fppg/fitted_walls.h"

#include <array>
#include <cstdint>

namespace fppg
{

/// How far a facet of a round shape may lie inside the true surface, in dp.
inline constexpr double chord_error_dp = 0.005;

/// Triangles of round shapes, counter-clockwise from outside, with corners on the true surface (to
/// rounding) and no facet deeper below it than chord_error_dp. Facets that meet share their corners
/// exactly. At least 24 facets go around, so that none of their edges is sharp.
///
/// dp       metres, above 0
/// returns  round, p0, p1 and radius are set; is_solid is false
/// throws   GeometryError for a radius that is not positive, and where more than 2^31 facets would
///          be needed

/// A geodesic sphere: the faces of an icosahedron cut evenly, 1167 radius / dp facets and never
/// fewer than 500.
ShapeMesh sphere_mesh(const Vec3& center, double radius, double dp);

/// A tube with plane covers whose corners are those of its rims.
///
/// is_visible  cover at p0, cover at p1, tube; what is hidden is left out, so that the mesh is open
/// returns     no facet if p0 equals p1, as the lattice draws none
ShapeMesh cylinder_mesh(const Vec3& p0, const Vec3& p1, double radius,
                        const std::array<bool, 3>& is_visible, double dp);

/// The points whose distances to two foci sum to `sum`: a geodesic sphere, stretched. A tip more
/// slender than 1 : 30 may keep edges that count as sharp.
///
/// returns  no facet if `sum` is not above the distance of the foci: nothing lies inside
ShapeMesh ellipsoid_mesh(const Vec3& focus0, const Vec3& focus1, double sum, double dp);

} // namespace fppg
