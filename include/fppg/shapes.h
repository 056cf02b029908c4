#pragma once

#include "fppg/lattice.h"
#include "fppg/mesh.h"
#include "fppg/mesh_reading.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// Reads an STL file, binary or ASCII, whatever its header says: a file of 84 + 50 n bytes, n in
/// its bytes 80 to 83, is binary; so is every file that is no text. Normals and attributes are not
/// used. Several solids of an ASCII file are joined.
///
/// path     as the user named it, relative to the working directory
/// threads  number of threads; the result does not depend on it
/// returns  facets in the order of the file; corners are the file's float32 values (ASCII digits
///          are rounded once, to float32). Facets with a coordinate that is not finite are left out
///          with a warning that counts them, and so are facets with one beyond 1e10 where others
///          are without. Warned of as well: bytes after the last facet, a solid without `endsolid`,
///          facets without area, a mesh so far from the origin that float32 blurs it
/// throws   IoError if the file cannot be opened; GeometryError if it is no STL, is truncated, has
///          a count that does not fit its size, has a facet that is no triangle or a number that
///          cannot be read (names the line), or has no facet left
MeshFile read_stl(const std::string& path, int threads = 1);

/// Reads a mesh file of any kind that is known: STL as read_stl; PLY, OBJ, OFF; legacy VTK and the
/// XML files .vtp and .vtu, points, lines and polygons; a table of heights (CSV); points of a
/// bathymetry. Polygons and strips are cut into triangles as GenCase v5.4.354 cuts them, so that
/// the soup of every kind can be body-fitted. Coordinates are float32 or double, as the file says:
/// GenCase keeps both (points a millionth of dp beside a tie of the lattice fall as their type
/// rounds them).
///
/// path     as the user named it, relative to the working directory
/// reading  what the file is, and which of its shapes are wanted
/// threads  number of threads; the result does not depend on it
/// throws   IoError if the file cannot be opened; GeometryError if it is of another kind, is
///          truncated, has a count that does not fit, names a point that is not there, or has no
///          shape (names the line, the byte or the element, and what was expected)
MeshFile read_mesh_file(const std::string& path, const MeshReading& reading, int threads = 1);

/// Reads the points of a file, whatever it makes of them: lines of three numbers x y z, separated
/// by blanks, commas or semicolons, after a heading or not; or the points of a VTK (legacy, .vtp,
/// .vtu) or PLY file, by its first bytes.
///
/// returns  in the order of the file; coordinates as the file has them, float32 or double
/// throws   IoError if the file cannot be opened; GeometryError as read_mesh_file() for what is
///          none of these, and if there is no point
std::vector<Vec3> read_point_file(const std::string& path);

/// The kind of a file by the ending of its name, whatever its case; STL for an ending that is not
/// known.
MeshFormat mesh_format_of(const std::string& path);

/// The nodes inside a mesh or on it, by the sum of signed crossings along each column.
///
/// Every column (x, y) is cut with all facets; a facet that faces down adds one (entering,
/// upwards), one that faces up takes one away. Nodes where the sum is positive are inside, so
/// overlapping closed parts of one file join, and a cavity whose facets face into it stays empty.
/// Every decision is exact, without a tolerance, for the double values of corners and nodes:
/// - a column that passes exactly through edges or vertices is cut as if it stood an infinitesimal
///   amount further in x, and a second-order amount in y, so that no crossing is lost or counted
///   twice;
/// - a node is between two crossings if its z is at or above the entering and at or below the
///   leaving one;
/// - a node exactly on an upright facet, an edge or a vertex is inside as well: the result is the
///   closed body, and a box on lattice lines keeps the nodes of all its six sides.
///
/// soup     closed, facets counter-clockwise from outside; a mesh whose signed volume is negative
///          is taken with all facets flipped. Where a mesh is open, a column whose sum does not
///          return to zero has no nodes above its last crossing
/// grid     node (i, j, k) at origin + (i, j, k) * dp, multiplied first
/// threads  number of threads; the result does not depend on it
/// returns  slabs from the first to the last that has a node inside; none if no node is
/// cost     O(facets + candidate columns + crossings log crossings) time; memory for the result
///          and four bytes for every facet in every slab that it reaches
SpanSet inside_spans(const TriangleSoup& soup, const LatticeGrid& grid, int threads);

/// The nodes inside a mesh that may be open, cross itself or have edges of more than two facets.
///
/// Columns are cut along each of the three axes by the rules of inside_spans(). A column whose sum
/// does not return to zero has no vote. Where at least two axes vote and all that vote agree, that
/// is taken. All other nodes are disputed: they are inside where the generalised winding number
/// (the solid angle of all facets over 4 pi) is above one half.
///
/// soup      facets counter-clockwise from outside, as repair_mesh() turns them; never flipped
/// disputed  set to the number of nodes that the winding number decided
/// threads   number of threads; the result does not depend on it
/// returns   grid.n[0] slabs from 0; none for an empty soup
/// source    Jacobson et al., Robust Inside-Outside Segmentation using Generalized Winding Numbers,
///           2013; evaluated by Barill et al., Fast Winding Numbers for Soups and Clouds, 2018
/// cost      about four times that of inside_spans(), and for each disputed node the time to go
///           through a tree of the facets
SpanSet inside_by_vote(const TriangleSoup& soup, const LatticeGrid& grid, int threads,
                       std::uint64_t& disputed);

} // namespace fppg
