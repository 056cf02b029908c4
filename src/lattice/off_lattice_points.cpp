#include "lattice/off_lattice_points.h"

#include "fppg/error.h"

#include "core/sine.h"
#include "nodes/snap.h"
#include "shapes/plane_shapes.h"
#include "shapes/planes.h"
#include "shapes/polygon_cut.h"
#include "shapes/polyhedra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

/// Steps of angles are taken in degrees and then turned into radians: their rounding decides
/// whether there is a particle at a pole.
constexpr double radian = std::numbers::pi / 180;

/// A shape may have so many places, or so many for each node of the domain: of more most lie
/// outside of it.
constexpr double most_places = 1e7;
constexpr double most_places_a_node = 8;

/// throws  GeometryError where there are more of them
void expect_places(double count, const LatticeGrid& grid)
{
    const double nodes = 1.0 * grid.n[0] * grid.n[1] * grid.n[2];
    if (count <= std::max(most_places, most_places_a_node * nodes)) return;
    throw GeometryError(
        fmt::format("it has about {:.2g} places for particles, the domain has "
                    "{:.2g} nodes: most of it lies outside of the domain",
                    count, nodes));
}

/// throws  GeometryError where no shape has so many
int checked_count(double intervals)
{
    constexpr double most = 1e9;
    if (intervals <= most) return static_cast<int>(intervals);
    throw GeometryError(
        fmt::format("a side of it is {:.2g} dp long, expected {:g} dp at most", intervals, most));
}

/// Equal intervals of at most dp; a length that is a multiple but for rounding keeps its number.
int interval_count(double length, double dp)
{
    return checked_count(std::ceil(length / dp - 1e-6));
}

/// The same without room for rounding: one of 2 dp and the last bit has three intervals. The
/// multiple of dp decides, not the quotient (0.9 and the last bit at dp 0.1 have a quotient of 9.0
/// and ten intervals; 180 of 180 lengths from 0.3 to 1.4).
int exact_interval_count(double length, double dp)
{
    const int whole = checked_count(length / dp);
    return whole * dp < length ? whole + 1 : whole;
}

/// One of n intervals of a vector, in GenCase's arithmetic.
Vec3 interval(const Vec3& whole, int n)
{
    const double length = norm(whole);
    return n == 0 || length == 0 ? Vec3{} : whole * (length / n / length);
}

void check_spacing(const std::vector<Vec3>& steps, double dp)
{
    double least = HUGE_VAL;
    for (const Vec3& step : steps) least = std::min(least, norm(step));
    if (least < nearest_dp * dp * (1 - 1e-9))
        throw GeometryError(fmt::format(
            "its particles would be {:g} dp apart, setfrdrawmode needs at least 0.75 dp (sides "
            "between 1 and 1.5 dp, 2 and 2.25 dp or below 0.75 dp are not possible)",
            least / dp));
}

/// Points of a ring that starts at `first` (a unit vector) and turns towards `second`.
void add_ring(const Vec3& center, const Vec3& first, const Vec3& second, double radius, double dp,
              std::vector<Vec3>& out)
{
    const int n = checked_count(std::ceil(2 * std::numbers::pi * radius / dp));
    for (int i = 0; i < n; ++i)
    {
        const SineAndCosine turn = portable_sine_and_cosine(360.0 / n * radian * i);
        out.push_back(center + first * (radius * turn.cosine) + second * (radius * turn.sine));
    }
}

/// The ring at the top pole has a radius of rounding size: one point where that is above 0, none
/// where it is below (of 30, 50, 60, 70 and 82 rings). That at the bottom pole has none.
void add_shell(const Vec3& center, double radius, double dp, std::vector<Vec3>& out)
{
    const int m = 2 * checked_count(std::ceil(std::numbers::pi * radius / (2 * dp)));
    for (int k = 1; k <= m; ++k)
    {
        const SineAndCosine polar = portable_sine_and_cosine(180.0 / m * radian * k);
        const Vec3 middle{center.x, center.y, center.z - radius * polar.cosine};
        add_ring(middle, {1, 0, 0}, {0, 1, 0}, radius * polar.sine, dp, out);
    }
}

