#pragma once

#include "fppg/mesh.h"
#include "fppg/vec.h"

#include <array>
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

/// A body of density 1 from the facets of its closed surface, whichever side they look to.
ExactBody body_of_facets(const TriangleSoup& soup);

/// The inertia of a body of revolution about the unit vector u.
std::array<Vec3, 3> inertia_around(const Vec3& u, double axial, double across);

/// The inertia about another point of a body of the given mass: `inertia` is about its centre.
std::array<Vec3, 3> inertia_about(const std::array<Vec3, 3>& inertia, double mass,
                                  const Vec3& offset);

} // namespace fppg
