#pragma once

#include "fppg/scene.h"

#include <optional>
#include <string>

namespace fppg
{

/// The exact integrals over a closed shape of density 1.
struct ExactBody
{
    double volume = 0; ///< m3
    Vec3 center;
    std::array<Vec3, 3> inertia; ///< about the centre; rows, off-diagonals with the minus sign; m5
    std::string shape;           ///< the command and its line, for messages
};

/// The body that a boundary mk draws, when a single closed shape draws it: a figure or a mesh file
/// whose edges all meet (by the sum over its facets), a sphere, cylinder or ellipsoid (by formula).
/// Fills with the mk count as the inside of the shape. What later draws cut from it is not taken
/// off.
///
/// mk       absolute
/// why_not  filled with a sentence when nothing is returned
/// throws   IoError, GeometryError for mesh files
std::optional<ExactBody> exact_body(const Scene& scene, std::uint16_t mk, std::string& why_not);

/// A body of density 1 from the facets of its closed surface, whichever side they look to.
ExactBody body_of_facets(const TriangleSoup& soup);

/// The inertia about another point of a body of the given mass: `inertia` is about its centre.
std::array<Vec3, 3> inertia_about(const std::array<Vec3, 3>& inertia, double mass,
                                  const Vec3& offset);

} // namespace fppg