void add_sphere(const Vec3& center, double radius, DrawMode mode, const LatticeGrid& grid,
                std::vector<Vec3>& out)
{
    const double dp = grid.dp;
    if (radius <= nearest_dp * dp)
    {
        out.push_back(center);
        return;
    }
    const int n = interval_count(radius, dp);
    const int first = mode == DrawMode::Face ? n : 1;
    const int last = mode == DrawMode::Solid ? n - 1 : n;
    expect_places(4 * std::numbers::pi * n * n * (mode == DrawMode::Face ? 1 : n / 3.0), grid);
    for (int k = first; k <= last; ++k) add_shell(center, radius / n * k, dp, out);
}

/// Where the rings of a cylinder start, square to its axis (13 axes along coordinates and
/// diagonals, and 42 oblique ones in GenCase).
Vec3 ring_start(const Vec3& axis)
{
    if (axis.x == 0 && axis.y == 0) return {axis.z > 0 ? 1.0 : -1.0, 0, 0};
    const Vec3 start = axis.x == 0 ? Vec3{0, -axis.z, axis.y} : Vec3{-axis.z, 0, axis.x};
    return start * (1 / norm(start));
}

struct CylinderParts
{
    std::array<bool, 3> faces{};
    bool has_inside = false;
    bool has_axis = false; ///< the points on the axis of inner discs too
};

void add_cylinder(const Vec3& p0, const Vec3& p1, double radius, const CylinderParts& parts,
                  const LatticeGrid& grid, std::vector<Vec3>& out)
{
    const double dp = grid.dp;
    const Vec3 whole = p1 - p0;
    const Vec3 axis = whole * (1 / norm(whole));
    const int discs = std::max(1, exact_interval_count(norm(whole), dp));
    const int rings = std::max(1, interval_count(radius, dp));
    const double around = 2 * std::numbers::pi * rings;
    expect_places(around * (parts.has_inside ? 0.5 * rings * discs : 1.0 * rings + discs), grid);
    const Vec3 step = interval(whole, discs);
    const Vec3 first = ring_start(axis);
    const Vec3 second = cross(axis, first);
    // Rings too small for two particles are one on the axis (36 cylinders of a radius from 0.05 to
    // 0.8 dp in GenCase v5.4).
    const bool is_line = radius <= nearest_dp * dp;
    for (int d = 0; d <= discs; ++d)
    {
        const bool is_end = d == 0 || d == discs;
        const bool has_cover = (d == 0 && parts.faces[0]) || (d == discs && parts.faces[1]);
        const Vec3 center = p0 + step * static_cast<double>(d);
        if (is_line)
        {
            if (has_cover || parts.faces[2]) out.push_back(center);
            continue;
        }
        if (has_cover || parts.has_axis) out.push_back(center);
        for (int k = 1; k <= rings; ++k)
            if (has_cover || (k == rings ? parts.faces[2] : parts.has_inside && !is_end))
                add_ring(center, first, second, radius / rings * k, dp, out);
    }
}

/// The numbers of steps, of those up to `last`, that may lie behind all planes, with one to spare
/// at either end.
std::pair<double, double> part_inside(const std::array<Plane, 3>& sides, const Vec3& start,
                                      const Vec3& step, double last)
{
    double begin = 0;
    double end = last;
    for (const Plane& side : sides)
    {
        const double rise = dot(side.normal, step);
        if (std::fabs(rise) < 1e-9 * norm(step)) continue;
        const double zero = -side.value(start) / rise;
        if (rise > 0)
            begin = std::max(begin, std::floor(zero) - 1);
        else
            end = std::min(end, std::ceil(zero) + 1);
    }
    return {begin, end};
}

} // namespace

std::vector<Vec3> off_lattice_line(const Vec3& from, const Vec3& to, const LatticeGrid& grid)
{
    std::vector<Vec3> out;
    const int n = checked_count(std::floor(norm(to - from) / grid.dp + 0.5));
    expect_places(n, grid);
    const Vec3 step = interval(to - from, n);
    for (int i = 0; n > 0 && i <= n; ++i) out.push_back(from + step * static_cast<double>(i));
    return out;
}

