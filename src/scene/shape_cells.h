#pragma once

#include "fppg/scene.h"

#include "shapes/shape.h"

#include <vector>

namespace fppg
{

/// Whether shape files show what a command draws: lines, polyhedra, spheres, cylinders, mesh files.
bool has_shape_cells(const Command& what);

/// The lines and faces of one draw in the order and with the corners that GenCase v5.4.354 writes
/// into the files of `shapeout` (found by experiment, 150 small cases):
/// - of spheres and cylinders with `layers` those of every layer, the outermost first
/// - of a solid box the six sides, in every draw mode; of all other bodies that solid mode fills
///   (polyhedra, prisms, beaches and pyramids without a mask) nothing in this mode
/// - wire mode: the sides of each triangle and quad as lines, of a solid box also its six sides
/// - bases of prisms and pyramids, and polygons of five corners and more, as their triangles
/// - with `snapped` the corners stand on the lattice, radii are rounded to it and those of
///   cylinders grow by ctecylindertube; triangles that this leaves with two places are lines, with
///   one they go. Off the lattice (setfrdrawmode) `snapped` changes nothing
/// - clips cut all of it, along the places above; nothing closes the cut
/// - of a polyhedron under setmknextauto only the part of this draw; a body with its inside has its
///   cells in the first part
///
/// throws IoError, GeometryError for mesh files
std::vector<ShapeCell> shape_cells(const Scene& scene, const DrawOp& op, bool snapped);

} // namespace fppg
