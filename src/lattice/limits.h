#pragma once

#include "lattice/painting.h"
#include "nodes/snap.h"

#include <optional>
#include <vector>

namespace fppg
{

/// The nodes that a fill or a redraw may change: a box, and those of `mask` alone where there is
/// one.
struct Limits
{
    NodeBox box;
    std::optional<SpanSet> mask; ///< one entry per slab of the lattice

    const SpanSet* mask_used() const { return mask ? &*mask : nullptr; }
    std::vector<Spans> kept(std::vector<Spans> nodes) const;
    /// nodes  as `mask`; without slabs nothing changes
    void keep_within(const SpanSet& nodes);
};

/// Nodes strictly inside a snapped box.
NodeBox node_box(const BoxRegion& region, const LatticeGrid& grid);

/// The inside of a polyhedron as one entry per slab of the lattice.
SpanSet mask_of(const Painting& painting, const Brush& brush, const PolyhedronOp& polyhedron);

/// All nodes where there is no region.
Limits limits_of(const Painting& painting, const Brush& brush,
                 const std::optional<BoxLimits>& region);

} // namespace fppg
