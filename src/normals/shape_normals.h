#pragma once

#include "fppg/case_def.h"

namespace fppg
{

// Normals of `<norplane>`, `<norsphere>` and `<norcylinder>`: from a place to the surface of a
// shape, metres; zero for what they do not reach.

/// norplane: n = d u for |d| <= reach, d the distance along the unit normal u to the plane; both
/// sides count (1,331 of 1,331 particles of GenCase v5.4.354).
Vec3 to_plane(const Vec3& p, const Vec3& unit, double offset, double reach);

/// norsphere: the particles on the chosen side, where the sphere is within reach (1,260 of 1,260
/// normals of GenCase v5.4.354). The centre itself has no direction.
Vec3 to_sphere(const Vec3& p, const SphereNormals& sphere, double reach);

/// norcylinder. Inside: the shorter of the ways to the side and to the nearer cover (if its limit
/// is on), their sum where they differ by less than 0.01 h, zero where the shorter one exceeds the
/// reach. Outside: to the nearest point of the cylinder, whatever the limits; beyond the rims the
/// reach counts for the shorter of the ways across and along. (GenCase v5.4.354: 3,178 of 3,180
/// particles inside four oblique cylinders, 0.01 h lies between 0.0097 and 0.0110 h; 487 of 487
/// around each of 12 cylinders with reaches from 0.2 h to 2.5 h.)
Vec3 to_cylinder(const Vec3& p, const CylinderNormals& cylinder, double reach, double h);

} // namespace fppg
