#include "meshes/bathymetry_heights.h"
#include "core/float32.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace fppg
{
namespace
{

/// The points sorted into square cells. Rows and columns of cells are counted from 0.
class PointCells
{
public:
    PointCells(const std::vector<Vec3>& points, double cell) : points_(points), cell_(cell)
    {
        for (const Vec3& p : points) box_.add(p);
        const double margin = 0.1 * cell;
        x_begin_ = box_.min.x - margin;
        y_begin_ = box_.min.y - margin;
        columns_ = static_cast<std::int64_t>(std::ceil((box_.max.x + margin - x_begin_) / cell));
        rows_ = static_cast<std::int64_t>(std::ceil((box_.max.y + margin - y_begin_) / cell));
        begins_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
        for (const Vec3& p : points) ++begins_[cell_of(p) + 1];
        for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
        std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
        sorted_.resize(points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i) sorted_[next[cell_of(points[i])]++] = i;
        count_below();
    }

    std::int64_t column_of(double x) const { return index((x - x_begin_) / cell_, columns_); }
    std::int64_t row_of(double y) const { return index((y - y_begin_) / cell_, rows_); }
    std::int64_t last_ring() const { return std::max(columns_, rows_); }
    double cell() const { return cell_; }

    /// Calls visit(index) for the points of one ring of cells, or what GenCase takes of it.
    template <typename Visit>
    void visit_ring(std::int64_t column, std::int64_t row, std::int64_t ring,
                    const Visit& visit) const
    {
        if (ring == 0) return visit_cells(column, column, row, visit);
        const std::int64_t left = std::max<std::int64_t>(column - ring, 0);
        const std::int64_t right = std::min(column + ring, columns_ - 1);
        if (row - ring >= 0) visit_cells(left, right, row - ring, visit);
        if (row + ring < rows_) visit_cells(left, right, row + ring, visit);
        for (std::int64_t y = std::max<std::int64_t>(row - ring, 0) + 1;
             y < std::min(row + ring, rows_ - 1); ++y)
        {
            if (column - ring >= 0) visit_cells(column - ring, column - ring, y, visit);
            if (column + ring < columns_) visit_cells(column + ring, column + ring, y, visit);
        }
    }

    /// Whether each quadrant of a cell, its own row and column included, has points.
    bool may_be_surrounded(std::int64_t column, std::int64_t row) const
    {
        const auto below = [&](std::int64_t x, std::int64_t y)
        { return below_[static_cast<std::size_t>(y * (columns_ + 1) + x)]; };
        const std::size_t left_below = below(column + 1, row + 1);
        const std::size_t right_below = below(columns_, row + 1) - below(column, row + 1);
        const std::size_t left_above = below(column + 1, rows_) - below(column + 1, row);
        const std::size_t right_above =
            points_.size() - below(column, rows_) - below(columns_, row) + below(column, row);
        return left_below > 0 && right_below > 0 && left_above > 0 && right_above > 0;
    }

private:
    static std::int64_t index(double cells, std::int64_t count)
    {
        return static_cast<std::int64_t>(
            std::clamp(std::floor(cells), 0.0, static_cast<double>(count - 1)));
    }
    std::size_t cell_of(const Vec3& p) const
    {
        return static_cast<std::size_t>(row_of(p.y) * columns_ + column_of(p.x));
    }
    template <typename Visit>
    void visit_cells(std::int64_t first, std::int64_t last, std::int64_t row,
                     const Visit& visit) const
    {
        const auto begin = static_cast<std::size_t>(row * columns_ + first);
        const auto end = static_cast<std::size_t>(row * columns_ + last) + 1;
        for (std::size_t k = begins_[begin]; k < begins_[end]; ++k) visit(sorted_[k]);
    }
    /// below_[y * (columns + 1) + x]: points in the columns before x of the rows before y.
    void count_below()
    {
        const auto width = static_cast<std::size_t>(columns_) + 1;
        below_.assign(width * (static_cast<std::size_t>(rows_) + 1), 0);
        for (std::size_t y = 0; y < static_cast<std::size_t>(rows_); ++y)
            for (std::size_t x = 0; x + 1 < width; ++x)
            {
                const std::size_t cell = y * (width - 1) + x;
                below_[(y + 1) * width + x + 1] =
                    below_[(y + 1) * width + x] + below_[y * width + x + 1] -
                    below_[y * width + x] + begins_[cell + 1] - begins_[cell];
            }
    }

    const std::vector<Vec3>& points_;
    Box3 box_;
    double cell_;
    double x_begin_ = 0;
    double y_begin_ = 0;
    std::int64_t columns_ = 1;
    std::int64_t rows_ = 1;
    std::vector<std::size_t> begins_;
    std::vector<std::uint32_t> sorted_;
    std::vector<std::size_t> below_;
};

class HeightFinder
{
public:
    HeightFinder(const std::vector<Vec3>& points, double spacing, std::size_t nodes)
        : points_(points),
          // In this form 110 of 117 nodes on a line between cells get GenCase's cell, with the
          // root of nodes / points 104.
          cells_(points, spacing / std::sqrt(static_cast<double>(points.size()) /
                                             static_cast<double>(nodes))),
          limit_(2 * spacing * spacing)
    {
    }

    /// Steps 1 and 2; not a number where they give no height.
    double height(double x, double y) const
    {
        const std::int64_t column = cells_.column_of(x);
        const std::int64_t row = cells_.row_of(y);
        const bool may_be_surrounded = cells_.may_be_surrounded(column, row);
        std::array<Nearest, 4> quadrants; // left below, right below, left above, right above
        const auto farthest = [&]
        {
            return std::max_element(quadrants.begin(), quadrants.end(),
                                    [](const Nearest& a, const Nearest& b)
                                    { return a.square < b.square; })
                ->square;
        };
        // Cells of the ring after `ring` are at least `distance` away.
        double distance = 0;
        for (std::int64_t ring = 0; ring <= cells_.last_ring(); ++ring)
        {
            cells_.visit_ring(column, row, ring,
                              [&](std::uint32_t i) { offer(quadrants, i, x, y); });
            if (distance * distance >= (may_be_surrounded ? farthest() : limit_)) break;
            distance += cells_.cell();
        }
        if (!std::isinf(farthest())) return interpolated(quadrants, x, y);
        Nearest nearest;
        for (const Nearest& n : quadrants)
            if (is_better(n, nearest)) nearest = n;
        return nearest.square < limit_ ? points_[nearest.point].z
                                       : std::numeric_limits<double>::quiet_NaN();
    }

private:
    struct Nearest
    {
        double square = std::numeric_limits<double>::infinity();
        std::uint32_t point = 0;
    };

    void offer(std::array<Nearest, 4>& quadrants, std::uint32_t i, double x, double y) const
    {
        const double dx = points_[i].x - x;
        const double dy = points_[i].y - y;
        const double square = dx * dx + dy * dy;
        Nearest& n = quadrants[(dx > 0 ? 1U : 0U) + (dy > 0 ? 2U : 0U)];
        if (square < n.square) n = {square, i};
    }

    /// Of equal distances the one in the lower row of cells, then in the column more to the left.
    bool is_better(const Nearest& a, const Nearest& b) const
    {
        if (a.square != b.square || std::isinf(a.square)) return a.square < b.square;
        const auto cell = [&](const Vec3& p) {
            return std::pair{cells_.row_of(p.y), cells_.column_of(p.x)};
        };
        return cell(points_[a.point]) < cell(points_[b.point]);
    }

    double interpolated(const std::array<Nearest, 4>& quadrants, double x, double y) const
    {
        const Vec3 below = between(quadrants[0], quadrants[1], x);
        const Vec3 above = between(quadrants[2], quadrants[3], x);
        return below.z + (y - below.y) / (above.y - below.y) * (above.z - below.z);
    }

    /// Where the line between two points passes x.
    Vec3 between(const Nearest& left, const Nearest& right, double x) const
    {
        const Vec3& a = points_[left.point];
        const Vec3& b = points_[right.point];
        return a + (b - a) * ((x - a.x) / (b.x - a.x));
    }

    const std::vector<Vec3>& points_;
    PointCells cells_;
    double limit_;
};

/// The mean of the known neighbours of one node, and how many they are: 2 along an axis, 1 across a
/// corner.
struct KnownMean
{
    double height = 0;
    int score = 0;
};

KnownMean known_mean(const std::vector<double>& z, const std::vector<double>& xs,
                     const std::vector<double>& ys, std::int64_t i, std::int64_t j)
{
    const auto columns = static_cast<std::int64_t>(xs.size());
    const auto rows = static_cast<std::int64_t>(ys.size());
    const auto at = [](const std::vector<double>& v, std::int64_t n)
    { return v[static_cast<std::size_t>(n)]; };
    KnownMean out;
    double sum = 0;
    double weights = 0;
    for (std::int64_t b = std::max<std::int64_t>(j - 1, 0); b <= std::min(j + 1, rows - 1); ++b)
        for (std::int64_t a = std::max<std::int64_t>(i - 1, 0); a <= std::min(i + 1, columns - 1);
             ++a)
        {
            const double known = at(z, b * columns + a);
            if (std::isnan(known)) continue;
            const double x = at(xs, a) - at(xs, i);
            const double y = at(ys, b) - at(ys, j);
            const double weight = std::sqrt(x * x + y * y);
            sum += weight * known;
            weights += weight;
            out.score += a == i || b == j ? 2 : 1;
        }
    out.height = as_float32(sum / weights);
    return out;
}

/// The unknown neighbours of nodes that were found, each once, ascending.
std::vector<std::int64_t> unknown_beside(const std::vector<double>& z, std::int64_t columns,
                                         const std::vector<std::int64_t>& nodes)
{
    const std::int64_t rows = static_cast<std::int64_t>(z.size()) / columns;
    std::vector<std::int64_t> out;
    for (const std::int64_t n : nodes)
        for (std::int64_t k = 0; k < 9; ++k)
        {
            const std::int64_t i = n % columns + k % 3 - 1;
            const std::int64_t j = n / columns + k / 3 - 1;
            if (i < 0 || i >= columns || j < 0 || j >= rows) continue;
            if (std::isnan(z[static_cast<std::size_t>(j * columns + i)]))
                out.push_back(j * columns + i);
        }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Step 3. A node is looked at again only where a neighbour of it was found since.
void fill_from_neighbours(std::vector<double>& z, const std::vector<double>& xs,
                          const std::vector<double>& ys, int threads)
{
    const auto columns = static_cast<std::int64_t>(xs.size());
    const auto all_unknown = [&]
    {
        std::vector<std::int64_t> out;
        for (std::size_t n = 0; n < z.size(); ++n)
            if (std::isnan(z[n])) out.push_back(static_cast<std::int64_t>(n));
        return out;
    };
    std::vector<std::int64_t> looked_at = all_unknown();
    std::vector<double> found;
    for (int enough = 5; enough > 0 && !looked_at.empty();)
    {
        found.assign(looked_at.size(), std::numeric_limits<double>::quiet_NaN());
        parallel_for(
            looked_at.size(), threads,
            [&](std::size_t k)
            {
                const KnownMean mean =
                    known_mean(z, xs, ys, looked_at[k] % columns, looked_at[k] / columns);
                if (mean.score >= enough) found[k] = mean.height;
            },
            4096);
        std::vector<std::int64_t> nodes;
        for (std::size_t k = 0; k < looked_at.size(); ++k)
            if (!std::isnan(found[k]))
            {
                z[static_cast<std::size_t>(looked_at[k])] = found[k];
                nodes.push_back(looked_at[k]);
            }
        looked_at = unknown_beside(z, columns, nodes);
        if (!looked_at.empty()) continue;
        --enough;
        looked_at = all_unknown();
    }
}

} // namespace

std::vector<double> heights_at(const std::vector<Vec3>& points, const std::vector<double>& xs,
                               const std::vector<double>& ys, double spacing, int threads)
{
    const HeightFinder finder(points, spacing, xs.size() * ys.size());
    std::vector<double> z(xs.size() * ys.size());
    parallel_for(
        z.size(), threads,
        [&](std::size_t n)
        { z[n] = as_float32(finder.height(xs[n % xs.size()], ys[n / xs.size()])); },
        256);
    fill_from_neighbours(z, xs, ys, threads);
    return z;
}

} // namespace fppg
