#pragma once

#include "fppg/surface_mesh.h"
#include "fppg/vec.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// A facet, or a part of one.
struct SmallPiece
{
    Vec3 middle;
    Vec3 normal;            ///< unit
    std::uint32_t kind = 0; ///< pieces of two kinds never stand for one another
    bool is_small = true;   ///< false: it stands for itself
};

struct PiecesToAsk
{
    std::vector<std::uint32_t> for_each; ///< per piece the one that stands for it
    /// Those that stand for themselves, one beside the other along a Morton curve: asked in this
    /// order, a tree finds the nearest facets of the next ones where it found those of the last.
    std::vector<std::uint32_t> order;
};

/// Which pieces stand for the others, so that what is asked of each piece costs by the area of a
/// surface, not by its facets: of the small ones in a cell of a grid that face about the same way,
/// the one nearest to the middle of the cell.
///
/// cell  metres, edge of the cells; pieces that are longer are not small
/// cost  O(n log n)
PiecesToAsk pieces_to_ask(const std::vector<SmallPiece>& pieces, double cell, int threads);

/// A facet that is asked for itself and others.
struct AskedFacet
{
    std::uint32_t facet = 0;
    double area = 0; ///< metres squared, of all that it stands for
};

/// The facets of a mesh to ask, in the order of pieces_to_ask(): those with an edge of `size` or
/// more, and of the smaller ones those that stand for others.
///
/// size  metres
std::vector<AskedFacet> facets_to_ask(const SurfaceMesh& mesh, double size, int threads);

} // namespace fppg
