#pragma once

#include "fppg/mesh.h"

#include "meshes/mesh_builder.h"

#include <string>
#include <string_view>

namespace fppg
{

/// Reads a PLY file: ascii, binary_little_endian or binary_big_endian; elements and properties in
/// any order, of any type. Taken are x, y, z of `vertex`, the list `vertex_indices` or
/// `vertex_index` of `face`, and that of `tristrips`; all else is passed over, with a warning for
/// whole elements.
///
/// throws GeometryError that names the file, the line or byte, and what was expected
IndexedMesh read_ply(std::string_view bytes, const std::string& path);

/// Reads a legacy VTK file of any version up to 5.1, ASCII or BINARY, DATASET POLYDATA or
/// UNSTRUCTURED_GRID. GenCase v5.4 itself takes version 3.0 and POLYDATA only.
///
/// throws GeometryError as read_ply
IndexedMesh read_vtk_legacy(std::string_view bytes, const std::string& path);

/// Reads a VTK XML file, PolyData or UnstructuredGrid: arrays as ascii, base64 or appended (raw or
/// base64), plain or compressed with zlib, either byte order, lengths of 32 or 64 bits.
///
/// throws GeometryError that names the file, the line or the array, and what was expected
IndexedMesh read_vtk_xml(std::string_view bytes, const std::string& path);

/// Reads a table of heights, separated by semicolons: the first line holds x from its second cell
/// on, every other line y and then the heights. Cells that are empty are 0. Gives one quad a cell,
/// row by row, (x0, y0), (x1, y0), (x1, y1), (x0, y1), as GenCase v5.4.354 does (golden
/// file_csv_bathy, and shapeout of three tables).
///
/// throws GeometryError that names the line and what was expected
IndexedMesh read_csv_bathymetry(std::string_view bytes, const std::string& path);

/// As read_point_file(), of bytes.
std::vector<Vec3> read_points(std::string_view bytes, const std::string& path);

/// Makes the grid of `<drawbathymetry>` from points as read_points() gives them.
///
/// Found by experiment with GenCase v5.4.354 on the polygons of its shapeout. Without `initdomain`
/// the grid begins at the least x and y of the points and has whole cells until it reaches the
/// largest. With it, floor((size + 0.9 dp) / dp) cells get heights; then the last column is cut off
/// at the end of the domain, its height interpolated, or one more is added there with the same
/// heights, or it is moved there where it is nearer than dp / 100 (sizes of 12 dp and 0.001 to
/// 0.999 of it; of ties of that rule 0.61 has 6 cells at dp 0.1, 1.01 has 11 and 1.21 has 13).
/// Expands in x, then in y (its corners are those of y), then the periods in x and y, then
/// finalmove. Heights are rounded to float32 in each step. GenCase v5.4.354 stops without a message
/// for most domains of a whole number of cells.
///
/// throws GeometryError
IndexedMesh read_bathymetry(std::string_view bytes, const std::string& path,
                            const BathymetryGrid& grid, int threads);

/// The same of a file.
///
/// throws IoError too
IndexedMesh read_bathymetry_file(const std::string& path, const BathymetryGrid& grid, int threads);

/// Adds a cell of an unstructured grid by its VTK type number.
///
/// returns false if cells of that type are no points, lines or surfaces
bool add_vtk_cell(IndexedMesh& mesh, int type, std::span<const std::uint64_t> cell);

} // namespace fppg
