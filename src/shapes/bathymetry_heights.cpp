#include "shapes/bathymetry_heights.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace fppg
{
namespace
{

/// Points sorted into square cells of about one point each.
class PointCells
{
public:
    explicit PointCells(const std::vector<Vec3>& points) : points_(points)
    {
        for (const Vec3& p : points) box_.add(p);
        const double width = box_.max.x - box_.min.x;
        const double height = box_.max.y - box_.min.y;
        const auto n = static_cast<double>(points.size());
        cell_ = std::sqrt(width * height / n);
        if (!(cell_ > 0)) cell_ = std::max(width, height) / n;
        if (!(cell_ > 0)) cell_ = 1;
        columns_ = static_cast<std::int64_t>(width / cell_) + 1;
        rows_ = static_cast<std::int64_t>(height / cell_) + 1;
        begins_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
        for (const Vec3& p : points) ++begins_[cell_of(p) + 1];
        for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
        std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
        sorted_.resize(points.size());
        for (std::uint32_t i = 0; i < points.size(); ++i) sorted_[next[cell_of(points[i])]++] = i;
    }

    /// Calls visit(index) for points in rings of cells around (x, y) until done(distance) says that
    /// points at that distance and beyond are not wanted.
    template <typename Visit, typename Done>
    void search(double x, double y, const Visit& visit, const Done& done) const
    {
        const std::int64_t cx = std::clamp(floor_of(x - box_.min.x), std::int64_t{0}, columns_ - 1);
        const std::int64_t cy = std::clamp(floor_of(y - box_.min.y), std::int64_t{0}, rows_ - 1);
        const std::int64_t rings = std::max({cx, columns_ - 1 - cx, cy, rows_ - 1 - cy});
        for (std::int64_t r = 0; r <= rings; ++r)
        {
            if (r > 1 && done(static_cast<double>(r - 1) * cell_)) return;
            for (std::int64_t j = std::max(cy - r, std::int64_t{0});
                 j <= std::min(cy + r, rows_ - 1); ++j)
            {
                const bool is_whole_row = j == cy - r || j == cy + r;
                for (std::int64_t i = cx - r; i <= cx + r; i += is_whole_row || r == 0 ? 1 : 2 * r)
                    if (i >= 0 && i < columns_) visit_cell(i, j, visit);
            }
        }
    }

    const Box3& box() const { return box_; }

private:
    std::int64_t floor_of(double offset) const
    {
        const double cells = std::floor(offset / cell_);
        return static_cast<std::int64_t>(std::clamp(cells, -1.0, 4e9));
    }
    std::size_t cell_of(const Vec3& p) const
    {
        const std::int64_t i = std::min(floor_of(p.x - box_.min.x), columns_ - 1);
        const std::int64_t j = std::min(floor_of(p.y - box_.min.y), rows_ - 1);
        return static_cast<std::size_t>(j * columns_ + i);
    }
    template <typename Visit>
    void visit_cell(std::int64_t i, std::int64_t j, const Visit& visit) const
    {
        const auto c = static_cast<std::size_t>(j * columns_ + i);
        for (std::size_t k = begins_[c]; k < begins_[c + 1]; ++k) visit(sorted_[k]);
    }

    const std::vector<Vec3>& points_;
    Box3 box_;
    double cell_ = 1;
    std::int64_t columns_ = 1;
    std::int64_t rows_ = 1;
    std::vector<std::size_t> begins_;
    std::vector<std::uint32_t> sorted_;
};

class HeightFinder
{
public:
    HeightFinder(const std::vector<Vec3>& points, double spacing)
        : points_(points), cells_(points), spacing_(spacing), slack_(1e-6 * spacing)
    {
    }

    /// Steps 1 and 2; not a number where they give no height.
    double height(double x, double y) const
    {
        if (const auto found = from_quadrants(x, y)) return *found;
        std::uint32_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        cells_.search(
            x, y,
            [&](std::uint32_t i)
            {
                const double d = std::hypot(points_[i].x - x, points_[i].y - y);
                if (d < least || (d == least && i < nearest))
                {
                    least = d;
                    nearest = i;
                }
            },
            [&](double distance) { return distance > std::min(least, spacing_ + slack_); });
        return least <= spacing_ + slack_ ? points_[nearest].z
                                          : std::numeric_limits<double>::quiet_NaN();
    }

private:
    struct Nearest
    {
        double distance = std::numeric_limits<double>::infinity();
        std::uint32_t point = 0;
    };

    std::optional<double> from_quadrants(double x, double y) const
    {
        const Box3& box = cells_.box();
        if (x < box.min.x - slack_ || x > box.max.x + slack_ || y < box.min.y - slack_ ||
            y > box.max.y + slack_)
            return std::nullopt;
        std::array<Nearest, 4> quadrants; // left below, right below, left above, right above
        cells_.search(
            x, y, [&](std::uint32_t i) { offer(quadrants, i, x, y); },
            [&](double distance)
            {
                return std::all_of(quadrants.begin(), quadrants.end(),
                                   [&](const Nearest& n) { return n.distance < distance; });
            });
        for (const Nearest& n : quadrants)
            if (std::isinf(n.distance)) return std::nullopt;
        for (const Nearest& n : quadrants)
            if (n.distance <= slack_) return points_[n.point].z;
        const Vec3 below = between(quadrants[0], quadrants[1], x);
        const Vec3 above = between(quadrants[2], quadrants[3], x);
        const double height = above.y - below.y;
        if (!(height > 0)) return below.z;
        const double t = std::clamp((y - below.y) / height, 0.0, 1.0);
        return below.z + t * (above.z - below.z);
    }

    void offer(std::array<Nearest, 4>& quadrants, std::uint32_t i, double x, double y) const
    {
        const double dx = points_[i].x - x;
        const double dy = points_[i].y - y;
        const double distance = std::hypot(dx, dy);
        for (std::size_t q = 0; q < 4; ++q)
        {
            const bool fits_x = q % 2 == 0 ? dx <= slack_ : dx >= -slack_;
            const bool fits_y = q / 2 == 0 ? dy <= slack_ : dy >= -slack_;
            Nearest& n = quadrants[q];
            if (fits_x && fits_y &&
                (distance < n.distance || (distance == n.distance && i < n.point)))
                n = {distance, i};
        }
    }

    /// Where the line between two points passes x.
    Vec3 between(const Nearest& left, const Nearest& right, double x) const
    {
        const Vec3& a = points_[left.point];
        const Vec3& b = points_[right.point];
        const double width = b.x - a.x;
        if (!(width > slack_)) return (a + b) * 0.5;
        return a + (b - a) * ((x - a.x) / width);
    }

    const std::vector<Vec3>& points_;
    PointCells cells_;
    double spacing_;
    double slack_;
};

/// Step 3.
void fill_from_neighbours(std::vector<double>& z, const std::vector<double>& xs,
                          const std::vector<double>& ys, int threads)
{
    const auto columns = static_cast<std::int64_t>(xs.size());
    const auto rows = static_cast<std::int64_t>(ys.size());
    std::vector<std::int64_t> unknown;
    for (std::int64_t n = 0; n < columns * rows; ++n)
        if (std::isnan(z[static_cast<std::size_t>(n)])) unknown.push_back(n);
    std::vector<double> found;
    while (!unknown.empty())
    {
        found.assign(unknown.size(), std::numeric_limits<double>::quiet_NaN());
        parallel_for(
            unknown.size(), threads,
            [&](std::size_t k)
            {
                const std::int64_t i = unknown[k] % columns;
                const std::int64_t j = unknown[k] / columns;
                double sum = 0;
                double weights = 0;
                for (std::int64_t b = std::max<std::int64_t>(j - 1, 0);
                     b <= std::min(j + 1, rows - 1); ++b)
                    for (std::int64_t a = std::max<std::int64_t>(i - 1, 0);
                         a <= std::min(i + 1, columns - 1); ++a)
                    {
                        const double known = z[static_cast<std::size_t>(b * columns + a)];
                        if (std::isnan(known)) continue;
                        const double weight = std::hypot(
                            xs[static_cast<std::size_t>(a)] - xs[static_cast<std::size_t>(i)],
                            ys[static_cast<std::size_t>(b)] - ys[static_cast<std::size_t>(j)]);
                        sum += weight * known;
                        weights += weight;
                    }
                if (weights > 0) found[k] = sum / weights;
            },
            4096);
        std::size_t left = 0;
        for (std::size_t k = 0; k < unknown.size(); ++k)
            if (std::isnan(found[k]))
                unknown[left++] = unknown[k];
            else
                z[static_cast<std::size_t>(unknown[k])] = found[k];
        if (left == unknown.size()) break; // no node is known at all
        unknown.resize(left);
    }
}

} // namespace

std::vector<double> heights_at(const std::vector<Vec3>& points, const std::vector<double>& xs,
                               const std::vector<double>& ys, double spacing, int threads)
{
    const HeightFinder finder(points, spacing);
    std::vector<double> z(xs.size() * ys.size());
    parallel_for(
        z.size(), threads,
        [&](std::size_t n) { z[n] = finder.height(xs[n % xs.size()], ys[n / xs.size()]); }, 256);
    if (std::all_of(z.begin(), z.end(), [](double v) { return std::isnan(v); }))
    {
        // Every node is far from every point: the nearest of all gives the heights.
        const HeightFinder far(points, std::numeric_limits<double>::max() / 4);
        for (std::size_t n = 0; n < z.size(); ++n)
            z[n] = far.height(xs[n % xs.size()], ys[n / xs.size()]);
    }
    fill_from_neighbours(z, xs, ys, threads);
    return z;
}

} // namespace fppg
