#pragma once

#include <cstdint>

#include "fppg/lattice.h"
#include "fppg/mesh.h"

namespace fppg
{

struct InsideVote
{
    SpanSet inside;
    std::uint64_t disputed = 0; ///< nodes that the winding number decided
    double overlap = 0;         ///< as in ColumnCuts
};

/// inside_by_vote() with the overlap that it sees on the way.
InsideVote vote_inside(const TriangleSoup& soup, const LatticeGrid& grid, int threads);

} // namespace fppg
