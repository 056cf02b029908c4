#include "meshes/column_spans.h"

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "core/parallel.h"
#include "meshes/column_cut.h"
#include "nodes/spans.h"

namespace fppg
{

namespace
{

/// Nodes along one axis.
struct Axis
{
    double origin;
    double dp;
    std::int64_t n;

    double at(std::int64_t i) const { return origin + static_cast<double>(i) * dp; }
    /// A node at or below `value`, at most two too low; -2 below and n above the lattice.
    std::int64_t below(double value) const
    {
        const double index = std::floor((value - origin) / dp) - 1;
        return static_cast<std::int64_t>(std::clamp(index, -2.0, static_cast<double>(n)));
    }
    std::int64_t first_of(double value) const { return std::max<std::int64_t>(0, below(value)); }
    /// One past the last node that can lie at or below `value`.
    std::int64_t end_of(double value) const { return std::min(n, below(value) + 3); }
};

/// At node k of the column at row y the sum of crossings changes by `step`.
struct Event
{
    std::uint32_t y;
    std::uint32_t k;
    std::int32_t step;
};

/// Where a column passes through a facet, for the volume between facets.
struct Passage
{
    std::uint32_t y;
    std::int32_t step;
    double z;
};

/// Numbers [begin, end) between which a value lies.
struct Interval
{
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

/// The values of `value` on the outline of a triangle where `along` has the value `at`; widened by
/// the rounding. Empty if the triangle does not reach there.
Interval outline_at(const Vec3* const corners[3], int along, double at, int value)
{
    constexpr double unit = 8 * std::numeric_limits<double>::epsilon();
    Interval interval;
    for (int i = 0; i < 3; ++i)
    {
        const Vec3& p = *corners[i];
        const Vec3& q = *corners[(i + 1) % 3];
        if (at < std::min(p[along], q[along]) || at > std::max(p[along], q[along])) continue;
        const double error = unit * (std::abs(p[value]) + std::abs(q[value]));
        if (p[along] == q[along])
        {
            interval.low = std::min({interval.low, p[value], q[value]});
            interval.high = std::max({interval.high, p[value], q[value]});
            continue;
        }
        const double share = (at - p[along]) / (q[along] - p[along]);
        const double middle = p[value] + share * (q[value] - p[value]);
        interval.low = std::min(interval.low, middle - error);
        interval.high = std::max(interval.high, middle + error);
    }
    return interval;
}

/// Cuts the columns of one slab (one x) with facets and joins the cuts to spans.
class SlabCutter
{
public:
    SlabCutter(const LatticeGrid& grid, std::int64_t i, const ColumnOptions& options)
        : x_(Axis{grid.origin.x, grid.step(0), grid.n[0]}.at(i)),
          y_{grid.origin.y, grid.step(1), grid.n[1]},
          z_{grid.origin.z, grid.step(2), grid.n[2]},
          options_(options)
    {
    }

    void cut(const ColumnFacet& facet)
    {
        const Vec3* const corners[3] = {&facet.a, &facet.b, &facet.c};
        const Interval rows = outline_at(corners, 0, x_, 1);
        if (!(rows.low <= rows.high)) return;
        for (std::int64_t j = y_.first_of(rows.low); j < y_.end_of(rows.high); ++j)
        {
            if (facet.facing != 0)
                cut_sloped(facet, j);
            else
                touch_upright(corners, j);
        }
    }

    std::vector<Span> spans()
    {
        std::sort(events_.begin(), events_.end(),
                  [](const Event& p, const Event& q)
                  { return p.y != q.y ? p.y < q.y : p.k < q.k; });
        std::vector<Span> result;
        for (std::size_t i = 0; i < events_.size();)
        {
            std::int64_t sum = 0;
            std::uint32_t begin = 0;
            const std::uint32_t row = events_[i].y;
            while (i < events_.size() && events_[i].y == row)
            {
                const std::int64_t before = sum;
                const std::uint32_t k = events_[i].k;
                for (; i < events_.size() && events_[i].y == row && events_[i].k == k; ++i)
                    sum += events_[i].step;
                if (before <= 0 && sum > 0) begin = k;
                if (before > 0 && sum <= 0) result.push_back({row, begin, k});
                has_overlap_ = has_overlap_ || sum > 1 || sum < 0;
            }
            if (sum != 0) unbalanced_.push_back(row);
        }
        if (!on_surface_.empty()) join_surface(result);
        return result;
    }

