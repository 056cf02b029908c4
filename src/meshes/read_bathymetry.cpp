#include "fppg/error.h"

#include "core/float32.h"
#include "meshes/bathymetry_heights.h"
#include "meshes/readers.h"
#include "platform/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{
namespace
{

/// More nodes than this are no bathymetry but a wrong number.
constexpr double most_nodes = 1e8;
/// Heights, their facets and copies of both: 2.07 GB were measured for a grid of 5.2 million nodes.
constexpr double bytes_per_node = 400;

/// Heights over lines of constant x and y: z[j * xs.size() + i]. GenCase keeps heights as float32,
/// points and lines as double: 0.35 falls below the tie of a lattice of dp 0.1 (golden
/// file_bathy_periodic), and 0.167 moved by -0.067 below that of 0.1.
struct HeightGrid
{
    std::vector<double> xs;
    std::vector<double> ys;
    std::vector<double> z;

    HeightGrid transposed() const
    {
        HeightGrid out{ys, xs, std::vector<double>(z.size())};
        for (std::size_t j = 0; j < ys.size(); ++j)
            for (std::size_t i = 0; i < xs.size(); ++i)
                out.z[i * ys.size() + j] = z[j * xs.size() + i];
        return out;
    }
    /// Mirrored in x.
    HeightGrid turned() const
    {
        HeightGrid out = *this;
        const std::size_t n = xs.size();
        for (std::size_t i = 0; i < n; ++i) out.xs[i] = -xs[n - 1 - i];
        for (std::size_t j = 0; j < ys.size(); ++j)
            for (std::size_t i = 0; i < n; ++i) out.z[j * n + i] = z[j * n + n - 1 - i];
        return out;
    }
};

/// Lines from `begin` on, `spacing` apart, the last one less than 0.1 spacing before the end or
/// beyond it.
std::vector<double> lines_over(double begin, double size, double spacing)
{
    const auto n =
        static_cast<std::size_t>(std::max(1.0, std::floor((size + 0.9 * spacing) / spacing)));
    std::vector<double> lines;
    for (std::size_t i = 0; i <= n; ++i) lines.push_back(begin + static_cast<double>(i) * spacing);
    return lines;
}

/// The same, with the last one at the end or beyond it.
std::vector<double> lines_up_to(double begin, double size, double spacing)
{
    const auto n = static_cast<std::size_t>(std::max(1.0, std::ceil(size / spacing - 1e-5)));
    std::vector<double> lines;
    for (std::size_t i = 0; i <= n; ++i) lines.push_back(begin + static_cast<double>(i) * spacing);
    return lines;
}

class GridMaker
{
public:
    GridMaker(std::vector<Vec3> points, const std::string& path, const BathymetryGrid& settings,
              int threads)
        : points_(std::move(points)), path_(path), settings_(settings), threads_(threads)
    {
    }

    IndexedMesh run()
    {
        HeightGrid grid = settings_.is_grid_file ? given_grid() : grid_of_points();
        const auto& e = settings_.expands;
        expand_begin(grid, e[0]);
        grid = grid.turned();
        expand_begin(grid, e[1]);
        grid = grid.turned().transposed();
        expand_begin(grid, e[2]);
        grid = grid.turned();
        expand_begin(grid, e[3]);
        grid = grid.turned().transposed();
        if (settings_.periods[0]) make_periodic(grid, *settings_.periods[0], "x");
        if (settings_.periods[1])
        {
            grid = grid.transposed();
            make_periodic(grid, *settings_.periods[1], "y");
            grid = grid.transposed();
        }
        return mesh_of(grid);
    }

private:
    [[noreturn]] void fail(const std::string& text) const
    {
        throw GeometryError(fmt::format("{}: {}", path_, text));
    }

    /// Points row by row, x rising fastest, every row at the same x.
    HeightGrid given_grid() const
    {
        HeightGrid grid;
        std::size_t columns = 1;
        while (columns < points_.size() && points_[columns].y == points_[0].y) ++columns;
        if (columns < 2 || points_.size() % columns != 0 || points_.size() / columns < 2)
            fail(
                fmt::format("its {} points are no grid: the first row has {}, expected rows of "
                            "equal length, two points or more each, and two rows or more",
                            points_.size(), columns));
        for (std::size_t i = 0; i < points_.size(); ++i)
        {
            const Vec3& p = points_[i];
            const std::size_t column = i % columns;
            if (i < columns) grid.xs.push_back(p.x);
            if (column == 0) grid.ys.push_back(p.y);
            if (p.x != grid.xs[column] || p.y != grid.ys.back())
                fail(
                    fmt::format("point {} is ({:g}, {:g}), expected ({:g}, {:g}): the points are "
                                "no grid",
                                i, p.x, p.y, grid.xs[column], grid.ys.back()));
            grid.z.push_back(as_float32(p.z));
        }
        for (const auto* lines : {&grid.xs, &grid.ys})
            for (std::size_t i = 1; i < lines->size(); ++i)
                if (!((*lines)[i] > (*lines)[i - 1]))
                    fail(fmt::format(
                        "its points are no grid: {:g} follows {:g}, expected rising values",
                        (*lines)[i], (*lines)[i - 1]));
        return grid;
    }

