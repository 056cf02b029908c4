#pragma once

#include "boolean/contacts.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// A straight line between two vertices: a piece of a side, or of the line where two facets meet.
struct Piece
{
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    /// The two facets of a line that is no side of either; else no_index.
    std::array<std::uint32_t, 2> facets{no_index, no_index};
    std::vector<std::uint32_t> inner; ///< vertices on it, in order after split_pieces()
};

/// A crossing of two pieces inside both.
struct LineCrossing
{
    std::uint32_t a = 0; ///< index of a piece, the smaller one
    std::uint32_t b = 0;
    Vec3 position;
};

/// Pieces seen along an axis; u and v are the other two.
struct LinesInPlane
{
    const std::vector<Vec3>& vertices;
    const std::vector<Piece>& pieces;
    int u = 0;
    int v = 1;
};

/// The crossings of some pieces, by exact predicates, sorted by their pieces.
std::vector<LineCrossing> find_crossings(const LinesInPlane& lines,
                                         const std::vector<std::uint32_t>& among);

} // namespace fppg
