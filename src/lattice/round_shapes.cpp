#include "lattice/round_shapes.h"

#include "nodes/snap.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

SlabRegion region_of(const NodeBox& box)
{
    SlabRegion region;
    if (box.is_empty()) return region;
    region.x_begin = static_cast<std::uint32_t>(box.begin[0]);
    region.x_end = static_cast<std::uint32_t>(box.end[0]);
    return region;
}

NodeBox around(const Node& center, std::int64_t reach, const LatticeGrid& grid)
{
    return intersect({{center.x - reach, center.y - reach, center.z - reach},
                      {center.x + reach + 1, center.y + reach + 1, center.z + reach + 1}},
                     whole_lattice(grid));
}

void push(Spans& out, std::int64_t y, std::int64_t first, std::int64_t last)
{
    if (first <= last)
        out.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(first),
                       static_cast<std::uint32_t>(last) + 1});
}

/// An inclusive interval of z indices; empty when last < first.
struct Interval
{
    std::int64_t first = 0;
    std::int64_t last = -1;

    bool is_empty() const { return last < first; }
};

Interval meet(const Interval& a, const Interval& b)
{
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

/// Pushes `outer` without `inner`; inner lies inside outer or is empty.
void push_without(Spans& out, std::int64_t y, const Interval& outer, const Interval& inner)
{
    if (outer.is_empty()) return;
    if (inner.is_empty())
    {
        push(out, y, outer.first, outer.last);
        return;
    }
    push(out, y, outer.first, std::min(outer.last, inner.first - 1));
    push(out, y, std::max(outer.first, inner.last + 1), outer.last);
}

double rounded_radius(double radius, double dp)
{
    return std::floor(radius / dp + 0.5);
}

} // namespace

SlabRegion sphere_region(const SphereOp& sphere, const DrawState& state, const LatticeGrid& grid)
{
    const Node c = snap(sphere.center, grid);
    const Vec3 center = position(c, grid);
    const double width = state.constants.sphere * grid.dp;
    struct Shell
    {
        bool has_face = false; // |distance - radius| < width
        double radius = 0;
        bool has_ball = false; // distance <= ball
        double ball = 0;
        NodeBox limits;
    };
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
    if (!sphere.layers_dp.empty())
        for (const double layer : sphere.layers_dp)
            add(sphere.radius + layer * grid.dp, true, false);
    else
        add(sphere.radius, state.mode != DrawMode::Solid, state.mode != DrawMode::Face);

    double reach = 0;
    for (const Shell& s : shells) reach = std::max({reach, s.radius + width, s.ball});
    const NodeBox box = around(
        c, static_cast<std::int64_t>(std::ceil(std::min(std::max(reach, 0.0) / grid.dp, 4e9))) + 1,
        grid);
    SlabRegion region = region_of(box);
    region.emit = [=](std::uint32_t slab, Spans& out)
    {
        const double dx = center.x - (grid.origin.x + slab * grid.dp);
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            const double dy = center.y - (grid.origin.y + static_cast<double>(y) * grid.dp);
            const double flat = dx * dx + dy * dy;
            const auto distance = [&](std::int64_t z)
            {
                const double dz = center.z - (grid.origin.z + static_cast<double>(z) * grid.dp);
                return std::sqrt(flat + dz * dz);
            };
            // Nodes of `column` nearer than `limit`, an interval around the centre.
            const auto ball = [&](const Interval& column, double limit,
                                  const auto& holds) -> Interval
            {
                const double rest = limit * limit - flat;
                if (limit < 0 || rest < -4 * grid.dp * limit) return {};
                const double half = std::min(std::sqrt(std::max(rest, 0.0)) / grid.dp, 4e9);
                Interval i{c.z - static_cast<std::int64_t>(half),
                           c.z + static_cast<std::int64_t>(half)};
                if (!trim_interval(i.first, i.last, column.first, column.last, holds)) return {};
                return i;
            };
            for (const Shell& s : shells)
            {
                if (slab < s.limits.begin[0] || slab >= s.limits.end[0] || y < s.limits.begin[1] ||
                    y >= s.limits.end[1])
                    continue;
                const Interval column =
                    meet({box.begin[2], box.end[2] - 1}, {s.limits.begin[2], s.limits.end[2] - 1});
                if (column.is_empty()) continue;
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
                        out, y,
                        ball(column, s.ball, [&](std::int64_t z) { return distance(z) <= s.ball; }),
                        {});
            }
        }
    };
    return region;
}

