#pragma once

#include "nodes/snap.h"
#include "nodes/spans.h"

#include <array>
#include <optional>
#include <vector>

namespace fppg
{

/// The corners of the lattice cell around a point that lie in the lattice, nearest first; corners
/// equally near in the order of x, y, z.
struct CellCorners
{
    std::array<Node, 8> nodes;
    int count = 0;
};

CellCorners cell_corners(const Vec3& p, const LatticeGrid& grid);

/// Of the corners of the lattice cell around a point the nearest one that the spans of the
/// lattice's slabs hold.
std::optional<Node> find_node_in(const std::vector<Spans>& slabs, const Vec3& p,
                                 const LatticeGrid& grid);

/// Whether the spans of a slab hold a node.
bool contains(const Spans& spans, std::uint32_t y, std::uint32_t z);

/// A set as one entry per slab of the lattice.
std::vector<Spans> by_slab(SpanSet set, const LatticeGrid& grid);

} // namespace fppg
