#include "fppg/boolean.h"

#include "core/parallel.h"
#include "fit/closed_part.h"
#include "fppg/shapes.h"

#include <algorithm>

namespace fppg
{
namespace
{

using Spans = std::vector<Span>;

/// Merges two sorted lists of spans; keep(in_a, in_b) says which nodes stay.
template <typename Keep>
Spans combine(const Spans& a, const Spans& b, const Keep& keep)
{
    struct End
    {
        std::uint32_t y, z;
        bool operator<(const End& o) const { return y != o.y ? y < o.y : z < o.z; }
        bool operator==(const End&) const = default;
    };
    // Ends of spans in order; an even index begins one, an odd one ends it.
    const auto end_at = [](const Spans& s, std::size_t i) {
        return End{s[i / 2].y, i % 2 == 0 ? s[i / 2].z_begin : s[i / 2].z_end};
    };
    Spans out;
    std::size_t i = 0, j = 0;
    bool was_in = false;
    End begin{0, 0};
    while (i < 2 * a.size() || j < 2 * b.size())
    {
        const bool has_a = i < 2 * a.size(), has_b = j < 2 * b.size();
        End at = has_a ? end_at(a, i) : end_at(b, j);
        if (has_a && has_b) at = std::min(at, end_at(b, j));
        while (i < 2 * a.size() && end_at(a, i) == at) ++i;
        while (j < 2 * b.size() && end_at(b, j) == at) ++j;
        const bool is_in = keep(i % 2 == 1, j % 2 == 1);
        if (is_in == was_in) continue;
        if (is_in)
            begin = at;
        else
            out.push_back({begin.y, begin.z, at.z});
        was_in = is_in;
    }
    return out;
}

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
            out = combine(out, other, [](bool a, bool b) { return a || b; });
        else if (node.op == BooleanOp::Intersection)
            out = combine(out, other, [](bool a, bool b) { return a && b; });
        else
            out = combine(out, other, [](bool a, bool b) { return a && !b; });
    }
    return out;
}

void trim(SpanSet& set)
{
    std::size_t begin = 0;
    while (begin < set.slabs.size() && set.slabs[begin].empty()) ++begin;
    while (set.slabs.size() > begin && set.slabs.back().empty()) set.slabs.pop_back();
    set.slabs.erase(set.slabs.begin(), set.slabs.begin() + static_cast<std::ptrdiff_t>(begin));
    set.x_begin = set.slabs.empty() ? 0 : static_cast<std::uint32_t>(set.x_begin + begin);
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

SpanSet solid_nodes(const SurfaceMesh& mesh, const LatticeGrid& grid, int threads)
{
    const ClosedPart closed = find_closed_part(mesh);
    if (!(closed.volume > 0) || closed.soup.size() == 0) return {};
    if (closed.is_exact) return inside_spans(closed.soup, grid, threads);
    std::uint64_t disputed = 0;
    return inside_by_vote(closed.soup, grid, threads, disputed);
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
                         out[p].slabs[i] =
                             combine(left, own, [](bool a, bool b) { return a && b; });
                         left = combine(left, own, [](bool a, bool b) { return a && !b; });
                     }
                 });
    for (SpanSet& set : out) trim(set);
    return out;
}

} // namespace fppg
