#pragma once

#include "fppg/files.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// The numbers of the corners of shapes in a shape file. They count in the order in which the cells
/// use them: those of the points first, then of the lines, then of the faces. Corners of one object
/// with the same place in float32 are one; corners that no cell uses are left out. As in the files
/// of GenCase v5.4.354.
struct CornerNumbers
{
    std::vector<std::array<float, 3>> places;        ///< by number, metres
    std::vector<std::vector<std::uint32_t>> numbers; ///< by shape and corner
};

CornerNumbers number_corners(const std::vector<ShapePolygons>& shapes);

/// Whether a cell of this many corners is a point (0), a line (1) or a face (2).
inline std::size_t cell_kind(std::size_t corners)
{
    return corners < 3 ? corners - 1 : 2;
}

} // namespace fppg