std::vector<Vec3> off_lattice_parallelogram(const Vec3& corner, const Vec3& first, const Vec3& last,
                                            const LatticeGrid& grid)
{
    const int n = exact_interval_count(norm(first - corner), grid.dp);
    const int m = exact_interval_count(norm(last - corner), grid.dp);
    // Without a length across there is nothing, whatever the other side (GenCase v5.4.354: ten
    // quads of two or one place, sides of 1e-12 and 1e-9 m; one of 1e-6 dp is refused).
    if (n == 0 || m == 0) return {};
    const Vec3 u = interval(first - corner, n);
    const Vec3 v = interval(last - corner, m);
    check_spacing({u, v, u + v, u - v}, grid.dp);
    expect_places(1.0 * n * m, grid);
    std::vector<Vec3> out;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= m; ++j)
            out.push_back(corner + u * static_cast<double>(i) + v * static_cast<double>(j));
    return out;
}

std::vector<Vec3> off_lattice_triangle(const std::array<Vec3, 3>& corners, const LatticeGrid& grid)
{
    const auto& [a, b, c] = corners;
    Vec3 normal = cross(b - a, c - a);
    if (norm(normal) == 0) return {};
    normal = normal / norm(normal);
    const double level = dot(normal, grid.origin) - dot(normal, a);
    const Vec3 foot = grid.origin - normal * level;

    // The sign of both axes decides how positions are rounded.
    Vec3 u{1, 0, 0};
    const double flat = std::sqrt(normal.z * normal.z + normal.x * normal.x);
    if (flat > 0) u = {normal.z / flat, 0, -normal.x / flat};
    if (u.x < 0 || (u.x == 0 && u.z < 0)) u = u * -1.0;
    const bool is_turned = normal.x + normal.y + normal.z < 0;
    Vec3 v = cross(is_turned ? normal * -1.0 : normal, u);
    v = v / norm(v);

    // Planes through the sides, square to the triangle.
    std::array<Plane, 3> sides;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const Vec3 inward = cross(normal, corners[(k + 1) % 3] - corners[k]);
        sides[k].normal = inward / norm(inward);
        sides[k].offset = -dot(sides[k].normal, corners[k]);
    }
    const auto limits = [&](const Vec3& axis)
    {
        std::array<double, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) at[k] = dot(corners[k] - grid.origin, axis) / grid.dp;
        const auto [low, high] = std::minmax_element(at.begin(), at.end());
        return std::pair(std::floor(*low), std::ceil(*high));
    };
    const auto [u_begin, u_end] = limits(u);
    const auto [v_begin, v_end] = limits(v);
    expect_places(0.5 * norm(cross(b - a, c - a)) / (grid.dp * grid.dp) + u_end - u_begin, grid);
    const Vec3 start = foot + u * (grid.dp * u_begin) + v * (grid.dp * v_begin);
    std::vector<Vec3> out;
    for (double i = 0; i <= u_end - u_begin; ++i)
    {
        const Vec3 column = start + u * (grid.dp * i);
        const auto [begin, end] = part_inside(sides, column, v * grid.dp, v_end - v_begin);
        for (double j = begin; j <= end; ++j)
        {
            const Vec3 p = column + v * (grid.dp * j);
            if (std::all_of(sides.begin(), sides.end(),
                            [&](const Plane& side) { return side.value(p) >= 0; }))
                out.push_back(p);
        }
    }
    return out;
}

std::vector<Vec3> off_lattice_trapezoid(const std::array<Vec3, 4>& corners, const LatticeGrid& grid)
{
    const double dp = grid.dp;
    const auto& [a, b, c, d] = corners;
    if (norm(c - b) > norm(d - a) + 0.05 * dp)
        throw GeometryError(
            fmt::format("a trapezoid of it has a side of {:g} from its second corner and one of "
                        "{:g} from its first, setfrdrawmode needs the first to be the longer",
                        norm(c - b), norm(d - a)));
    const int rows = std::max(1, exact_interval_count(norm(d - a), dp));
    const Vec3 left = interval(d - a, rows);
    const Vec3 right = (c - b) / rows;
    expect_places(0.5 * rows * (norm(b - a) + norm(d - c)) / dp, grid);
    std::vector<Vec3> out;
    for (int i = 0; i <= rows; ++i)
    {
        const Vec3 begin = a + left * static_cast<double>(i);
        const Vec3 end = b + right * static_cast<double>(i);
        const int n = exact_interval_count(norm(end - begin), dp);
        const Vec3 step = interval(end - begin, n);
        for (int j = 0; j <= n; ++j) out.push_back(begin + step * static_cast<double>(j));
    }
    return out;
}