SlabRegion cylinder_region(const CylinderOp& cylinder, const DrawState& state,
                           const LatticeGrid& grid)
{
    // One way to be taken: the values va and vb at the two ends of the axis (along it,
    // unnormalised), and the distance from the axis.
    struct Piece
    {
        int cover = -1; // 0, 1: near that end's plane; -1: between the two
        double radius = 0;
        bool is_shell = false; // |distance - radius| < width, else distance <= radius
    };
    struct Body
    {
        Node a;
        Node b;
        std::vector<Piece> pieces;
    };
    std::vector<Body> bodies;
    const auto add_faces = [&](Body& body, double radius)
    {
        if (cylinder.is_visible[2])
            body.pieces.push_back({-1, rounded_radius(radius, grid.dp) * grid.dp, true});
        if (cylinder.is_visible[0]) body.pieces.push_back({0, radius, false});
        if (cylinder.is_visible[1]) body.pieces.push_back({1, radius, false});
    };
    for (const CylinderLayer& layer : cylinder.layers)
    {
        Body body{snap(layer.p0, grid), snap(layer.p1, grid), {}};
        add_faces(body, layer.radius);
        bodies.push_back(body);
    }
    if (cylinder.layers.empty())
    {
        Body body{snap(cylinder.p0, grid), snap(cylinder.p1, grid), {}};
        if (state.mode != DrawMode::Solid || cylinder.is_masked) add_faces(body, cylinder.radius);
        if (state.mode != DrawMode::Face && !cylinder.is_masked)
            body.pieces.push_back({-1, cylinder.radius, false});
        bodies.push_back(body);
    }

    const double tube_width = state.constants.cylinder_tube * grid.dp;
    const double cover_width = state.constants.cylinder_cover * grid.dp;
    NodeBox all{{INT64_MAX, INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN, INT64_MIN}};
    std::vector<NodeBox> boxes;
    for (const Body& body : bodies)
    {
        double reach = 0;
        for (const Piece& p : body.pieces)
            reach = std::max(reach, p.radius + (p.is_shell ? tube_width : 0));
        const Vec3 a = position(body.a, grid);
        const Vec3 axis = position(body.b, grid) - a;
        const double length = norm(axis);
        NodeBox box;
        for (int k = 0; k < 3; ++k)
        {
            const auto i = static_cast<std::size_t>(k);
            const double u = length > 0 ? axis[k] / length : 0;
            const double side =
                (reach * std::sqrt(std::max(0.0, 1 - u * u)) + cover_width * std::fabs(u)) /
                grid.dp;
            box.begin[i] =
                std::min(body.a[k], body.b[k]) - static_cast<std::int64_t>(std::ceil(side)) - 1;
            box.end[i] =
                std::max(body.a[k], body.b[k]) + static_cast<std::int64_t>(std::ceil(side)) + 2;
        }
        box = intersect(box, whole_lattice(grid));
        // An axis of no length draws nothing.
        if (length == 0) box = {};
        boxes.push_back(box);
        if (box.is_empty()) continue;
        for (std::size_t i = 0; i < 3; ++i)
        {
            all.begin[i] = std::min(all.begin[i], box.begin[i]);
            all.end[i] = std::max(all.end[i], box.end[i]);
        }
    }
    SlabRegion region = region_of(all);
    region.emit = [=](std::uint32_t slab, Spans& out)
    {
        for (std::size_t n = 0; n < bodies.size(); ++n)
        {
            const NodeBox& box = boxes[n];
            if (box.is_empty() || slab < box.begin[0] || slab >= box.end[0]) continue;
            const Vec3 a = position(bodies[n].a, grid);
            const Vec3 b = position(bodies[n].b, grid);
            const Vec3 axis = b - a;
            const double length = norm(axis);
            const double offset_a = -dot(axis, a);
            const double offset_b = -dot(axis, b);
            const std::int64_t z_min = box.begin[2];
            const std::int64_t z_max = box.end[2] - 1;
            const double x = grid.origin.x + slab * grid.dp;
            const Vec3 u = axis / length;
            for (std::int64_t iy = box.begin[1]; iy < box.end[1]; ++iy)
            {
                const double y = grid.origin.y + static_cast<double>(iy) * grid.dp;
                const auto at = [&](std::int64_t k) {
                    return Vec3{x, y, grid.origin.z + static_cast<double>(k) * grid.dp};
                };
                const auto distance = [&](std::int64_t k)
                {
                    const Vec3 p = at(k);
                    return norm(cross(a - p, b - p)) / length;
                };
                const auto value_a = [&](std::int64_t k) { return dot(axis, at(k)) + offset_a; };
                const auto value_b = [&](std::int64_t k) { return dot(axis, at(k)) + offset_b; };

                // Estimates: distance^2 = qa w^2 + 2 qb w + qc with w the height above a, in
                // metres.
                const double flat = (x - a.x) * u.x + (y - a.y) * u.y;
                const double qa = 1 - u.z * u.z;
                const double qb = -flat * u.z;
                const double qc = (x - a.x) * (x - a.x) + (y - a.y) * (y - a.y) - flat * flat;
                const auto to_index = [&](double w)
                {
                    const double i = (a.z + w - grid.origin.z) / grid.dp;
                    return std::clamp(i, static_cast<double>(z_min) - 3,
                                      static_cast<double>(z_max) + 3);
                };
                const auto within = [&](double limit, const auto& holds) -> Interval
                {
                    if (limit < 0) return {};
                    Interval i{z_min, z_max};
                    if (qa > 1e-12)
                    {
                        const double root =
                            std::sqrt(std::max(0.0, qb * qb - qa * (qc - limit * limit)));
                        i.first =
                            static_cast<std::int64_t>(std::floor(to_index((-qb - root) / qa)));
                        i.last = static_cast<std::int64_t>(std::ceil(to_index((-qb + root) / qa)));
                    }
                    else if (!holds(z_min))
                        return {};
                    if (!trim_interval(i.first, i.last, z_min, z_max, holds)) return {};
                    return i;
                };
                const auto along = [&](double t_min, double t_max, const auto& holds) -> Interval
                {
                    Interval i{z_min, z_max};
                    if (std::fabs(u.z) > 1e-12)
                    {
                        const double e0 = to_index((t_min - flat) / u.z);
                        const double e1 = to_index((t_max - flat) / u.z);
                        i.first = static_cast<std::int64_t>(std::floor(std::min(e0, e1)));
                        i.last = static_cast<std::int64_t>(std::ceil(std::max(e0, e1)));
                    }
                    else if (!holds(z_min))
                        return {};
                    if (!trim_interval(i.first, i.last, z_min, z_max, holds)) return {};
                    return i;
                };
                // Upright axes: the distance is the same all along the column but for rounding.
                // Within rounding of a limit, nodes are asked one by one; else the first stands for
                // all.
                const auto is_tie = [&](const Piece& p)
                {
                    if (qa > 1e-12) return false;
                    const double d = distance(z_min);
                    const double gap = p.is_shell ? std::fabs(std::fabs(d - p.radius) - tube_width)
                                                  : std::fabs(d - p.radius);
                    return gap < 1e-6 * grid.dp;
                };
                const auto is_taken = [&](const Piece& p, std::int64_t k)
                {
                    if (p.cover == 0   ? !(std::fabs(value_a(k) / length) < cover_width)
                        : p.cover == 1 ? !(std::fabs(value_b(k) / length) < cover_width)
                                       : !(value_a(k) >= 0 && value_b(k) <= 0))
                        return false;
                    return p.is_shell ? std::fabs(distance(k) - p.radius) < tube_width
                                      : distance(k) <= p.radius;
                };
                for (const Piece& p : bodies[n].pieces)
                {
                    if (is_tie(p))
                    {
                        for (std::int64_t k = z_min; k <= z_max; ++k)
                            if (is_taken(p, k)) push(out, iy, k, k);
                        continue;
                    }
                    Interval t;
                    if (p.cover < 0)
                        t = along(0, length,
                                  [&](std::int64_t k)
                                  { return value_a(k) >= 0 && value_b(k) <= 0; });
                    else if (p.cover == 0)
                        t = along(-cover_width, cover_width,
                                  [&](std::int64_t k)
                                  { return std::fabs(value_a(k) / length) < cover_width; });
                    else
                        t = along(length - cover_width, length + cover_width,
                                  [&](std::int64_t k)
                                  { return std::fabs(value_b(k) / length) < cover_width; });
                    if (t.is_empty()) continue;
                    if (!p.is_shell)
                    {
                        const Interval disc = within(
                            p.radius, [&](std::int64_t k) { return distance(k) <= p.radius; });
                        push_without(out, iy, meet(disc, t), {});
                        continue;
                    }
                    const Interval outer = within(p.radius + tube_width, [&](std::int64_t k)
                                                  { return distance(k) - p.radius < tube_width; });
                    const Interval inner =
                        within(p.radius - tube_width, [&](std::int64_t k)
                               { return !(p.radius - distance(k) < tube_width); });
                    push_without(out, iy, meet(outer, t), inner);
                }
            }
        }
    };
    return region;
}

