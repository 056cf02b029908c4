#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace fppg
{

/// The spans of one slab, sorted by (y, z_begin), disjoint, not touching (unless said otherwise).
using Spans = std::vector<Span>;

/// Index limits of nodes, half open on each axis; empty when any end <= begin.
struct NodeBox
{
    std::array<std::int64_t, 3> begin{0, 0, 0};
    std::array<std::int64_t, 3> end{0, 0, 0};

    bool is_empty() const { return end[0] <= begin[0] || end[1] <= begin[1] || end[2] <= begin[2]; }
};

/// All nodes of the lattice.
NodeBox whole_lattice(const LatticeGrid& grid);
NodeBox intersect(const NodeBox& a, const NodeBox& b);

/// Sorts spans that come in any order, joins those that overlap or touch.
void sort_and_join(Spans& spans);
/// Set operations on the spans of one slab.
Spans unite(const Spans& a, const Spans& b);
Spans intersect(const Spans& a, const Spans& b);
Spans subtract(const Spans& a, const Spans& b);
/// Adds a node behind all that the spans hold, by y and then z.
void append_node(Spans& spans, std::uint32_t y, std::uint32_t z);
/// Takes the empty slabs at both ends away.
void trim(SpanSet& set);
/// The part inside the y and z limits of a box.
Spans clip_to_box(const Spans& spans, const NodeBox& box);
/// The nodes of a box that are not in `spans`; one span a column where nothing is drawn.
Spans complement(const Spans& spans, const NodeBox& box);

/// Gives the nodes of `spans` the value `mk` (0 erases) in the runs of one slab.
void paint(std::vector<Run>& runs, const Spans& spans, std::uint16_t mk, bool is_covered = false);
/// The nodes whose mk is wanted, covered ones too. `wanted` has 65536 entries; entry 0 is not
/// looked at.
Spans select(const std::vector<Run>& runs, const std::vector<char>& wanted);
/// All nodes that carry an mk.
Spans occupied(const std::vector<Run>& runs);

/// The nodes that keeps(y, z) takes, of spans along columns of which it takes all up to some z or
/// all from some z on: the limit is found by bisection.
template <typename Keeps>
Spans part_of_columns(const Spans& spans, const Keeps& keeps)
{
    Spans kept;
    kept.reserve(spans.size());
    for (const Span& s : spans)
    {
        const bool first = keeps(s.y, s.z_begin);
        const bool last = keeps(s.y, s.z_end - 1);
        if (first && last) kept.push_back(s);
        if (first == last) continue;
        std::uint32_t in = first ? s.z_begin : s.z_end - 1;
        std::uint32_t out = first ? s.z_end - 1 : s.z_begin;
        while (std::max(in, out) - std::min(in, out) > 1)
        {
            const std::uint32_t middle = std::midpoint(in, out);
            keeps(s.y, middle) ? in = middle : out = middle;
        }
        kept.push_back(first ? Span{s.y, s.z_begin, in + 1} : Span{s.y, in, s.z_end});
    }
    return kept;
}

/// The test of a clip plane, in the arithmetic of GenCase v5.0: the normal is scaled to length one
/// when the clip is read and again here. All 2689 nodes exactly on 100 planes are as its; scaled
/// once, 1548 of the first 1628.
class Clip
{
public:
    explicit Clip(const ClipPlane& plane);

    bool keeps(const Vec3& p) const { return dot(normal_, p) + offset_ <= 0; }

private:
    Vec3 normal_;
    double offset_;
};

/// Drops the nodes of one slab that a clip refuses. Along a column the test value is monotone in
/// double too, so the limit is found by bisection on the test itself.
void apply_clip(Spans& spans, std::uint32_t slab, const ClipPlane& plane, const LatticeGrid& grid);

/// A region that can be listed slab by slab: emit(x, out) appends the spans of slab x in any order.
/// Calls for different x may run at the same time.
struct SlabRegion
{
    std::uint32_t x_begin = 0;
    std::uint32_t x_end = 0;
    std::function<void(std::uint32_t x, Spans& out)> emit;
};

/// The spans of a region in one slab, sorted, within the clips.
Spans listed(const SlabRegion& region, std::uint32_t x, const std::vector<ClipPlane>& clips,
             const LatticeGrid& grid);

/// A set of nodes as a region.
SlabRegion region_of(SpanSet set);

} // namespace fppg