    HeightGrid grid_of_points()
    {
        std::vector<Vec3> used;
        for (const Vec3& p : points_)
        {
            const Vec3 q = settings_.transform(p);
            if (settings_.selection && !is_in(*settings_.selection, q)) continue;
            used.push_back(q);
        }
        if (used.empty())
            fail(fmt::format("none of its {} points lies in the selection", points_.size()));
        Box3 box;
        for (const Vec3& p : used) box.add(p);
        const bool has_domain = settings_.domain.has_value();
        const GroundRectangle area =
            has_domain ? *settings_.domain
                       : GroundRectangle{box.min.x, box.min.y, box.max.x - box.min.x,
                                         box.max.y - box.min.y};
        const double spacing = settings_.spacing;
        const double nodes = (area.x_size / spacing + 2) * (area.y_size / spacing + 2);
        if (!(nodes < most_nodes))
            fail(fmt::format("a grid of {:g} x {:g} m with dp={:g} has more than {:g} nodes",
                             area.x_size, area.y_size, spacing, most_nodes));
        const auto memory = static_cast<double>(available_memory());
        if (!(nodes * bytes_per_node < memory))
            fail(
                fmt::format("a grid of {:g} x {:g} m with dp={:g} has {:.2g} nodes and needs about "
                            "{:.3g} GB of memory, {:.3g} GB are free",
                            area.x_size, area.y_size, spacing, nodes, nodes * bytes_per_node * 1e-9,
                            memory * 1e-9));
        HeightGrid grid;
        const auto lines = has_domain ? lines_over : lines_up_to;
        grid.xs = lines(area.x_min, area.x_size, spacing);
        grid.ys = lines(area.y_min, area.y_size, spacing);
        grid.z = heights_at(used, grid.xs, grid.ys, spacing, threads_);
        if (std::isnan(grid.z[0]))
            fail(
                fmt::format("no node of its grid, x {:g} to {:g}, y {:g} to {:g}, is nearer to a "
                            "point than {:g}, expected points in the grid",
                            grid.xs.front(), grid.xs.back(), grid.ys.front(), grid.ys.back(),
                            std::sqrt(2) * spacing));
        if (!has_domain) return grid;
        end_at(grid, area.x_min + area.x_size);
        grid = grid.transposed();
        end_at(grid, area.y_min + area.y_size);
        return grid.transposed();
    }

    bool is_in(const GroundRectangle& r, const Vec3& p) const
    {
        const double slack = 1e-9 * settings_.spacing;
        return p.x >= r.x_min - slack && p.x <= r.x_min + r.x_size + slack &&
               p.y >= r.y_min - slack && p.y <= r.y_min + r.y_size + slack;
    }

    /// Cuts the last column off at x, the height there interpolated, or adds one at x with the same
    /// heights; within 0.01 spacing it is moved.
    void end_at(HeightGrid& grid, double x) const
    {
        const double beyond = x - grid.xs.back();
        if (std::fabs(beyond) <= 0.01 * settings_.spacing)
        {
            grid.xs.back() = x;
            return;
        }
        grid = grid.turned();
        if (beyond < 0)
            cut_begin(grid, -x);
        else
            add_begin(grid, beyond, std::nullopt);
        grid = grid.turned();
    }

    /// Cuts off all columns before x; the column there is interpolated.
    void cut_begin(HeightGrid& grid, double x) const
    {
        const std::size_t n = grid.xs.size();
        const double slack = 1e-6 * (grid.xs.back() - grid.xs.front());
        std::size_t kept = 0;
        while (kept < n && grid.xs[kept] < x - slack) ++kept;
        if (kept == n) fail("<expands>: a negative size cuts the whole grid off");
        const bool is_new = kept > 0 && grid.xs[kept] > x + slack;
        if (kept == 0 && !is_new) return;
        HeightGrid out;
        out.ys = grid.ys;
        if (is_new) out.xs.push_back(x);
        out.xs.insert(out.xs.end(), grid.xs.begin() + static_cast<std::ptrdiff_t>(kept),
                      grid.xs.end());
        for (std::size_t j = 0; j < grid.ys.size(); ++j)
        {
            const double* const row = &grid.z[j * n];
            if (is_new) out.z.push_back(between(grid, row, kept, x));
            out.z.insert(out.z.end(), row + kept, row + n);
        }
        grid = std::move(out);
    }

