// drawtorus, a command of fppg's own: GenCase v5.4 refuses it.
#include "shapes/solid_shape.h"

#include "meshes/round_surface.h"
#include "shapes/round_columns.h"
#include "shapes/round_facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

namespace fppg
{
namespace
{

constexpr double pi = std::numbers::pi;

/// The circle in the middle of the tube.
struct Circle
{
    Vec3 center;
    Vec3 axis; ///< of length 1
    double radius = 0;

    /// How far a point is from it, and the way from its nearest point.
    Level at(const Vec3& p) const
    {
        const Vec3 d = p - center;
        const double height = dot(d, axis);
        const Vec3 out = d - axis * height;
        const double beyond = norm(out) - radius;
        return {std::sqrt(beyond * beyond + height * height),
                unit(unit(out) * beyond + axis * height)};
    }

    /// The point at an angle around the axis and one around the circle, `tube` from it.
    Vec3 point(double around_axis, double around_tube, double tube) const
    {
        const auto [v, w] = across(axis);
        const Vec3 out = v * std::cos(around_axis) + w * std::sin(around_axis);
        return center + out * (radius + tube * std::cos(around_tube)) +
               axis * (tube * std::sin(around_tube));
    }
};

class Torus : public SolidShape
{
public:
    Torus(const Vec3& center, const Vec3& axis, double radius, double tube)
        : circle_{center, axis, radius}, tube_(tube)
    {
    }

    Box3 bounds() const override
    {
        Vec3 half;
        for (int i = 0; i < 3; ++i) half[i] = half_width(i) + tube_;
        Box3 box;
        box.add(circle_.center - half);
        box.add(circle_.center + half);
        return box;
    }

    ShapeMesh surface(double dp) const override;
    SlabRegion nodes(const DrawState& state, const LatticeGrid& grid) const override;
    std::vector<ShapeCell> cells(const ShapeContext& context) const override;

    /// By Pappus; the moments of a ring of circular section.
    ExactBody moments() const override
    {
        const double a = circle_.radius * circle_.radius;
        const double b = tube_ * tube_;
        ExactBody body;
        body.volume = 2 * pi * pi * circle_.radius * b;
        body.center = circle_.center;
        body.inertia = inertia_around(circle_.axis, body.volume * (a + 0.75 * b),
                                      body.volume * (0.5 * a + 0.625 * b));
        return body;
    }

private:
    /// Of the circle along an axis of the lattice.
    double half_width(int i) const
    {
        const double u = circle_.axis[i];
        return circle_.radius * std::sqrt(std::max(0.0, 1 - u * u));
    }

    Circle circle_;
    double tube_;
};

/// Quads of two triangles. Chords around the axis and around the tube lie below the surface by half
/// of chord_error_dp each.
ShapeMesh Torus::surface(double dp) const
{
    const double tube_sides = sides_for_chord(tube_, 0.5 * dp);
    // Facets are at most four times as long as wide.
    const double ring_sides =
        std::max(sides_for_chord(circle_.radius + tube_, 0.5 * dp),
                 std::ceil((circle_.radius + tube_) / (4 * tube_) * tube_sides));
    check_facets(2 * ring_sides * tube_sides);
    const auto n = static_cast<std::size_t>(ring_sides);
    const auto m = static_cast<std::size_t>(tube_sides);
    std::vector<Vec3> corners;
    corners.reserve(n * m);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < m; ++j)
            corners.push_back(circle_.point(2 * pi * static_cast<double>(i) / ring_sides,
                                            2 * pi * static_cast<double>(j) / tube_sides, tube_));
    ShapeMesh out;
    out.soup.vertices.reserve(6 * n * m);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < m; ++j)
        {
            const Vec3& a = corners[i * m + j];
            const Vec3& b = corners[(i + 1) % n * m + j];
            const Vec3& c = corners[(i + 1) % n * m + (j + 1) % m];
            const Vec3& d = corners[i * m + (j + 1) % m];
            for (const Vec3& corner : {a, b, c, a, c, d}) out.soup.vertices.push_back(corner);
        }
    const auto level = [circle = circle_, tube = tube_](const Vec3& p) -> Level
    {
        const Level found = circle.at(p);
        return {found.value - tube, found.gradient};
    };
    out.round = std::make_shared<const RoundSurface>(RoundSurface{level, circle_.radius});
    return out;
}

