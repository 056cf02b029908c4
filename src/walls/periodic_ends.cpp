#include "walls/periodic_ends.h"

#include "fppg/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fppg
{
namespace
{

constexpr double at_end_dp = 0.75; ///< of a period
/// More than walls are laid beyond a period and layers reach behind their ends together.
constexpr double goes_on_dp = 8;
/// Of the cosine between a normal and the axis.
constexpr double off_axis = 1e-6;

/// Nodes [begin, end) along each axis that anything is drawn on.
struct DrawnNodes
{
    std::array<std::uint32_t, 3> begin{};
    std::array<std::uint32_t, 3> end{};
};

DrawnNodes drawn_nodes(const RunField& field)
{
    DrawnNodes out;
    out.begin.fill(std::numeric_limits<std::uint32_t>::max());
    const auto add = [&](std::size_t axis, std::uint32_t begin, std::uint32_t end)
    {
        out.begin[axis] = std::min(out.begin[axis], begin);
        out.end[axis] = std::max(out.end[axis], end);
    };
    for (std::uint32_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& run : field.slabs[x])
        {
            if (run.is_covered) continue;
            add(0, x, x + 1);
            add(1, run.y, run.y + 1);
            add(2, run.z_begin, run.z_end);
        }
    return out;
}

/// A shape along an axis between the ends of a period.
class Ends
{
public:
    Ends(const LatticeGrid& grid, int axis, const TriangleSoup& soup)
        : axis_(axis), room_(at_end_dp * grid.dp)
    {
        first_ = grid.origin[axis];
        last_ = first_ + (grid.n[static_cast<std::size_t>(axis)] - 1) * grid.step(axis);
        for (const Vec3& v : soup.vertices)
        {
            low_ = std::min(low_, v[axis]);
            high_ = std::max(high_, v[axis]);
        }
    }

    bool are_met() const
    {
        return std::abs(low_ - first_) < room_ && std::abs(high_ - last_) < room_ &&
               high_ - low_ > 2 * room_;
    }

    /// -1 and 1 at the ends of the shape.
    int end_of(const Vec3& v) const
    {
        return v[axis_] < low_ + rounding() ? -1 : v[axis_] > high_ - rounding() ? 1 : 0;
    }

    /// Whether the facets that have corners at one end are plane covers, or along the axis.
    bool are_plane(const TriangleSoup& soup) const
    {
        for (std::size_t f = 0; f < soup.size(); ++f)
        {
            const Vec3* c = &soup.vertices[3 * f];
            const std::array<int, 3> ends{end_of(c[0]), end_of(c[1]), end_of(c[2])};
            if (ends[0] == ends[1] && ends[1] == ends[2]) continue;
            const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
            if (std::abs(normal[axis_]) > off_axis * norm(normal)) return false;
        }
        return true;
    }

private:
    double rounding() const { return 1e-6 * (high_ - low_); }

    int axis_;
    double room_;
    double first_ = 0, last_ = 0;
    double low_ = std::numeric_limits<double>::infinity();
    double high_ = -std::numeric_limits<double>::infinity();
};

} // namespace

std::optional<LatticeGrid> lattice_of_period(const Scene& scene, int threads)
{
    const CaseDef& def = *scene.def;
    if (def.fit.is_empty() || def.vres.is_active() || !def.point_files.empty() ||
        def.grid.is_periodic == std::array<bool, 3>{})
        return std::nullopt;
    LatticeGrid grid = def.grid;
    try
    {
        LatticeReport report;
        const DrawnNodes drawn = drawn_nodes(draw_on_lattice(scene, threads, {}, report));
        for (std::size_t a = 0; a < 3; ++a)
        {
            if (!grid.is_periodic[a] || drawn.begin[a] >= drawn.end[a]) continue;
            const int axis = static_cast<int>(a);
            grid.origin[axis] += drawn.begin[a] * grid.step(axis);
            grid.n[a] = drawn.end[a] - drawn.begin[a];
        }
    }
    catch (const Error&)
    {
        return std::nullopt; // drawing the walls says what is wrong
    }
    if (grid.n == def.grid.n) return std::nullopt;
    return grid;
}

std::string continue_over_periods(const LatticeGrid& grid, TriangleSoup& soup)
{
    std::string axes;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!grid.is_periodic[static_cast<std::size_t>(axis)] || soup.size() == 0) continue;
        const Ends ends(grid, axis, soup);
        if (!ends.are_met() || !ends.are_plane(soup)) continue;
        for (Vec3& v : soup.vertices) v[axis] += ends.end_of(v) * goes_on_dp * grid.dp;
        axes += "xyz"[axis];
    }
    return axes;
}

} // namespace fppg
