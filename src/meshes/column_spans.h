#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fppg/lattice.h"
#include "fppg/mesh.h"

namespace fppg
{

struct ColumnOptions
{
    int flip = 1;                  ///< -1: all facets are clockwise from outside
    bool measures_overlap = false; ///< fills ColumnCuts::overlap
};

/// What cutting the columns along z with all facets gives; see inside_spans() for its rules.
struct ColumnCuts
{
    SpanSet inside;
    /// Columns (x, y) whose sum does not return to zero, ascending.
    std::vector<std::array<std::uint32_t, 2>> unbalanced;
    /// The integral of (sum of crossings, less one where it is positive) over all columns whose sum
    /// returns to zero, metres cubed: what a signed volume counts more than once.
    double overlap = 0;
};

ColumnCuts cut_columns(const TriangleSoup& soup, const LatticeGrid& grid,
                       const ColumnOptions& options, int threads);

} // namespace fppg
