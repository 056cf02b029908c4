#include "nodes/spans.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

namespace fppg
{
namespace
{

/// An object, not a function, so that sorting does not call it by pointer.
constexpr auto starts_before = [](const Span& a, const Span& b)
{ return a.y != b.y ? a.y < b.y : a.z_begin < b.z_begin; };

/// Appends a span that does not start before the last one, joining what overlaps or touches.
void append_joined(Spans& out, const Span& s)
{
    if (!out.empty() && out.back().y == s.y && out.back().z_end >= s.z_begin)
        out.back().z_end = std::max(out.back().z_end, s.z_end);
    else
        out.push_back(s);
}

void append_run(std::vector<Run>& out, const Run& r)
{
    if (!out.empty() && out.back().y == r.y && out.back().z_end == r.z_begin &&
        out.back().mk == r.mk && out.back().is_covered == r.is_covered)
        out.back().z_end = r.z_end;
    else
        out.push_back(r);
}

} // namespace

NodeBox whole_lattice(const LatticeGrid& grid)
{
    return {{0, 0, 0}, {grid.n[0], grid.n[1], grid.n[2]}};
}

NodeBox intersect(const NodeBox& a, const NodeBox& b)
{
    NodeBox out;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        out.begin[axis] = std::max(a.begin[axis], b.begin[axis]);
        out.end[axis] = std::min(a.end[axis], b.end[axis]);
    }
    return out;
}

void sort_and_join(Spans& spans)
{
    if (!std::is_sorted(spans.begin(), spans.end(), starts_before))
        std::sort(spans.begin(), spans.end(), starts_before);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < spans.size(); ++i)
    {
        const Span s = spans[i];
        if (kept > 0 && spans[kept - 1].y == s.y && spans[kept - 1].z_end >= s.z_begin)
            spans[kept - 1].z_end = std::max(spans[kept - 1].z_end, s.z_end);
        else
            spans[kept++] = s;
    }
    spans.resize(kept);
}

Spans unite(const Spans& a, const Spans& b)
{
    Spans out;
    out.reserve(a.size() + b.size());
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size())
    {
        const bool take_a = j == b.size() || (i < a.size() && starts_before(a[i], b[j]));
        append_joined(out, take_a ? a[i++] : b[j++]);
    }
    return out;
}

Spans intersect(const Spans& a, const Spans& b)
{
    Spans out;
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() && j < b.size())
    {
        if (a[i].y != b[j].y)
        {
            a[i].y < b[j].y ? ++i : ++j;
            continue;
        }
        const std::uint32_t begin = std::max(a[i].z_begin, b[j].z_begin);
        const std::uint32_t end = std::min(a[i].z_end, b[j].z_end);
        if (begin < end) out.push_back({a[i].y, begin, end});
        a[i].z_end < b[j].z_end ? ++i : ++j;
    }
    return out;
}

Spans subtract(const Spans& a, const Spans& b)
{
    Spans out;
    std::size_t j = 0;
    for (const Span& s : a)
    {
        while (j < b.size() && (b[j].y < s.y || (b[j].y == s.y && b[j].z_end <= s.z_begin))) ++j;
        std::uint32_t from = s.z_begin;
        for (std::size_t k = j; k < b.size() && b[k].y == s.y && b[k].z_begin < s.z_end; ++k)
        {
            if (b[k].z_begin > from) out.push_back({s.y, from, b[k].z_begin});
            from = std::max(from, b[k].z_end);
        }
        if (from < s.z_end) out.push_back({s.y, from, s.z_end});
    }
    return out;
}

void append_node(Spans& spans, std::uint32_t y, std::uint32_t z)
{
    if (!spans.empty() && spans.back().y == y && spans.back().z_end == z)
        ++spans.back().z_end;
    else
        spans.push_back({y, z, z + 1});
}

void trim(SpanSet& set)
{
    std::size_t begin = 0;
    while (begin < set.slabs.size() && set.slabs[begin].empty()) ++begin;
    while (set.slabs.size() > begin && set.slabs.back().empty()) set.slabs.pop_back();
    set.slabs.erase(set.slabs.begin(), set.slabs.begin() + static_cast<std::ptrdiff_t>(begin));
    set.x_begin = set.slabs.empty() ? 0 : static_cast<std::uint32_t>(set.x_begin + begin);
}