    static double between(const HeightGrid& grid, const double* row, std::size_t after, double x)
    {
        const double t = (x - grid.xs[after - 1]) / (grid.xs[after] - grid.xs[after - 1]);
        return as_float32(row[after - 1] + t * (row[after] - row[after - 1]));
    }

    /// Adds a column before the first; `height` empty: that of the first column.
    static void add_begin(HeightGrid& grid, double size, const std::optional<double>& height)
    {
        const std::size_t n = grid.xs.size();
        HeightGrid out;
        out.ys = grid.ys;
        out.xs.push_back(grid.xs[0] - size);
        out.xs.insert(out.xs.end(), grid.xs.begin(), grid.xs.end());
        for (std::size_t j = 0; j < grid.ys.size(); ++j)
        {
            const double* const row = &grid.z[j * n];
            out.z.push_back(height ? as_float32(*height) : row[0]);
            out.z.insert(out.z.end(), row, row + n);
        }
        grid = std::move(out);
    }

    void expand_begin(HeightGrid& grid, const BathymetryRamp& ramp) const
    {
        if (ramp.size < 0)
        {
            cut_begin(grid, grid.xs[0] - ramp.size);
            if (ramp.z)
                for (std::size_t j = 0; j < grid.ys.size(); ++j)
                    grid.z[j * grid.xs.size()] = as_float32(*ramp.z);
        }
        if (ramp.size > 0) add_begin(grid, ramp.size, ramp.z);
        if (ramp.size2 > 0) add_begin(grid, ramp.size2, ramp.z2);
    }

    /// Between each end and the ramp's width from it no column is left; the end takes the mean of
    /// the heights at the two widths.
    void make_periodic(HeightGrid& grid, const BathymetryPeriod& period, const char* axis) const
    {
        const double first = grid.xs.front();
        const double last = grid.xs.back();
        const double low = first + period.ramp_width;
        const double high = last - period.ramp_width;
        if (!(low < high))
            fail(fmt::format(
                "<periodic{}>: rampwidth={:g} is invalid, expected less than {:g}, half "
                "the width of the grid",
                axis, period.ramp_width, (last - first) / 2));
        cut_begin(grid, low);
        grid = grid.turned();
        cut_begin(grid, -high);
        grid = grid.turned();
        const std::size_t n = grid.xs.size();
        std::vector<double> means;
        for (std::size_t j = 0; j < grid.ys.size(); ++j)
            means.push_back(as_float32((grid.z[j * n] + grid.z[j * n + n - 1]) / 2));
        if (period.ramp_width > 0)
        {
            add_begin(grid, grid.xs.front() - first, 0.0);
            grid = grid.turned();
            add_begin(grid, grid.xs.front() + last, 0.0);
            grid = grid.turned();
        }
        const std::size_t m = grid.xs.size();
        for (std::size_t j = 0; j < grid.ys.size(); ++j)
            grid.z[j * m] = grid.z[j * m + m - 1] = means[j];
        if (period.flat_width <= 0) return;
        add_begin(grid, period.flat_width, std::nullopt);
        grid = grid.turned();
        add_begin(grid, period.flat_width, std::nullopt);
        grid = grid.turned();
    }

    IndexedMesh mesh_of(const HeightGrid& grid) const
    {
        IndexedMesh mesh;
        const std::uint64_t n = grid.xs.size();
        for (std::size_t j = 0; j < grid.ys.size(); ++j)
            for (std::size_t i = 0; i < n; ++i)
                mesh.points.push_back(
                    {grid.xs[i] + settings_.final_move.x, grid.ys[j] + settings_.final_move.y,
                     as_float32(grid.z[j * n + i] + as_float32(settings_.final_move.z))});
        for (std::uint64_t j = 0; j + 1 < grid.ys.size(); ++j)
            for (std::uint64_t i = 0; i + 1 < n; ++i)
            {
                const std::uint64_t p = j * n + i;
                mesh.polygons.add(std::array{p, p + 1, p + 1 + n, p + n});
            }
        return mesh;
    }

    std::vector<Vec3> points_;
    const std::string& path_;
    const BathymetryGrid& settings_;
    int threads_;
};

} // namespace

IndexedMesh read_bathymetry(std::string_view bytes, const std::string& path,
                            const BathymetryGrid& grid, int threads)
{
    return GridMaker(read_points(bytes, path), path, grid, threads).run();
}

} // namespace fppg
