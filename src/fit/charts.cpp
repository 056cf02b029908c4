#include "fit/charts.h"

#include <algorithm>
#include <limits>

namespace fppg
{

namespace
{

constexpr double chart_area = 8192;  ///< dp squared, at which a chart is closed
constexpr double scrap_area = 1024;  ///< dp squared, below which a rest joins its neighbour
constexpr double crumb_width = 0.5;  ///< dp, below which a whole part is a crumb
constexpr double cell_width = 6;     ///< dp
constexpr double cell_clearance = 2; ///< dp around facets that counts as near

std::int64_t floor_of(double x)
{
    // Truncation after a shift that makes all numbers positive: faster than floor().
    return static_cast<std::int64_t>(x + 1048576.0) - 1048576;
}

} // namespace

Charts::Charts(const WorkMesh& mesh, double dp) : cell_(cell_width * dp)
{
    cut(mesh, dp);
    mark_cells(mesh, dp);
    make_waves();
}

void Charts::cut(const WorkMesh& mesh, double dp)
{
    const std::size_t n = mesh.facets.size();
    chart_of_facet_.assign(n, no_index);
    std::vector<std::uint32_t> chart_name; // where a chart that was joined to another ends up
    std::vector<char> is_crumb;
    KeyTable crumb_cells;
    std::vector<std::uint32_t> crumbs_of_cell;
    std::vector<std::uint32_t> queue;
    for (std::uint32_t seed = 0; seed < n; ++seed)
    {
        if (chart_of_facet_[seed] != no_index) continue;
        auto chart = static_cast<std::uint32_t>(chart_name.size());
        std::uint32_t neighbour = no_index;
        double area = 0;
        Box3 box;
        queue.assign(1, seed);
        chart_of_facet_[seed] = chart;
        std::size_t taken = 0;
        for (; taken < queue.size() && area < chart_area * dp * dp; ++taken)
        {
            area += mesh.area(queue[taken]);
            for (const Vec3& corner : mesh.facets[queue[taken]].corners) box.add(corner);
            for (const std::uint32_t next : mesh.facets[queue[taken]].neighbours)
            {
                if (next == no_index) continue;
                if (chart_of_facet_[next] == no_index)
                {
                    chart_of_facet_[next] = chart;
                    queue.push_back(next);
                }
                else if (chart_of_facet_[next] != chart)
                    neighbour = std::min(neighbour, chart_name[chart_of_facet_[next]]);
            }
        }
        for (std::size_t i = taken; i < queue.size(); ++i) chart_of_facet_[queue[i]] = no_index;
        const bool is_scrap = area < scrap_area * dp * dp && neighbour != no_index;
        const Vec3 width = box.max - box.min;
        is_crumb.push_back(neighbour == no_index &&
                           std::max({width.x, width.y, width.z}) < crumb_width * dp);
        if (is_crumb.back())
        {
            const std::uint32_t cell =
                crumb_cells.find_or_add(key_of(mesh.facets[seed].corners[0]));
            if (cell == crumbs_of_cell.size()) crumbs_of_cell.push_back(chart);
            chart = crumbs_of_cell[cell];
        }
        chart_name.push_back(is_scrap ? neighbour : chart);
    }
    // Joined charts leave gaps in the numbering, which are closed here.
    std::vector<std::uint32_t> number(chart_name.size(), 0);
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < chart_name.size(); ++c)
    {
        if (chart_name[c] == c) is_crumbs_.push_back(is_crumb[c]);
        number[c] = chart_name[c] == c ? count++ : number[chart_name[c]];
    }
    first_facet_.assign(count + std::size_t{1}, 0);
    for (std::uint32_t& chart : chart_of_facet_)
    {
        chart = number[chart];
        ++first_facet_[chart + std::size_t{1}];
    }
    for (std::size_t c = 0; c < count; ++c) first_facet_[c + 1] += first_facet_[c];
    facets_.resize(n);
    std::vector<std::size_t> end(first_facet_.begin(), first_facet_.end() - 1);
    for (std::uint32_t f = 0; f < n; ++f) facets_[end[chart_of_facet_[f]]++] = f;
}

std::uint64_t Charts::key_of(const Vec3& point) const
{
    return cell_key(floor_of(point.x / cell_), floor_of(point.y / cell_),
                    floor_of(point.z / cell_));
}