SlabRegion ellipsoid_region(const EllipsoidOp& ellipsoid, const DrawState& state,
                            const LatticeGrid& grid)
{
    const Node f0 = snap(ellipsoid.focus0, grid);
    const Node f1 = snap(ellipsoid.focus1, grid);
    const double s0 = rounded_radius(ellipsoid.radius, grid.dp);
    const double width = state.constants.sphere;
    const double outer_limit =
        state.mode == DrawMode::Solid ? ellipsoid.radius / grid.dp : s0 + width;
    const bool is_open = state.mode != DrawMode::Solid;
    const double inner_limit = state.mode == DrawMode::Face ? s0 - width : -1;
    const auto reach = static_cast<std::int64_t>(std::ceil(std::min(outer_limit, 4e9)));
    const NodeBox box = intersect(around(f0, reach, grid), around(f1, reach, grid));
    SlabRegion region = region_of(box);
    region.emit = [=](std::uint32_t x, Spans& out)
    {
        const auto sum = [&](std::int64_t y, std::int64_t z)
        {
            const auto distance = [&](const Node& f)
            {
                const auto dx = static_cast<double>(static_cast<std::int64_t>(x) - f.x);
                const auto dy = static_cast<double>(y - f.y);
                const auto dz = static_cast<double>(z - f.z);
                return std::sqrt(dx * dx + dy * dy + dz * dz);
            };
            return distance(f0) + distance(f1);
        };
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            // The sum is convex in z: its least node splits the column into two monotone halves.
            std::int64_t low = box.begin[2];
            std::int64_t high = box.end[2] - 1;
            while (high - low > 2)
            {
                const std::int64_t m = low + (high - low) / 2;
                if (sum(y, m) <= sum(y, m + 1))
                    high = m + 1;
                else
                    low = m;
            }
            std::int64_t best = low;
            for (std::int64_t z = low; z <= high; ++z)
                if (sum(y, z) < sum(y, best)) best = z;
            const auto widest = [&](const auto& holds) -> Interval
            {
                if (!holds(best)) return {};
                std::int64_t below = box.begin[2] - 1;
                std::int64_t first = best;
                while (first - below > 1)
                {
                    const std::int64_t m = below + (first - below) / 2;
                    holds(m) ? first = m : below = m;
                }
                std::int64_t above = box.end[2];
                std::int64_t last = best;
                while (above - last > 1)
                {
                    const std::int64_t m = last + (above - last) / 2;
                    holds(m) ? last = m : above = m;
                }
                return {first, last};
            };
            const Interval outer =
                widest([&](std::int64_t z)
                       { return is_open ? sum(y, z) < outer_limit : sum(y, z) <= outer_limit; });
            const Interval inner =
                inner_limit < 0 ? Interval{}
                                : widest([&](std::int64_t z) { return sum(y, z) <= inner_limit; });
            push_without(out, y, outer, inner);
        }
    };
    return region;
}

} // namespace fppg
