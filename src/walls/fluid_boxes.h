#pragma once

#include "fppg/scene.h"

#include <string>
#include <vector>

namespace fppg
{

/// The fluid of a case: the seeds of its fills, the boxes of its fluid shapes, and its inlets.
std::vector<Box3> boxes_of_fluid(const Scene& scene, int threads);

/// Middles of fluid by which the sides of a body's walls are chosen: not of fluid that surrounds
/// the body, in whose middle it stands.
///
/// fluid  boxes_of_fluid()
std::vector<Vec3> places_in_fluid(const std::vector<Box3>& fluid, const Scene& scene,
                                  const DrawOp& draw, int threads);

/// The same for the body of a combination.
std::vector<Vec3> places_in_fluid(const std::vector<Box3>& fluid, const Scene& scene,
                                  const Combination& combination, int threads);

/// Walls in layers that a case thickens inwards, around fluid (`<layers vdp="0,-1,-2">` of a tank):
/// fluid stands before the innermost shell on the lattice, so that this one is their surface, and
/// not the shape itself. Between both there was room for half as much fluid again in a tube of 13
/// dp. Before the walls are fitted.
///
/// returns  a sentence a shape
std::vector<std::string> draw_shells_around_fluid(const Scene& scene, int threads, CaseDef& def);

} // namespace fppg
