#pragma once

#include "fppg/lattice.h"

#include <cstdint>
#include <vector>

namespace fppg
{

enum class BooleanOp : std::uint8_t
{
    Part,         ///< a part by itself
    Union,        ///< what is in any of the operands
    Intersection, ///< what is in all of them
    Difference,   ///< what is in the first and in none of the others
};

/// A combination of parts; a tree whose leaves are parts.
struct BooleanNode
{
    BooleanOp op = BooleanOp::Part;
    std::uint32_t part = 0;            ///< of a leaf: index of the part
    std::vector<BooleanNode> operands; ///< of all others; at least one
};

/// Whether a point is in a combination.
///
/// is_in  per part, whether the point is in it
bool evaluate(const BooleanNode& node, const std::vector<char>& is_in);

/// The parts whose solid stays in the result where they are: all but those that are taken away by
/// an odd number of differences. A part that stands on both sides stays.
///
/// returns  per part, 1 or 0; 0 for parts that the tree does not name
std::vector<char> staying_parts(const BooleanNode& node, std::size_t parts);

/// The nodes of a combination, by interval operations on the runs of its parts: exactly the nodes
/// for which evaluate() is true.
///
/// sets     per part; slabs may begin anywhere
/// threads  number of threads; the result does not depend on it
/// returns  slabs from the first to the last that has a node
/// source   FPPG paper, "Multi-geometry Boolean operations"
/// cost     O(spans)
SpanSet boolean_spans(const std::vector<SpanSet>& sets, const BooleanNode& node, int threads);

/// Shares the nodes of a combination out among its parts: each belongs to the first part that has
/// it and stays in the result.
///
/// returns  per part; together exactly `nodes`
std::vector<SpanSet> share_out(const SpanSet& nodes, const std::vector<SpanSet>& sets,
                               const BooleanNode& node, int threads);

} // namespace fppg
