#pragma once

#include "fppg/mesh.h"

#include "lattice/painting.h"

namespace fppg
{

/// The mesh of a file; what the reader noticed is said at the first draw that uses it.
const MeshFile& mesh_of(Painting& painting, const Brush& brush, const MeshFileOp& op);

/// Warns of faults that GenCase passes over, by the box around a file.
void check_mesh(Painting& painting, const DrawOp& draw, const MeshFile& file,
                const Transform& transform);

TriangleSoup moved_soup(const TriangleSoup& source, const Transform& transform, int threads);
/// Exchanges the sides of all facets.
void turn_over(TriangleSoup& soup);

/// Single points and lines of a mesh file; lines are those of drawline.
void paint_points_and_lines(Painting& painting, const Brush& brush, const MeshFile& file,
                            const Transform& transform);

/// A table of heights off the lattice: the cells that are parallelograms within 0.1 dp (as
/// trapezoids from 0.05 dp on), in wire mode the sides of all flat ones. The triangles of the
/// others stand on the lattice. Each cell comes after the one before, which it may remove (24
/// cells of GenCase v5.4.354 with one corner off by 0.04 to 0.4 dp, six saddles).
void paint_off_lattice_heights(Painting& painting, const Brush& brush, const MeshFileOp& op,
                               const MeshFile& file);

/// The cells of a table of heights under setmknextauto: every flat one is a part, in wire mode
/// each of its sides. Bent ones get the mk that is next and leave it to the cell behind them.
void paint_heights_in_parts(Painting& painting, const Brush& brush, const MeshFileOp& op,
                            const MeshFile& file);

/// A flood over void nodes from the centre of the file's own box, inside that box grown by dp,
/// both moved by the op's transform (rule X2). It is no inside test: the notch of an L or the hole
/// of a torus is filled. Says so.
///
/// moved  the surface where it is drawn
void autofill(Painting& painting, const Brush& brush, const MeshFileOp& op, const MeshFile& file,
              const TriangleSoup& moved);

} // namespace fppg