/// The rules of spheres (R1) with the circle in the place of the centre, fppg's own: with C the
/// real place of the snapped centre, s the distance of a node from the circle of the given axis and
/// radius around C, and r = floor(tube / dp + 0.5) * dp: face |s - r| < width, solid s <= tube,
/// full either. Axis and radius are not rounded; the width is ctesphere.
SlabRegion Torus::nodes(const DrawState& state, const LatticeGrid& grid) const
{
    const Node c = snap(circle_.center, grid);
    const Circle circle{position(c, grid), circle_.axis, circle_.radius};
    const double width = state.constants.sphere * grid.dp;
    const double shell = rounded_radius(tube_, grid.dp) * grid.dp;
    const double tube = tube_;
    const bool has_face = state.mode != DrawMode::Solid;
    const bool has_inside = state.mode != DrawMode::Face;
    const double reach = std::max(has_face ? shell + width : 0, tube);
    NodeBox box;
    for (int i = 0; i < 3; ++i)
    {
        const auto steps = static_cast<std::int64_t>(
            std::min(std::ceil((half_width(i) + reach) / grid.step(i)), 4e9) + 1);
        box.begin[static_cast<std::size_t>(i)] = c[i] - steps;
        box.end[static_cast<std::size_t>(i)] = c[i] + steps + 1;
    }
    box = intersect(box, whole_lattice(grid));
    SlabRegion region = slabs_of(box);
    region.emit = [=](std::uint32_t x, Spans& out)
    {
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            std::int64_t first = -1; // of the nodes taken that end below z
            for (std::int64_t z = box.begin[2]; z < box.end[2]; ++z)
            {
                const double s = circle.at(position({x, y, z}, grid)).value;
                const bool is_taken =
                    (has_face && std::fabs(s - shell) < width) || (has_inside && s <= tube);
                if (is_taken && first < 0) first = z;
                if (is_taken || first < 0) continue;
                push(out, y, first, z - 1);
                first = -1;
            }
            if (first >= 0) push(out, y, first, box.end[2] - 1);
        }
    };
    return region;
}

/// As many quads around the axis as a cylinder has sides and around the tube as a sphere has.
std::vector<ShapeCell> Torus::cells(const ShapeContext& context) const
{
    const Circle circle{context.place(circle_.center), circle_.axis, circle_.radius};
    const double tube = context.rounded(tube_);
    const int n = context.state.constants.cylinder_sides;
    const int m = context.state.constants.sphere_sides;
    const auto corner = [&](int i, int j)
    { return circle.point(2 * pi * (i % n) / n, 2 * pi * (j % m) / m, tube); };
    std::vector<ShapeCell> out;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j)
            out.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
    return out;
}

} // namespace

SolidOp make_torus(const Vec3& center, const Vec3& axis, double radius, double tube)
{
    return {std::make_shared<const Torus>(center, axis, radius, tube)};
}

/// Radii are not scaled by the matrix, as those of spheres and cylinders.
std::optional<Shape> read_torus(const DrawReader& reader)
{
    if (reader.mode() == DrawMode::Wire)
        reader.fail("draw mode wire is not possible for a torus, expected face, solid or full");
    const std::vector<Vec3> points = reader.points(1, 2);
    const std::optional<Vec3> vector = reader.direction("vector");
    if (vector.has_value() == (points.size() == 2))
        reader.fail(
            "expected its centre as <point> and its axis as <vector> or as a second "
            "<point>, one of the two");
    const Vec3 axis = unit(vector ? *vector : points[1] - points[0]);
    if (axis == Vec3{}) reader.fail("its axis has no direction, expected a length above 0");
    const double radius = reader.number("radius");
    const double tube = reader.number("tube");
    if (!(radius > 0)) reader.fail(fmt::format("radius is {:g}, expected above 0", radius));
    if (!(tube > 0 && tube < radius))
        reader.fail(
            fmt::format("tube is {:g}, expected above 0 and below the radius of {:g}, which leads "
                        "to the middle of the tube",
                        tube, radius));
    return make_torus(points[0], axis, radius, tube);
}

} // namespace fppg
