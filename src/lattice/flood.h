#pragma once

#include "fppg/case_def.h"

#include "nodes/snap.h"
#include "nodes/spans.h"

namespace fppg
{

/// Which mk values a filter lets through: 65536 entries, entry 0 is void.
std::vector<char> fillable_mks(const FillFilter& filter, std::uint16_t mk_bound_first);

/// The nodes that a 6-connected flood from `seed` reaches (rules F1, F4, F5).
///
/// fillable  per mk, entry 0 for void
/// box       limits of the flood
/// mask      the flood stays inside it when given; slabs as SpanSet
/// returns   one entry per slab of the lattice; empty when the seed lies outside or on a node that
///           is not fillable
/// cost      O(intervals log intervals): runs and columns of the box, not nodes
std::vector<Spans> flood(const RunField& field, const Node& seed, const std::vector<char>& fillable,
                         const NodeBox& box, const SpanSet* mask, int threads);

} // namespace fppg
