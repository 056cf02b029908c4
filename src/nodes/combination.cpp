#include "fppg/combination.h"

#include "core/parallel.h"
#include "nodes/spans.h"

#include <algorithm>

namespace fppg
{
namespace
{

const Spans& slab_of(const SpanSet& set, std::size_t x)
{
    static const Spans none;
    return x >= set.x_begin && x - set.x_begin < set.slabs.size() ? set.slabs[x - set.x_begin]
                                                                  : none;
}

Spans evaluate_slab(const BooleanNode& node, const std::vector<SpanSet>& sets, std::size_t x)
{
    if (node.op == BooleanOp::Part) return slab_of(sets[node.part], x);
    Spans out;
    for (std::size_t i = 0; i < node.operands.size(); ++i)
    {
        Spans other = evaluate_slab(node.operands[i], sets, x);
        if (i == 0)
            out = std::move(other);
        else if (node.op == BooleanOp::Union)
            out = unite(out, other);
        else if (node.op == BooleanOp::Intersection)
            out = intersect(out, other);
        else
            out = subtract(out, other);
    }
    return out;
}

void mark_staying(const BooleanNode& node, bool stays, std::vector<char>& out)
{
    if (node.op == BooleanOp::Part)
    {
        if (stays) out[node.part] = 1;
        return;
    }
    for (std::size_t i = 0; i < node.operands.size(); ++i)
        mark_staying(node.operands[i], node.op == BooleanOp::Difference && i > 0 ? !stays : stays,
                     out);
}

} // namespace

bool evaluate(const BooleanNode& node, const std::vector<char>& is_in)
{
    if (node.op == BooleanOp::Part) return is_in[node.part] != 0;
    bool result = evaluate(node.operands[0], is_in);
    for (std::size_t i = 1; i < node.operands.size(); ++i)
    {
        const bool other = evaluate(node.operands[i], is_in);
        if (node.op == BooleanOp::Union)
            result = result || other;
        else
            result = result && (node.op == BooleanOp::Intersection ? other : !other);
    }
    return result;
}

std::vector<char> staying_parts(const BooleanNode& node, std::size_t parts)
{
    std::vector<char> out(parts, 0);
    mark_staying(node, true, out);
    return out;
}

SpanSet boolean_spans(const std::vector<SpanSet>& sets, const BooleanNode& node, int threads)
{
    std::size_t begin = SIZE_MAX, end = 0;
    for (const SpanSet& set : sets)
    {
        if (set.slabs.empty()) continue;
        begin = std::min<std::size_t>(begin, set.x_begin);
        end = std::max(end, set.x_begin + set.slabs.size());
    }
    SpanSet out;
    if (begin >= end) return out;
    out.x_begin = static_cast<std::uint32_t>(begin);
    out.slabs.resize(end - begin);
    parallel_for(out.slabs.size(), threads,
                 [&](std::size_t i) { out.slabs[i] = evaluate_slab(node, sets, begin + i); });
    trim(out);
    return out;
}

std::vector<SpanSet> share_out(const SpanSet& nodes, const std::vector<SpanSet>& sets,
                               const BooleanNode& node, int threads)
{
    const std::vector<char> stays = staying_parts(node, sets.size());
    std::vector<SpanSet> out(sets.size());
    for (SpanSet& set : out)
    {
        set.x_begin = nodes.x_begin;
        set.slabs.resize(nodes.slabs.size());
    }
    parallel_for(nodes.slabs.size(), threads,
                 [&](std::size_t i)
                 {
                     Spans left = nodes.slabs[i];
                     for (std::size_t p = 0; p < sets.size() && !left.empty(); ++p)
                     {
                         if (stays[p] == 0) continue;
                         const Spans& own = slab_of(sets[p], nodes.x_begin + i);
                         out[p].slabs[i] = intersect(left, own);
                         left = subtract(left, own);
                     }
                 });
    for (SpanSet& set : out) trim(set);
    return out;
}

} // namespace fppg
