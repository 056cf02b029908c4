#include "fit/near_nodes.h"

#include "core/lanes.h"
#include "core/parallel.h"
#include "fit/facet_lanes.h"
#include "fppg/error.h"
#include "meshes/near_tree.h"
#include "meshes/outline.h"
#include "meshes/unit_cube.h"
#include "platform/memory.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

#include <fmt/format.h>

namespace fppg
{

namespace
{

/// How far nodes are looked for, in dp; more than 1 by what rounding may take.
constexpr double reach_dp = 1 + 1e-8;
/// Facets whose box is smaller than this need no cutting to rows, in dp.
constexpr double small_facet_dp = 8;

/// Nodes [begin, end) along an axis.
struct Range
{
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// Nodes of the lattice from `low` to `high` metres.
Range nodes_between(double low, double high, double origin, double dp, std::uint32_t n)
{
    const double begin = std::ceil((low - origin) / dp);
    const double end = std::floor((high - origin) / dp) + 1;
    return {static_cast<std::int64_t>(std::clamp(begin, 0.0, static_cast<double>(n))),
            static_cast<std::int64_t>(std::clamp(end, 0.0, static_cast<double>(n)))};
}

Range range_of(const Outline& outline, int axis, double reach, const LatticeGrid& grid)
{
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < outline.count; ++i)
    {
        low = std::min(low, outline.corners[i][axis]);
        high = std::max(high, outline.corners[i][axis]);
    }
    return nodes_between(low - reach, high + reach, grid.origin[axis], grid.step(axis),
                         grid.n[static_cast<std::size_t>(axis)]);
}

/// Nodes [begin, end) of a row that may be near a facet.
struct Stretch
{
    std::uint32_t row;
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t facet; ///< in the order of the slab
};

/// How far a number lies from the interval between two others.
double distance_between(double value, double low, double high)
{
    return std::max({low - value, value - high, 0.0});
}

/// Works through the slabs of a lattice one by one; keeps its memory from slab to slab.
class SlabSearch
{
public:
    /// tree  of the soup, which is asked for the distance of each node then; null: the facets are
    ///       asked one by one
    SlabSearch(const TriangleSoup& soup, const LatticeGrid& grid, const NearTree* tree)
        : soup_(soup), grid_(grid), tree_(tree), reach_(reach_dp * grid.dp), offsets_(grid.n[1] + 1)
    {
        nearest_.resize(grid.n[2] + nodes_at_once, no_distance);
        touched_.resize((grid.n[2] / chunk + 63) / 64 + 1, 0);
    }

    std::vector<NearNode> search(std::uint32_t slab, std::span<const std::uint32_t> facets)
    {
        return is_avx2_there() ? search_avx2(slab, facets) : look(slab, facets);
    }

private:
    static constexpr double no_distance = std::numeric_limits<double>::infinity();
    static constexpr std::uint32_t chunk = 16; ///< nodes of a row that are looked through together
    static constexpr std::uint32_t nodes_at_once = 4;

    FPPG_AVX2 [[gnu::flatten]] std::vector<NearNode> search_avx2(
        std::uint32_t slab, std::span<const std::uint32_t> facets)
    {
        return look(slab, facets);
    }

    FPPG_LANES std::vector<NearNode> look(std::uint32_t slab, std::span<const std::uint32_t> facets)
    {
        x_ = grid_.origin.x + slab * grid_.step(0);
        stretches_.clear();
        facets_.clear();
        boxes_.clear();
        for (const std::uint32_t f : facets) add_stretches(f);
        sort_by_row();
        std::vector<NearNode> result;
        for (std::uint32_t row = first_row_; row < last_row_; ++row)
        {
            for (std::uint32_t i = offsets_[row - first_row_]; i < offsets_[row - first_row_ + 1];
                 ++i)
                measure(stretches_[order_[i]]);
            collect(row, result);
        }
        result.shrink_to_fit();
        return result;
    }

