#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace fppg
{

/// The corners of what the faces of a polyhedron that are not hidden are drawn as: parallelograms,
/// trapezoids and triangles, four other corners as (0, 1, 2) and (0, 2, 3), to which GenCase
/// applies the current matrix once more (a quad moved by 0.4 stands 0.8 away).
///
/// In 2D a quad with a corner more than 0.01 dp beside the plane is drawn as where it meets the
/// plane: the lines of its two triangles, each from the lower x to the higher, of equal x from the
/// lower y as rounding leaves it, else in the order of the triangle's sides; where one ends and the
/// other begins, as one line. Where they only touch the plane, the points. Of the two ways to cut a
/// bent quad the one of less area counts (247 of 261 bent quads of GenCase v5.4.354; the others
/// have the other cut), a flat one is cut as cut_polygon() does. Sections of upright slanted
/// prisms: 116 of 120 in v5.4.354; the others are of one x and one y to the last bit, where it
/// draws two lines that this joins.
std::vector<std::vector<Vec3>> off_lattice_pieces(const PolyhedronOp& polyhedron,
                                                  const Transform& matrix, const LatticeGrid& grid);

/// Where the plane of a 2D case meets a box, as the corners of a polygon: the section of a solid
/// box is drawn in its place. It starts with the line on the first face that meets the plane, of
/// bottom, top, front, right, back and left, towards larger x: that decides which trapezoids are
/// refused (120 of 120 random turned boxes of GenCase v5.4.354). A section of five or six corners
/// is not drawn (14 of 14), nor is one of a box that lies in the plane with two sides. Corners of
/// the box up to 0.01 dp beside the plane lie in it.
std::vector<Vec3> box_section(const PolyhedronOp& box, const LatticeGrid& grid);

/// What setmknextauto gives an mk of its own off the lattice: polygons as off_lattice_pieces() has
/// them, or an inside that stands on the lattice.
struct OffLatticePart
{
    std::vector<std::vector<Vec3>> pieces;
    std::optional<std::size_t> inside{}; ///< of a prism the index in solid_parts(), else 0
    bool is_section = false;             ///< where a quad or a box meets the plane of a 2D case
    bool ends_quad = false;              ///< the last part of a quad, or of a box in a 2D case
};

/// The parts of a polyhedron in GenCase's order of drawing; a polyhedron drawn as a whole is drawn
/// in the same order, which decides which of two near particles stays. A triangular part of a prism
/// is followed by the quads between it and its neighbours, each of which so is drawn twice. A quad
/// that leaves the plane of a 2D case has one part for each line where it meets the plane and then
/// one more, which has nothing but the points where it only touches the plane; a solid box has its
/// section, or in wire mode the sides of that (51 boxes, prisms, pyramids and quads of GenCase
/// v5.4.354 in all modes). Not for wires of other shapes, nor for a solid box in 3D, which is one
/// part.
std::vector<OffLatticePart> off_lattice_parts(const PolyhedronOp& polyhedron, DrawMode mode,
                                              const Transform& matrix, const LatticeGrid& grid);

/// Their number, that of the sides in wire mode.
std::uint32_t count_off_lattice_parts(const PolyhedronOp& polyhedron, DrawMode mode,
                                      const LatticeGrid& grid);

} // namespace fppg
