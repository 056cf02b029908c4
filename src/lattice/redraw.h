#pragma once

#include "fppg/case_def.h"

#include "nodes/spans.h"

namespace fppg
{

/// The nodes of every slab that a redraw recolours (rules D1, D2); `box` limits them.
std::vector<Spans> redraw_nodes(const RunField& field, const RedrawOp& op, const NodeBox& box,
                                std::uint16_t mk_bound_first, int threads);

/// The nodes that one step of a redrawnear recolours (rules D3 to D5): those of the target type,
/// inside `box`, with a neighbour of the border type. Targets are limited further where there is a
/// `mask`, one entry per slab (a turned box: 12 of its 15 nodes in GenCase v5.4.354 with void
/// targets and borders, since nodes beside it are no targets and so act as borders).
std::vector<Spans> redraw_near_nodes(const RunField& field, const RedrawNearOp& op,
                                     const NodeBox& box, const SpanSet* mask,
                                     std::uint16_t mk_bound_first, int threads);

} // namespace fppg
