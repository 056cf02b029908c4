#pragma once

#include "fppg/fitted_walls.h"

#include <cstdint>
#include <functional>

namespace fppg
{

/// A point's level and the way in which it grows: zero on a round surface, positive outside.
struct Level
{
    double value = 0; ///< metres
    Vec3 gradient;
};

struct RoundSurface
{
    std::function<Level(const Vec3&)> level_at;
    double size = 0; ///< metres, of a radius: by it rounding is measured
    /// Facets that look along it are plane covers, which are exact; zero: there are none.
    Vec3 cover_normal{};
    bool is_distance = true; ///< the level is the distance, not only zero where that is
};

/// A vector of length 1 in the same direction; of the zero vector zero.
Vec3 unit(const Vec3& p);

/// Moves a particle from the triangles of a round body, or of a CAD model, to its exact surface, by
/// about the chord error. Covers of a cylinder stay plane; a particle on a rim comes to lie on the
/// rim's circle, one on an edge of a CAD model to where its faces meet. Does nothing for others.
///
/// position  on the facet, to rounding
/// facet     of body.mesh
/// is_2d     y stays as it is; the particle moves within its plane y = constant
void project_to_exact(const FittedBody& body, Vec3& position, std::uint32_t facet,
                      bool is_2d = false);

/// The unit normal of the exact surface at a particle, on the side to which its facet looks:
/// outward for closed bodies. That of the facet where the body is neither round nor of CAD, and on
/// covers.
Vec3 exact_normal(const FittedBody& body, const Vec3& position, std::uint32_t facet);

/// How far a point is outside the exact surface, metres, negative inside; to first order in the
/// distance where the level is no distance (an ellipsoid). From the facet's plane where the body is
/// not round, and on covers.
double exact_distance(const FittedBody& body, const Vec3& position, std::uint32_t facet);

} // namespace fppg