    /// Rows whose sum does not return to zero; after spans().
    const std::vector<std::uint32_t>& unbalanced() const { return unbalanced_; }

    /// The length of all columns that is counted more than once, less that counted below zero; of
    /// columns whose sum returns to zero. After spans().
    double overlap()
    {
        if (!has_overlap_) return 0;
        std::sort(passages_.begin(), passages_.end(),
                  [](const Passage& p, const Passage& q)
                  { return std::tie(p.y, p.z, p.step) < std::tie(q.y, q.z, q.step); });
        double total = 0;
        for (std::size_t i = 0; i < passages_.size();)
        {
            const std::uint32_t row = passages_[i].y;
            double length = 0;
            std::int64_t sum = 0;
            for (; i < passages_.size() && passages_[i].y == row; ++i)
            {
                if (i > 0 && passages_[i - 1].y == row)
                    length += static_cast<double>(sum - (sum > 0 ? 1 : 0)) *
                              (passages_[i].z - passages_[i - 1].z);
                sum += passages_[i].step;
            }
            if (sum == 0) total += length;
        }
        return total;
    }

private:
    void cut_sloped(const ColumnFacet& facet, std::int64_t j)
    {
        const double y = y_.at(j);
        const ColumnCut cut = cut_column(facet, x_, y);
        if (!cut.is_crossed && !cut.is_on_border) return;
        const Height height = height_above(facet, x_, y);
        // The first node that is not below the plane, by bisection with exact signs.
        std::int64_t low = z_.first_of(height.z - height.error);
        std::int64_t high = z_.end_of(height.z + height.error);
        while (low < high)
        {
            const std::int64_t middle = low + (high - low) / 2;
            if (side_of_plane(facet, x_, y, z_.at(middle)) < 0)
                low = middle + 1;
            else
                high = middle;
        }
        std::int64_t above = low;
        while (above < z_.n && side_of_plane(facet, x_, y, z_.at(above)) == 0) ++above;

        const auto row = static_cast<std::uint32_t>(j);
        if (cut.is_crossed)
        {
            const int step = -facet.facing * options_.flip;
            events_.push_back({row, static_cast<std::uint32_t>(step > 0 ? low : above), step});
            if (options_.measures_overlap) passages_.push_back({row, step, height.z});
        }
        if (cut.is_on_border && low < above) add_surface(row, low, above);
    }

    /// Upright facets are crossed by no column, but the nodes on them are on the surface.
    void touch_upright(const Vec3* const corners[3], std::int64_t j)
    {
        const double y = y_.at(j);
        const auto less = [](const Vec3* p, const Vec3* q)
        { return p->x != q->x ? p->x < q->x : p->y < q->y; };
        const Vec3& first = **std::min_element(corners, corners + 3, less);
        const Vec3& last = **std::max_element(corners, corners + 3, less);
        const int along = first.x != last.x ? 0 : 1;
        const double at = along == 0 ? x_ : y;
        if (at < first[along] || at > last[along] ||
            orient2d(first.x, first.y, last.x, last.y, x_, y) != 0)
            return;
        // In the plane of the facet, (along, z), the nodes of the column on it are found exactly.
        const Vec3 &a = *corners[0], &b = *corners[1], &c = *corners[2];
        const int turn = orient2d(a[along], a.z, b[along], b.z, c[along], c.z);
        if (turn == 0) return;
        const auto is_on_facet = [&](std::int64_t k)
        {
            const double z = z_.at(k);
            return orient2d(a[along], a.z, b[along], b.z, at, z) != -turn &&
                   orient2d(b[along], b.z, c[along], c.z, at, z) != -turn &&
                   orient2d(c[along], c.z, a[along], a.z, at, z) != -turn;
        };
        const Interval heights = outline_at(corners, along, at, 2);
        std::int64_t low = z_.first_of(heights.low);
        std::int64_t high = z_.end_of(heights.high);
        while (low < high && !is_on_facet(low)) ++low;
        while (low < high && !is_on_facet(high - 1)) --high;
        if (low < high) add_surface(static_cast<std::uint32_t>(j), low, high);
    }