Spans clip_to_box(const Spans& spans, const NodeBox& box)
{
    Spans out;
    if (box.is_empty()) return out;
    for (const Span& s : spans)
    {
        if (s.y < box.begin[1] || s.y >= box.end[1]) continue;
        const std::int64_t begin = std::max<std::int64_t>(s.z_begin, box.begin[2]);
        const std::int64_t end = std::min<std::int64_t>(s.z_end, box.end[2]);
        if (begin < end)
            out.push_back(
                {s.y, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    }
    return out;
}

Spans complement(const Spans& spans, const NodeBox& box)
{
    Spans out;
    if (box.is_empty()) return out;
    const auto z0 = static_cast<std::uint32_t>(box.begin[2]);
    const auto z1 = static_cast<std::uint32_t>(box.end[2]);
    std::size_t i = 0;
    for (auto y = static_cast<std::uint32_t>(box.begin[1]); y < box.end[1]; ++y)
    {
        while (i < spans.size() && spans[i].y < y) ++i;
        std::uint32_t from = z0;
        for (; i < spans.size() && spans[i].y == y; ++i)
        {
            if (spans[i].z_begin >= z1) continue;
            if (spans[i].z_begin > from) out.push_back({y, from, spans[i].z_begin});
            from = std::max(from, spans[i].z_end);
        }
        if (from < z1) out.push_back({y, from, z1});
    }
    return out;
}

void paint(std::vector<Run>& runs, const Spans& spans, std::uint16_t mk, bool is_covered)
{
    if (spans.empty()) return;
    // Only the rows that the spans touch are rebuilt; everything around them stays in place.
    const auto row_less = [](const Run& r, std::uint32_t y) { return r.y < y; };
    const auto first = std::lower_bound(runs.begin(), runs.end(), spans.front().y, row_less);
    const auto last = std::lower_bound(first, runs.end(), spans.back().y + 1, row_less);

    std::vector<Run> rebuilt;
    rebuilt.reserve(static_cast<std::size_t>(last - first) + spans.size());
    auto r = first;
    std::uint32_t from = r != last ? r->z_begin : 0; // what is left of *r starts here
    const auto next_run = [&]
    {
        ++r;
        from = r != last ? r->z_begin : 0;
    };
    for (const Span& s : spans)
    {
        while (r != last && (r->y < s.y || (r->y == s.y && r->z_end <= s.z_begin)))
        {
            append_run(rebuilt, {r->y, from, r->z_end, r->mk, r->is_covered});
            next_run();
        }
        if (r != last && r->y == s.y && from < s.z_begin)
            append_run(rebuilt, {r->y, from, s.z_begin, r->mk, r->is_covered});
        if (mk != 0) append_run(rebuilt, {s.y, s.z_begin, s.z_end, mk, is_covered});
        while (r != last && r->y == s.y && r->z_end <= s.z_end) next_run();
        if (r != last && r->y == s.y && from < s.z_end) from = s.z_end;
    }
    while (r != last)
    {
        append_run(rebuilt, {r->y, from, r->z_end, r->mk, r->is_covered});
        next_run();
    }
    const auto old_count = static_cast<std::size_t>(last - first);
    const auto at = static_cast<std::size_t>(first - runs.begin());
    if (rebuilt.size() > old_count)
        runs.insert(last, rebuilt.size() - old_count, Run{});
    else
        runs.erase(first + static_cast<std::ptrdiff_t>(rebuilt.size()), last);
    std::copy(rebuilt.begin(), rebuilt.end(), runs.begin() + static_cast<std::ptrdiff_t>(at));
}

Spans select(const std::vector<Run>& runs, const std::vector<char>& wanted)
{
    Spans out;
    for (const Run& r : runs)
        if (wanted[r.mk]) append_joined(out, {r.y, r.z_begin, r.z_end});
    return out;
}

Spans occupied(const std::vector<Run>& runs)
{
    Spans out;
    for (const Run& r : runs) append_joined(out, {r.y, r.z_begin, r.z_end});
    return out;
}

Clip::Clip(const ClipPlane& plane)
    : normal_(plane.normal / norm(plane.normal)), offset_(-dot(normal_, plane.point))
{
}

void apply_clip(Spans& spans, std::uint32_t slab, const ClipPlane& plane, const LatticeGrid& grid)
{
    const Clip clip(plane);
    const double x = grid.origin.x + static_cast<double>(slab) * grid.step(0);
    spans =
        part_of_columns(spans,
                        [&](std::uint32_t j, std::uint32_t k)
                        {
                            const double y = grid.origin.y + static_cast<double>(j) * grid.step(1);
                            const double z = grid.origin.z + static_cast<double>(k) * grid.step(2);
                            return clip.keeps({x, y, z});
                        });
}

Spans listed(const SlabRegion& region, std::uint32_t x, const std::vector<ClipPlane>& clips,
             const LatticeGrid& grid)
{
    Spans spans;
    if (x < region.x_begin || x >= region.x_end) return spans;
    region.emit(x, spans);
    for (const ClipPlane& clip : clips) apply_clip(spans, x, clip, grid);
    sort_and_join(spans);
    return spans;
}

SlabRegion region_of(SpanSet set)
{
    auto shared = std::make_shared<const SpanSet>(std::move(set));
    SlabRegion region;
    region.x_begin = shared->x_begin;
    region.x_end = shared->x_begin + static_cast<std::uint32_t>(shared->slabs.size());
    region.emit = [shared](std::uint32_t x, Spans& out)
    { out = shared->slabs[x - shared->x_begin]; };
    return region;
}

} // namespace fppg
