#include "meshes/round_surface.h"
#include "shapes/kinds.h"
#include "shapes/round_columns.h"
#include "shapes/round_facets.h"
#include "shapes/shape_rings.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace fppg::kinds
{
namespace
{

/// Moves the directions of a sphere's corners towards `axis`, without turning a facet over: in the
/// stereographic projection from the other end of the axis it is a scaling by `factor`, so that
/// facets keep their shape. One corner is that other end, so that the body stays as deep as it was.
void gather_about(const Vec3& axis, double factor, std::vector<Vec3>& directions)
{
    *std::min_element(directions.begin(), directions.end(),
                      [&](const Vec3& a, const Vec3& b) { return dot(a, axis) < dot(b, axis); }) =
        -1.0 * axis;
    for (Vec3& p : directions)
    {
        const double along = std::clamp(dot(p, axis), -1.0, 1.0);
        const Vec3 aside = p - along * axis;
        const double side = norm(aside);
        if (!(side > 0)) continue;
        const double tangent = factor * std::sqrt((1 - along) / (1 + along)); // of half the angle
        const double scale = 1 / (1 + tangent * tangent);
        p = (1 - tangent * tangent) * scale * axis + (2 * tangent * scale / side) * aside;
    }
}

/// A geodesic sphere: the faces of an icosahedron cut evenly, 1167 radius / dp facets and never
/// fewer than 500.
///
/// near  if not empty, the facets in this box are so small, and the others grow away from it
ShapeMesh sphere_mesh(const Vec3& center, double radius, const Box3& near, double dp)
{
    check_size("a sphere with a radius", radius);
    double parts = std::max(5.0, parts_for_chord(radius / dp));
    Vec3 axis;
    double factor = 1;
    if (!near.is_empty())
    {
        constexpr double least_parts = 24;
        const Vec3 to_box = near.min + 0.5 * (near.max - near.min) - center;
        const double away = norm(to_box);
        axis = away > 0 ? to_box / away : Vec3{0, 0, 1};
        // Half of the angle at which the box is seen from the middle, where the sphere passes it.
        factor = std::tan(0.5 * std::asin(std::min(0.5, 0.5 * norm(near.max - near.min) / radius)));
        parts = std::max(least_parts, std::ceil(2 * factor * parts));
        // Where the middle is in the box, the sphere is far from it.
        if (away < 0.5 * radius) factor = 1;
    }
    check_facets(20 * parts * parts);
    SharedFacets mesh = geodesic_sphere(static_cast<std::uint32_t>(parts));
    if (factor != 1) gather_about(axis, factor, mesh.vertices);
    for (Vec3& p : mesh.vertices) p = center + p * radius;
    ShapeMesh out;
    out.soup = mesh.soup();
    const auto level = [center, radius](const Vec3& p) -> Level {
        return {norm(p - center) - radius, unit(p - center)};
    };
    out.round = std::make_shared<const RoundSurface>(RoundSurface{level, radius});
    return out;
}

/// A sphere or a layer of it, as nodes are tested.
struct Shell
{
    bool has_face = false; ///< |distance - radius| < width
    double radius = 0;
    bool has_ball = false; ///< distance <= ball
    double ball = 0;
    NodeBox limits;
};

std::vector<Shell> shells_of(const SphereOp& sphere, const DrawState& state,
                             const LatticeGrid& grid)
{
    std::vector<Shell> shells;
    const auto add = [&](double radius, bool face, bool ball)
    {
        NodeBox limits = whole_lattice(grid);
        if (shells.size() < sphere.limits.size())
        {
            const Box3& box = sphere.limits[shells.size()];
            const Node low = snap(box.min, grid);
            const Node high = snap(box.max, grid);
            limits = intersect(
                limits, {{low.x - 1, low.y - 1, low.z - 1}, {high.x + 2, high.y + 2, high.z + 2}});
        }
        shells.push_back({face, rounded_radius(radius, grid.dp) * grid.dp, ball, radius, limits});
    };
    for (const double layer : sphere.layers_dp) add(sphere.radius + layer * grid.dp, true, false);
    if (sphere.layers_dp.empty())
        add(sphere.radius, state.mode != DrawMode::Solid, state.mode != DrawMode::Face);
    return shells;
}

/// One column of nodes beside the centre of a sphere.
class SphereColumn
{
public:
    SphereColumn(const Node& c, const LatticeGrid& grid, std::uint32_t slab, std::int64_t y)
        : c_(c), center_(position(c, grid)), grid_(grid)
    {
        const double dx = center_.x - (grid.origin.x + slab * grid.step(0));
        const double dy = center_.y - (grid.origin.y + static_cast<double>(y) * grid.step(1));
        flat_ = dx * dx + dy * dy;
    }

    /// Appends the nodes of a shell; `column` limits them.
    void list(const Shell& s, double width, const Interval& column, std::int64_t y,
              Spans& out) const
    {
        if (s.has_face)
        {
            const Interval outer =
                ball(column, s.radius + width,
                     [&](std::int64_t z) { return distance(z) - s.radius < width; });
            const Interval inner =
                ball(column, s.radius - width,
                     [&](std::int64_t z) { return !(s.radius - distance(z) < width); });
            push_without(out, y, outer, inner);
        }
        if (s.has_ball)
            push_without(
                out, y, ball(column, s.ball, [&](std::int64_t z) { return distance(z) <= s.ball; }),
                {});
    }

private:
    double distance(std::int64_t z) const
    {
        const double dz = center_.z - (grid_.origin.z + static_cast<double>(z) * grid_.step(2));
        return std::sqrt(flat_ + dz * dz);
    }

    /// Nodes of `column` nearer than `limit`, an interval around the centre.
    template <typename Holds>
    Interval ball(const Interval& column, double limit, const Holds& holds) const
    {
        const double rest = limit * limit - flat_;
        if (limit < 0 || rest < -4 * grid_.dp * limit) return {};
        const double half = std::min(std::sqrt(std::max(rest, 0.0)) / grid_.step(2), 4e9);
        Interval i{c_.z - static_cast<std::int64_t>(half), c_.z + static_cast<std::int64_t>(half)};
        if (!trim_interval(i.first, i.last, column.first, column.last, holds)) return {};
        return i;
    }

    Node c_;
    Vec3 center_;
    const LatticeGrid& grid_;
    double flat_ = 0; ///< squared distance across z
};

void add_cells_of(const Vec3& center, double radius, CellList& out)
{
    const ShapeContext& context = out.context;
    const auto rings = sphere_rings(context.place(center), context.rounded(radius),
                                    context.state.constants.sphere_sides);
    const Vec3& low = rings.front()[0];
    const Vec3& high = rings.back()[0];
    const std::vector<Vec3>& lowest = rings[1];
    const std::vector<Vec3>& highest = rings[rings.size() - 2];
    const std::size_t n = lowest.size();
    const auto next = [n](std::size_t i) { return (i + 1) % n; };
    for (std::size_t i = 0; i < n; ++i) out.add_face({low, lowest[i], lowest[next(i)]});
    for (std::size_t ring = 1; ring + 2 < rings.size(); ++ring)
        for (std::size_t i = 0; i < n; ++i)
            out.add_round_face({rings[ring][next(i)], rings[ring][i], rings[ring + 1][i],
                                rings[ring + 1][next(i)]});
    for (std::size_t i = 0; i < n; ++i) out.add_round_face({highest[next(i)], highest[i], high});
}

} // namespace

Box3 bounds_of(const SphereOp& sphere, double dp)
{
    const auto thickest = std::max_element(sphere.layers_dp.begin(), sphere.layers_dp.end());
    const double r = sphere.radius + (thickest == sphere.layers_dp.end() ? 0 : *thickest * dp);
    Box3 box;
    add_ball(box, sphere.center, {r, r, r});
    return box;
}

bool is_body(const SphereOp& sphere, DrawMode)
{
    return sphere.layers_dp.empty();
}

std::vector<ShapeMesh> surfaces_of(const SphereOp& sphere, const ShapeContext& context)
{
    std::vector<ShapeMesh> out;
    if (context.is_wire()) return out;
    const double dp = context.grid.dp;
    for (const double layer : sphere.layers_dp)
        out.push_back(sphere_mesh(sphere.center, sphere.radius + layer * dp, sphere.near, dp));
    if (!out.empty()) return out;
    out.push_back(sphere_mesh(sphere.center, sphere.radius, sphere.near, dp));
    out.back().is_solid = context.may_fill();
    return out;
}

SlabRegion nodes_of(const SphereOp& sphere, const DrawState& state, const LatticeGrid& grid)
{
    const Node c = snap(sphere.center, grid);
    const double width = state.constants.sphere * grid.dp;
    const std::vector<Shell> shells = shells_of(sphere, state, grid);
    double reach = 0;
    for (const Shell& s : shells) reach = std::max({reach, s.radius + width, s.ball});
    const NodeBox box = around(c,
                               static_cast<std::int64_t>(std::ceil(
                                   std::min(std::max(reach, 0.0) / grid.least_step(), 4e9))) +
                                   1,
                               grid);
    SlabRegion region = slabs_of(box);
    region.emit = [=](std::uint32_t slab, Spans& out)
    {
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            const SphereColumn nodes(c, grid, slab, y);
            for (const Shell& s : shells)
            {
                if (slab < s.limits.begin[0] || slab >= s.limits.end[0] || y < s.limits.begin[1] ||
                    y >= s.limits.end[1])
                    continue;
                const Interval column =
                    meet({box.begin[2], box.end[2] - 1}, {s.limits.begin[2], s.limits.end[2] - 1});
                if (!column.is_empty()) nodes.list(s, width, column, y, out);
            }
        }
    };
    return region;
}

void add_cells(const SphereOp& sphere, CellList& out)
{
    for (const double layer : sphere.shown_layers_dp)
        add_cells_of(sphere.center, sphere.radius + layer * out.context.grid.dp, out);
    if (sphere.layers_dp.empty()) add_cells_of(sphere.center, sphere.radius, out);
}

std::optional<ExactBody> body_of(const SphereOp& sphere, const ShapeContext&, std::string& why_not)
{
    if (!sphere.layers_dp.empty())
    {
        why_not = "it is drawn by layers or a part of a closed shape only";
        return std::nullopt;
    }
    const double r = sphere.radius;
    ExactBody body;
    body.volume = 4.0 / 3 * std::numbers::pi * r * r * r;
    body.center = sphere.center;
    const double i = body.volume * 0.4 * r * r;
    body.inertia = inertia_around({1, 0, 0}, i, i);
    return body;
}

} // namespace fppg::kinds