namespace
{

/// The cells of this side that a facet and its surroundings reach into, in pairs per axis.
CellRange cells_around(const WorkFacet& facet, double clearance, double cell)
{
    CellRange range{};
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] =
            std::minmax({facet.corners[0][axis], facet.corners[1][axis], facet.corners[2][axis]});
        const std::size_t at = 2 * static_cast<std::size_t>(axis);
        range[at] = floor_of((low - clearance) / cell);
        range[at + 1] = floor_of((high + clearance) / cell);
    }
    return range;
}

} // namespace

void Charts::mark_cells_of(std::uint32_t chart, const WorkFacet& facet, const CellRange& range,
                           double slab)
{
    // Nested because the cells around a facet are walked along three axes.
    for (auto i = range[0]; i <= range[1]; ++i)
        for (auto j = range[2]; j <= range[3]; ++j)
            for (auto k = range[4]; k <= range[5]; ++k)
            {
                const Vec3 middle{(static_cast<double>(i) + 0.5) * cell_,
                                  (static_cast<double>(j) + 0.5) * cell_,
                                  (static_cast<double>(k) + 0.5) * cell_};
                if (std::abs(dot(middle - facet.corners[0], facet.normal)) > slab) continue;
                const std::uint32_t cell = cells_.find_or_add(cell_key(i, j, k));
                if (cell == charts_of_cell_.size()) charts_of_cell_.emplace_back();
                auto& charts = charts_of_cell_[cell];
                if (charts.empty() || charts.back() != chart) charts.push_back(chart);
            }
}

void Charts::mark_cells(const WorkMesh& mesh, double dp)
{
    const double clearance = cell_clearance * dp;
    const Vec3 margin{clearance, clearance, clearance};
    const double slab = clearance + 0.8660254 * cell_;
    constexpr double any_distance = std::numeric_limits<double>::infinity();
    CellRange last{};
    boxes_.resize(size());
    for (std::uint32_t chart = 0; chart < size(); ++chart)
    {
        bool is_first = true;
        for (const std::uint32_t f : facets(chart))
        {
            const WorkFacet& facet = mesh.facets[f];
            for (const Vec3& corner : facet.corners)
            {
                boxes_[chart].add(corner - margin);
                boxes_[chart].add(corner + margin);
            }
            const CellRange range = cells_around(facet, clearance, cell_);
            const bool is_small =
                (range[1] - range[0] + 1) * (range[3] - range[2] + 1) * (range[5] - range[4] + 1) <=
                8;
            // Facets smaller than a cell come in rows with the same range.
            if (is_small && !is_first && range == last) continue;
            is_first = false;
            last = is_small ? range : CellRange{0, -1, 0, -1, 0, -1};
            mark_cells_of(chart, facet, range, is_small ? any_distance : slab);
        }
    }
}

void Charts::make_waves()
{
    near_charts_.resize(size());
    for (const auto& charts : charts_of_cell_)
        for (const std::uint32_t a : charts)
            for (const std::uint32_t b : charts)
                if (a != b) near_charts_[a].push_back(b);
    std::vector<std::uint32_t> wave_of(size(), no_index);
    std::vector<char> is_taken;
    for (std::uint32_t chart = 0; chart < size(); ++chart)
    {
        auto& near = near_charts_[chart];
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        is_taken.assign(waves_.size() + 1, 0);
        for (const std::uint32_t other : near)
            if (wave_of[other] != no_index) is_taken[wave_of[other]] = 1;
        const auto wave = static_cast<std::size_t>(std::find(is_taken.begin(), is_taken.end(), 0) -
                                                   is_taken.begin());
        if (wave == waves_.size()) waves_.emplace_back();
        waves_[wave].push_back(chart);
        wave_of[chart] = static_cast<std::uint32_t>(wave);
    }
}

std::span<const std::uint32_t> Charts::near_point(const Vec3& point) const
{
    const std::uint32_t cell = cells_.find(key_of(point));
    if (cell == KeyTable::none) return {};
    return charts_of_cell_[cell];
}

bool Charts::is_near(std::uint32_t chart, const Vec3& point) const
{
    const Box3& box = boxes_[chart];
    if (point.x < box.min.x || point.y < box.min.y || point.z < box.min.z || point.x > box.max.x ||
        point.y > box.max.y || point.z > box.max.z)
        return false;
    const auto charts = near_point(point);
    return std::binary_search(charts.begin(), charts.end(), chart);
}

} // namespace fppg