std::vector<Vec3> off_lattice_polygon(const std::vector<Vec3>& corners, const LatticeGrid& grid)
{
    if (corners.size() == 1) return corners;
    if (corners.size() == 2) return off_lattice_line(corners[0], corners[1], grid);
    if (corners.size() == 3)
        return off_lattice_triangle({corners[0], corners[1], corners[2]}, grid);
    const std::array<Vec3, 4> quad{corners[0], corners[1], corners[2], corners[3]};
    if (quad_kind(quad, grid.dp) == QuadKind::Trapezoid) return off_lattice_trapezoid(quad, grid);
    return off_lattice_parallelogram(corners[0], corners[1], corners[3], grid);
}

std::vector<Vec3> off_lattice_block(const Vec3& corner, const std::array<Vec3, 3>& neighbours,
                                    const LatticeGrid& grid)
{
    std::array<int, 3> n{};
    std::array<Vec3, 3> step;
    for (std::size_t k = 0; k < 3; ++k)
    {
        n[k] = interval_count(norm(neighbours[k] - corner), grid.dp);
        step[k] = interval(neighbours[k] - corner, n[k]);
    }
    check_spacing({step[0], step[1], step[2]}, grid.dp);
    expect_places(1.0 * n[0] * n[1] * n[2], grid);
    std::vector<Vec3> out;
    for (int i = 0; i <= n[0]; ++i)
        for (int j = 0; j <= n[1]; ++j)
            for (int k = 0; k <= n[2]; ++k)
                out.push_back(corner + step[0] * static_cast<double>(i) +
                              step[1] * static_cast<double>(j) + step[2] * static_cast<double>(k));
    return out;
}

std::vector<Vec3> off_lattice_sphere(const SphereOp& op, const Transform& matrix, DrawMode mode,
                                     const LatticeGrid& grid)
{
    Transform turn;
    turn.linear = matrix.linear;
    const bool is_turned = !turn.is_identity();
    const Vec3 center = is_turned ? Vec3{} : op.center;
    std::vector<Vec3> out;
    for (const double layer : op.layers_dp)
        add_sphere(center, op.radius + layer * grid.dp, DrawMode::Face, grid, out);
    if (op.layers_dp.empty()) add_sphere(center, op.radius, mode, grid, out);
    if (is_turned)
        for (Vec3& p : out) p = op.center + turn(p);
    return out;
}

bool fills_off_lattice_cylinder(const CylinderOp& op, DrawMode mode)
{
    return mode != DrawMode::Face && op.layers.empty() && !op.is_masked;
}

std::vector<Vec3> off_lattice_disc(const SphereOp& op, DrawMode mode, const LatticeGrid& grid)
{
    const double dp = grid.dp;
    const double y = grid.origin.y;
    std::vector<Vec3> out;
    const auto add = [&](double whole, bool has_disc)
    {
        const double away = y - op.center.y;
        const double radius = std::sqrt(std::max(0.0, whole * whole - away * away));
        const Vec3 center{op.center.x, y, op.center.z};
        if (radius <= nearest_dp * dp)
        {
            out.push_back(center);
            return;
        }
        if (!has_disc) return;
        const int rings = std::max(1, interval_count(radius, dp));
        expect_places(std::numbers::pi * rings * rings, grid);
        if (radius / rings > nearest_dp * dp) out.push_back(center);
        for (int k = 1; k <= rings; ++k)
            add_ring(center, {0, 0, 1}, {1, 0, 0}, radius / rings * k, dp, out);
    };
    for (const double layer : op.layers_dp) add(op.radius + layer * dp, true);
    if (op.layers_dp.empty()) add(op.radius, mode != DrawMode::Solid);
    return out;
}

std::vector<Vec3> off_lattice_cylinder(const CylinderOp& op, DrawMode mode, const LatticeGrid& grid)
{
    std::vector<Vec3> out;
    for (const CylinderLayer& layer : op.layers)
        add_cylinder(layer.p0, layer.p1, layer.radius, {op.is_visible, false, false}, grid, out);
    if (!op.layers.empty()) return out;
    const bool fills = fills_off_lattice_cylinder(op, mode);
    CylinderParts parts{op.is_visible, fills, fills && mode == DrawMode::Full};
    if (fills && mode == DrawMode::Solid) parts.faces = {false, false, false};
    add_cylinder(op.p0, op.p1, op.radius, parts, grid, out);
    return out;
}

} // namespace fppg
