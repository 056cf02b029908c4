#pragma once

#include "fppg/files.h"

#include <string>
#include <vector>

namespace fppg
{

/// Reads the polygons of a legacy VTK file (POLYDATA, ASCII or BINARY, points float or double,
/// cells in the layout of versions up to 4.2), such as the shape files that `shapeout` writes. Its
/// points and lines are left out, data of cells and points are not read.
///
/// returns  one entry with all points and polygons of three and more corners, in the order of the
///          file; coordinates rounded to float32
/// throws   IoError if the file cannot be read, is not whole or of another format
std::vector<ShapePolygons> read_shapes_vtk(const std::string& path);

} // namespace fppg
