#pragma once

#include "fppg/vec.h"

#include <array>
#include <vector>

namespace fppg
{

/// The corners at both ends of a cylinder drawn as polygons, first those around `a`, each end
/// `sides` corners, in the bits of float32 that GenCase v5.4.354 writes into its shape files. Found
/// by experiment (40 cylinders along and across the axes, every corner of them equal):
/// - all sums are in float32
/// - the first corner lies across the axis (x, y, z) along (-(y + z) / x, 1, 1), or with its first
///   coordinate that is not zero in the place of x
/// - every other corner is the one before, turned by 360 / sides degrees clockwise about the axis
///   by a matrix of turns onto z, about z and back; so errors add up along the ring
/// - corners at `b` are those at `a` moved by b - a
///
/// a, b    ends of the axis, metres, not the same
/// radius  metres
/// sides   3 or more
std::array<std::vector<Vec3>, 2> cylinder_rings(const Vec3& a, const Vec3& b, double radius,
                                                int sides);

/// The corners of a sphere drawn as polygons, in the same bits (19 spheres, all 554 corners of each
/// equal), from the lowest to the highest: `sides` + 1 rings, the first and the last of one corner,
/// the pole, all others of `sides`.
/// - the poles lie below and above the centre in sums of float32
/// - the first corners of the rings are the lower pole, turned by 180 / sides degrees about x, ring
///   by ring; so they lie on the side of -y
/// - every other corner is the one before, turned by 360 / sides degrees clockwise about z
///
/// radius  metres
/// sides   2 or more
std::vector<std::vector<Vec3>> sphere_rings(const Vec3& center, double radius, int sides);

} // namespace fppg