    void add_surface(std::uint32_t row, std::int64_t begin, std::int64_t end)
    {
        on_surface_.push_back(
            {row, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    }

    void join_surface(std::vector<Span>& spans)
    {
        spans.insert(spans.end(), on_surface_.begin(), on_surface_.end());
        std::sort(spans.begin(), spans.end(),
                  [](const Span& p, const Span& q)
                  { return p.y != q.y ? p.y < q.y : p.z_begin < q.z_begin; });
        std::size_t kept = 0;
        for (std::size_t i = 1; i < spans.size(); ++i)
        {
            Span& last = spans[kept];
            if (spans[i].y == last.y && spans[i].z_begin <= last.z_end)
                last.z_end = std::max(last.z_end, spans[i].z_end);
            else
                spans[++kept] = spans[i];
        }
        spans.resize(kept + 1);
    }

    double x_;
    Axis y_;
    Axis z_;
    ColumnOptions options_;
    bool has_overlap_ = false;
    std::vector<Event> events_;
    std::vector<Passage> passages_;
    std::vector<std::uint32_t> unbalanced_;
    std::vector<Span> on_surface_;
};

/// Slabs [begin, end) that a facet can reach.
struct SlabRange
{
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

SlabRange slabs_of(const Vec3* corners, const LatticeGrid& grid)
{
    const Axis x{grid.origin.x, grid.step(0), grid.n[0]};
    const Axis y{grid.origin.y, grid.step(1), grid.n[1]};
    const auto [x_low, x_high] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    const auto [y_low, y_high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    if (y_high < y.at(0) || y_low > y.at(y.n - 1)) return {};
    SlabRange range{x.first_of(x_low), x.end_of(x_high)};
    while (range.begin < range.end && x.at(range.begin) < x_low) ++range.begin;
    while (range.begin < range.end && x.at(range.end - 1) > x_high) --range.end;
    return range;
}

} // namespace

ColumnCuts cut_columns(const TriangleSoup& soup, const LatticeGrid& grid,
                       const ColumnOptions& options, int threads)
{
    ColumnCuts result;
    std::int64_t begin = grid.n[0];
    std::int64_t end = 0;
    std::vector<SlabRange> ranges(soup.size());
    for (std::size_t i = 0; i < soup.size(); ++i)
    {
        ranges[i] = slabs_of(&soup.vertices[3 * i], grid);
        if (ranges[i].begin >= ranges[i].end) continue;
        begin = std::min(begin, ranges[i].begin);
        end = std::max(end, ranges[i].end);
    }
    if (begin >= end) return result;

    // The facets of every slab, in the order of the file.
    const auto slabs = static_cast<std::size_t>(end - begin);
    std::vector<std::size_t> offsets(slabs + 1, 0);
    const auto for_each_slab = [&](auto&& body)
    {
        for (std::size_t i = 0; i < soup.size(); ++i)
            for (std::int64_t slab = ranges[i].begin; slab < ranges[i].end; ++slab)
                body(i, static_cast<std::size_t>(slab - begin));
    };
    for_each_slab([&](std::size_t, std::size_t slab) { ++offsets[slab + 1]; });
    for (std::size_t slab = 0; slab < slabs; ++slab) offsets[slab + 1] += offsets[slab];
    std::vector<std::uint32_t> facets(offsets[slabs]);
    std::vector<std::size_t> filled(offsets.begin(), offsets.end() - 1);
    for_each_slab([&](std::size_t i, std::size_t slab)
                  { facets[filled[slab]++] = static_cast<std::uint32_t>(i); });

    result.inside.x_begin = static_cast<std::uint32_t>(begin);
    result.inside.slabs.resize(slabs);
    std::vector<std::vector<std::uint32_t>> unbalanced(slabs);
    std::vector<double> overlaps(slabs, 0);
    parallel_for(slabs, threads,
                 [&](std::size_t slab)
                 {
                     SlabCutter cutter(grid, begin + static_cast<std::int64_t>(slab), options);
                     for (std::size_t f = offsets[slab]; f < offsets[slab + 1]; ++f)
                         cutter.cut(ColumnFacet(&soup.vertices[3 * std::size_t{facets[f]}], 2));
                     result.inside.slabs[slab] = cutter.spans();
                     unbalanced[slab] = cutter.unbalanced();
                     if (options.measures_overlap) overlaps[slab] = cutter.overlap();
                 });
    for (std::size_t slab = 0; slab < slabs; ++slab)
    {
        for (const std::uint32_t row : unbalanced[slab])
            result.unbalanced.push_back(
                {result.inside.x_begin + static_cast<std::uint32_t>(slab), row});
        result.overlap += overlaps[slab] * grid.dp * grid.dp;
    }
    trim(result.inside);
    return result;
}

} // namespace fppg