    void add_stretches(std::uint32_t f)
    {
        const Vec3* const corners = &soup_.vertices[3 * std::size_t{f}];
        if (tree_ == nullptr) facets_.emplace_back(corners);
        Box3 box;
        for (int k = 0; k < 3; ++k) box.add(corners[k]);
        boxes_.push_back(box);
        const Vec3 size = box.max - box.min;
        if (std::max({size.x, size.y, size.z}) < small_facet_dp * grid_.dp)
            add_small(box);
        else
            add_large(corners, box);
    }

    void add_small(const Box3& box)
    {
        const double aside = distance_between(x_, box.min.x, box.max.x);
        const double left = reach_ * reach_ - aside * aside;
        if (left < 0) return;
        const double reach = std::sqrt(left);
        const Range rows = nodes_between(box.min.y - reach, box.max.y + reach, grid_.origin.y,
                                         grid_.step(1), grid_.n[1]);
        for (std::int64_t row = rows.begin; row < rows.end; ++row)
        {
            const double y = grid_.origin.y + static_cast<double>(row) * grid_.step(1);
            const double across = distance_between(y, box.min.y, box.max.y);
            const double rest = std::sqrt(std::max(left - across * across, 0.0));
            double low = box.min.z - rest;
            double high = box.max.z + rest;
            if (tree_ == nullptr)
            {
                const auto [begin, end] = facets_.back().within_plane(x_, y, reach_);
                low = std::max(low, begin);
                high = std::min(high, end);
            }
            add(row, nodes_between(low, high, grid_.origin.z, grid_.step(2), grid_.n[2]));
        }
    }

    void add_large(const Vec3* corners, const Box3& box)
    {
        Outline outline;
        for (std::size_t k = 0; k < 3; ++k) outline.add(corners[k]);
        if (box.min.x < x_ - reach_) outline = cut_outline(outline, 0, x_ - reach_, true);
        if (box.max.x > x_ + reach_) outline = cut_outline(outline, 0, x_ + reach_, false);
        if (outline.count == 0) return;
        const Range rows = range_of(outline, 1, reach_, grid_);
        for (std::int64_t row = rows.begin; row < rows.end; ++row)
        {
            const double y = grid_.origin.y + static_cast<double>(row) * grid_.step(1);
            const Outline strip =
                cut_outline(cut_outline(outline, 1, y - reach_, true), 1, y + reach_, false);
            if (strip.count > 0) add(row, range_of(strip, 2, reach_, grid_));
        }
    }

    /// Nodes of a row that may be near the facet that was added last.
    void add(std::int64_t row, const Range& nodes)
    {
        if (nodes.begin < nodes.end)
            stretches_.push_back({static_cast<std::uint32_t>(row),
                                  static_cast<std::uint32_t>(nodes.begin),
                                  static_cast<std::uint32_t>(nodes.end),
                                  static_cast<std::uint32_t>(boxes_.size() - 1)});
    }

    /// Facets keep their order within a row.
    void sort_by_row()
    {
        first_row_ = last_row_ = 0;
        if (stretches_.empty()) return;
        first_row_ = stretches_.front().row;
        for (const Stretch& s : stretches_)
        {
            first_row_ = std::min(first_row_, s.row);
            last_row_ = std::max(last_row_, s.row + 1);
        }
        const std::size_t rows = last_row_ - first_row_;
        std::fill_n(offsets_.begin(), rows + 1, 0);
        for (const Stretch& s : stretches_) ++offsets_[s.row - first_row_ + 1];
        for (std::size_t r = 0; r < rows; ++r) offsets_[r + 1] += offsets_[r];
        filled_.assign(offsets_.begin(), offsets_.begin() + static_cast<std::ptrdiff_t>(rows));
        order_.resize(stretches_.size());
        for (std::uint32_t i = 0; i < stretches_.size(); ++i)
            order_[filled_[stretches_[i].row - first_row_]++] = i;
    }

