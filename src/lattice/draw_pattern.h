#pragma once

#include "fppg/case_def.h"

#include "nodes/spans.h"

namespace fppg
{

/// The nodes of a draw, told apart by a pattern.
struct PatternSplit
{
    Spans drawn;    ///< on 'X'
    Spans left_out; ///< on '-' and on the border
};

/// Splits the spans of slab `x`.
///
/// cost  O(changes of the pattern along the columns of the spans)
PatternSplit split_by_pattern(const DrawPattern& pattern, const Spans& spans, std::uint32_t x);

} // namespace fppg
