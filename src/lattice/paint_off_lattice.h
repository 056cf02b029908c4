#pragma once

#include "lattice/painting.h"

#include <utility>
#include <vector>

namespace fppg
{

// Draws of setfrdrawmode: particles at their true places. Each throws CaseError where GenCase
// refuses the shape too ("too sharp").

void paint_off_lattice_points(Painting& painting, const Brush& brush,
                              const std::vector<Vec3>& points);
void paint_off_lattice_lines(Painting& painting, const Brush& brush,
                             const std::vector<std::pair<Vec3, Vec3>>& segments);
/// pieces  corners as off_lattice_pieces() gives them
void paint_off_lattice_pieces(Painting& painting, const Brush& brush,
                              const std::vector<std::vector<Vec3>>& pieces);
/// A polyhedron part by part; of solids but boxes the inside stands on the lattice.
void paint_off_lattice_polyhedron(Painting& painting, const Brush& brush, const PolyhedronOp& op);
/// The sides of its visible polygons.
void paint_off_lattice_wire(Painting& painting, const Brush& brush, const PolyhedronOp& op);
void paint_off_lattice_sphere(Painting& painting, const Brush& brush, const SphereOp& op);
void paint_off_lattice_cylinder(Painting& painting, const Brush& brush, const CylinderOp& op);

} // namespace fppg
