#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/mesh.h"

#include <vector>

namespace fppg
{

/// The true shapes of a draw, not snapped to the lattice, for walls whose particles stand on them.
///
/// | draw                  | meshes                                               | is_solid      |
/// | polyhedron, face mode     | its visible faces                                    | no | |
/// polyhedron, solid or full | all its faces, if it has an inside; else as face     | has an inside
/// | | sphere, ellipsoid     | the closed surface                                   | not in face |
/// | cylinder              | its visible covers and tube                          | all visible,  |
/// |                       |                                                      | not in face   |
/// | layers                | one for every layer, with the covers that it shows   | no            |
/// | mesh file             | its facets, whatever the mode                        | if it fills   |
/// | all others, wire mode | none                                                 |               |
///
/// What GenCase draws as nothing gives none either: a cylinder without length, an ellipsoid whose
/// sum of distances is not above the distance of its foci.
///
/// Facets run counter-clockwise from outside wherever an outside can be told: closed polyhedra and
/// files moved by a mirroring transform are turned. `setnormalinvert` turns what is not solid.
/// Polygons are cut as on the lattice (polygon_cut.h), by the corners as drawn. A solid polyhedron
/// is watertight for boxes, prisms and pyramids; for `drawfigure` and files as they are given.
///
/// op    clip planes are not applied; mk and draw_points are the caller's to look at
/// file  what a MeshFileOp draws, before its transform; null for every other draw
/// grid  layers are counted in its dp, and the facets of round shapes chosen by it
/// throws  GeometryError without a place, to which the caller adds it: a part of a solid drawn by
///         setmknextauto, which has no true shape of its own; a radius that is not positive
std::vector<ShapeMesh> shape_meshes(const DrawOp& op, const MeshFile* file,
                                    const LatticeGrid& grid);

} // namespace fppg