    FPPG_LANES void measure(const Stretch& s)
    {
        const Box3& box = boxes_[s.facet];
        PointsAlongZ p{x_, grid_.origin.y + s.row * grid_.step(1), {}};
        const double aside = distance_between(p.x, box.min.x, box.max.x);
        const double across = distance_between(p.y, box.min.y, box.max.y);
        const double to_row = aside * aside + across * across;
        const DoubleLanes limit = DoubleLanes{} + reach_ * reach_;
        for (std::uint32_t k = s.begin; k < s.end; k += nodes_at_once)
        {
            const double first = k;
            const DoubleLanes node{first, first + 1, first + 2, first + 3};
            p.z = grid_.origin.z + node * grid_.step(2);
            DoubleLanes known;
            std::memcpy(&known, &nearest_[k], sizeof known);
            const DoubleLanes before = smaller(known, limit);
            const DoubleLanes along =
                larger(larger(box.min.z - p.z, p.z - box.max.z), DoubleLanes{});
            const DoubleMask may_be =
                (to_row + along * along < before) & (node < static_cast<double>(s.end));
            if (!is_any_set(may_be)) continue;
            const DoubleLanes squared =
                tree_ != nullptr ? DoubleLanes{} : facets_[s.facet].squared(p, before);
            known = may_be & (squared < before) ? squared : known;
            std::memcpy(&nearest_[k], &known, sizeof known);
        }
        for (std::uint32_t c = s.begin / chunk; c <= (s.end - 1) / chunk; ++c)
            touched_[c / 64] |= std::uint64_t{1} << (c % 64);
    }

    /// The distance of a node of a row that may be near.
    double distance_of(std::uint32_t row, std::uint32_t k) const
    {
        if (tree_ == nullptr) return std::sqrt(nearest_[k]);
        const Vec3 p{x_, grid_.origin.y + row * grid_.step(1), grid_.origin.z + k * grid_.step(2)};
        return tree_->closest(p, reach_).distance;
    }

    /// Lists the nodes of a row and makes it clean for the next.
    void collect(std::uint32_t row, std::vector<NearNode>& result)
    {
        const double scale = distance_units / grid_.dp;
        for (std::size_t word = 0; word < touched_.size(); ++word)
            for (; touched_[word] != 0; touched_[word] &= touched_[word] - 1)
            {
                const auto bit = static_cast<std::uint32_t>(std::countr_zero(touched_[word]));
                const std::uint32_t begin = (static_cast<std::uint32_t>(word) * 64 + bit) * chunk;
                const std::uint32_t end = std::min(begin + chunk, grid_.n[2]);
                for (std::uint32_t k = begin; k < end; ++k)
                {
                    if (nearest_[k] == no_distance) continue;
                    const double distance = std::floor(distance_of(row, k) * scale + 0.5);
                    nearest_[k] = no_distance;
                    if (distance <= distance_units)
                        result.push_back({row, k, static_cast<std::uint32_t>(distance)});
                }
            }
    }

    const TriangleSoup& soup_;
    const LatticeGrid& grid_;
    const NearTree* tree_;
    double reach_;
    double x_ = 0;
    std::vector<FacetDistance> facets_; ///< of the slab in hand; none where the tree is asked
    std::vector<Box3> boxes_;           ///< theirs
    std::vector<Stretch> stretches_;
    std::vector<std::uint32_t> offsets_, filled_, order_;
    std::uint32_t first_row_ = 0, last_row_ = 0;
    /// Squared distance per node of the row in hand, and a few more that are none.
    std::vector<double> nearest_;
    std::vector<std::uint64_t> touched_;
};

/// Nodes within 1 dp: two per dp^2 of surface, and those around long sides.
void check_memory(const TriangleSoup& soup, const LatticeGrid& grid)
{
    double nodes = 0;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* p = &soup.vertices[3 * f];
        const double longest =
            std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])}) / grid.dp;
        nodes += norm(cross(p[1] - p[0], p[2] - p[0])) / (grid.dp * grid.dp);
        if (longest > 2) nodes += longest;
    }
    constexpr double bytes_per_node = 16;
    constexpr double bytes_per_slab = 200;
    const double bytes = bytes_per_node * nodes + bytes_per_slab * grid.n[0];
    const auto available = static_cast<double>(available_memory());
    if (!(bytes < available))
        throw GeometryError(fmt::format(
            "the lattice nodes around the surface need about {:.3g} GB of memory, and {:.3g} GB "
            "are free; take a larger dp or a smaller mesh",
            bytes * 1e-9, available * 1e-9));
}

/// A tree where a node has so many facets near it that asking them one by one takes longer.
std::unique_ptr<NearTree> tree_of_fine(const TriangleSoup& soup, double dp, int threads)
{
    constexpr double many = 4; // facets a dp^2
    double area = 0;
    Box3 box;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* p = &soup.vertices[3 * f];
        area += 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
        for (int k = 0; k < 3; ++k) box.add(p[k]);
    }
    if (!(static_cast<double>(soup.size()) * dp * dp > many * area)) return nullptr;
    const UnitCube cube = unit_cube_of(box);
    return std::make_unique<NearTree>(soup, cube.centre, cube.scale, threads);
}

} // namespace

std::vector<std::vector<NearNode>> find_near_nodes(const TriangleSoup& soup,
                                                   const LatticeGrid& grid, int threads)
{
    check_memory(soup, grid);
    // The facets of every slab, in their order.
    std::vector<Range> ranges(soup.size());
    std::vector<std::size_t> offsets(grid.n[0] + std::size_t{1}, 0);
    const double reach = reach_dp * grid.dp;
    for (std::size_t f = 0; f < ranges.size(); ++f)
    {
        const auto [low, high] = std::minmax(
            {soup.vertices[3 * f].x, soup.vertices[3 * f + 1].x, soup.vertices[3 * f + 2].x});
        ranges[f] =
            nodes_between(low - reach, high + reach, grid.origin.x, grid.step(0), grid.n[0]);
        for (std::int64_t x = ranges[f].begin; x < ranges[f].end; ++x)
            ++offsets[static_cast<std::size_t>(x) + 1];
    }
    for (std::size_t x = 0; x < grid.n[0]; ++x) offsets[x + 1] += offsets[x];
    std::vector<std::uint32_t> facets(offsets.back());
    std::vector<std::size_t> filled(offsets.begin(), offsets.end() - 1);
    for (std::size_t f = 0; f < ranges.size(); ++f)
        for (std::int64_t x = ranges[f].begin; x < ranges[f].end; ++x)
            facets[filled[static_cast<std::size_t>(x)]++] = static_cast<std::uint32_t>(f);

    const std::unique_ptr<NearTree> tree = tree_of_fine(soup, grid.dp, threads);
    std::vector<std::vector<NearNode>> slabs(grid.n[0]);
    std::vector<std::unique_ptr<SlabSearch>> idle;
    std::mutex guard;
    parallel_for(grid.n[0], threads,
                 [&](std::size_t x)
                 {
                     if (offsets[x] == offsets[x + 1]) return;
                     std::unique_ptr<SlabSearch> search;
                     {
                         const std::lock_guard lock(guard);
                         if (!idle.empty())
                         {
                             search = std::move(idle.back());
                             idle.pop_back();
                         }
                     }
                     if (!search) search = std::make_unique<SlabSearch>(soup, grid, tree.get());
                     slabs[x] =
                         search->search(static_cast<std::uint32_t>(x),
                                        {facets.data() + offsets[x], offsets[x + 1] - offsets[x]});
                     const std::lock_guard lock(guard);
                     idle.push_back(std::move(search));
                 });
    return slabs;
}

} // namespace fppg
