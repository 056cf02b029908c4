#include "lattice/round_shapes.h"

#include "lattice/snap.h"

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
    const double width = state.constants.sphere;
    struct Shell
    {
        double outer;      // d < outer, or d <= outer
        bool is_open;      // d < outer
        double inner = -1; // d <= inner is left out; negative: nothing is
    };
    std::vector<Shell> shells;
    const auto add_face = [&](double radius)
    {
        const double r = rounded_radius(radius, grid.dp);
        shells.push_back({r + width, true, r - width});
    };
    if (!sphere.layers_dp.empty())
        for (const double layer : sphere.layers_dp) add_face(sphere.radius + layer * grid.dp);
    else if (state.mode == DrawMode::Face)
        add_face(sphere.radius);
    else if (state.mode == DrawMode::Full)
        shells.push_back({rounded_radius(sphere.radius, grid.dp) + width, true});
    else
        shells.push_back({sphere.radius / grid.dp, false});

    double reach = 0;
    for (const Shell& s : shells) reach = std::max(reach, s.outer);
    const NodeBox box = around(c, static_cast<std::int64_t>(std::ceil(std::min(reach, 4e9))), grid);
    SlabRegion region = region_of(box);
    region.emit = [=](std::uint32_t x, Spans& out)
    {
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            const auto dx = static_cast<double>(x - c.x);
            const auto dy = static_cast<double>(y - c.y);
            const double flat = dx * dx + dy * dy;
            for (const Shell& s : shells)
            {
                const auto distance = [&](std::int64_t z)
                {
                    const auto dz = static_cast<double>(z - c.z);
                    return std::sqrt(flat + dz * dz);
                };
                const auto ball = [&](double limit, const auto& holds) -> Interval
                {
                    const double rest = limit * limit - flat;
                    const auto half = static_cast<std::int64_t>(std::sqrt(std::max(rest, 0.0)));
                    Interval i{c.z - half, c.z + half};
                    if (limit < 0 ||
                        !trim_interval(i.first, i.last, INT64_MIN / 2, INT64_MAX / 2, holds))
                        return {};
                    return i;
                };
                Interval outer =
                    ball(s.outer, [&](std::int64_t z)
                         { return s.is_open ? distance(z) < s.outer : distance(z) <= s.outer; });
                const Interval inner = s.inner < 0 ? Interval{}
                                                   : ball(s.inner, [&](std::int64_t z)
                                                          { return distance(z) <= s.inner; });
                outer = meet(outer, {box.begin[2], box.end[2] - 1});
                push_without(out, y, outer, inner);
            }
        }
    };
    return region;
}

SlabRegion cylinder_region(const CylinderOp& cylinder, const DrawState& state,
                           const LatticeGrid& grid)
{
    const Node a = snap(cylinder.p0, grid);
    const Node b = snap(cylinder.p1, grid);
    const Vec3 axis_vector{static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y),
                           static_cast<double>(b.z - a.z)};
    const double length = norm(axis_vector);
    SlabRegion region;
    if (length == 0) return region;
    const Vec3 u = axis_vector / length;
    const double tube_width = state.constants.cylinder_tube;
    const double cover_width = state.constants.cylinder_cover;

    // One piece: t within [t_min, t_max] (open or closed) and q in a ring.
    struct Piece
    {
        double t_min;
        double t_max;
        bool t_open;
        double q_max;
        bool q_open;
        double q_min = -1; // q <= q_min is left out; negative: nothing is
    };
    std::vector<Piece> pieces;
    const bool all_visible =
        cylinder.is_visible[0] && cylinder.is_visible[1] && cylinder.is_visible[2];
    const auto add_faces = [&](double radius, double cover_shift)
    {
        const double r = rounded_radius(radius, grid.dp);
        const double real = radius / grid.dp;
        const double low = -cover_shift;
        const double high = length + cover_shift;
        if (cylinder.is_visible[2])
            pieces.push_back({low, high, false, r + tube_width, true, r - tube_width});
        if (cylinder.is_visible[0])
            pieces.push_back({low - cover_width, low + cover_width, true, real, false});
        if (cylinder.is_visible[1])
            pieces.push_back({high - cover_width, high + cover_width, true, real, false});
    };
    if (!cylinder.layers_dp.empty())
    {
        for (const double layer : cylinder.layers_dp)
        {
            // Visible covers move outwards with the layer, hidden ones stay where they are.
            const double r = rounded_radius(cylinder.radius + layer * grid.dp, grid.dp);
            const double real = (cylinder.radius + layer * grid.dp) / grid.dp;
            const double shift = std::floor(layer + 0.5);
            const double low = cylinder.is_visible[0] ? -shift : 0;
            const double high = length + (cylinder.is_visible[1] ? shift : 0);
            if (cylinder.is_visible[2])
                pieces.push_back({low, high, false, r + tube_width, true, r - tube_width});
            if (cylinder.is_visible[0])
                pieces.push_back({low - cover_width, low + cover_width, true, real, false});
            if (cylinder.is_visible[1])
                pieces.push_back({high - cover_width, high + cover_width, true, real, false});
        }
    }
    else
    {
        if (state.mode != DrawMode::Solid || !all_visible) add_faces(cylinder.radius, 0);
        if (state.mode != DrawMode::Face && all_visible)
            pieces.push_back({0, length, false, cylinder.radius / grid.dp, false});
    }
    if (pieces.empty()) return region;

    // The box of the round body, with room for rounding.
    NodeBox box;
    double reach = 0;
    double t_low = 0;
    double t_high = length;
    for (const Piece& p : pieces)
    {
        reach = std::max(reach, p.q_max);
        t_low = std::min(t_low, p.t_min);
        t_high = std::max(t_high, p.t_max);
    }
    for (int k = 0; k < 3; ++k)
    {
        const double e0 = static_cast<double>(a[k]) + t_low * u[k];
        const double e1 = static_cast<double>(a[k]) + t_high * u[k];
        const double side = reach * std::sqrt(std::max(0.0, 1 - u[k] * u[k]));
        box.begin[static_cast<std::size_t>(k)] =
            static_cast<std::int64_t>(std::floor(std::min(e0, e1) - side)) - 1;
        box.end[static_cast<std::size_t>(k)] =
            static_cast<std::int64_t>(std::ceil(std::max(e0, e1) + side)) + 2;
    }
    box = intersect(box, whole_lattice(grid));
    region = region_of(box);
    region.emit = [=](std::uint32_t x, Spans& out)
    {
        const std::int64_t z_min = box.begin[2];
        const std::int64_t z_max = box.end[2] - 1;
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            const auto dx = static_cast<double>(static_cast<std::int64_t>(x) - a.x);
            const auto dy = static_cast<double>(y - a.y);
            const auto along = [&](std::int64_t z)
            { return dx * u.x + dy * u.y + static_cast<double>(z - a.z) * u.z; };
            const auto across = [&](std::int64_t z)
            {
                const Vec3 d{dx, dy, static_cast<double>(z - a.z)};
                return norm(cross(d, axis_vector)) / length;
            };
            // q^2 = qa w^2 + 2 qb w + qc with w = z - a.z
            const double flat = dx * u.x + dy * u.y;
            const double qa = 1 - u.z * u.z;
            const double qb = -flat * u.z;
            const double qc = dx * dx + dy * dy - flat * flat;
            const auto ring = [&](double limit, const auto& holds) -> Interval
            {
                if (limit < 0) return {};
                double lo = static_cast<double>(z_min);
                double hi = static_cast<double>(z_max);
                if (qa > 1e-12)
                {
                    const double disc = qb * qb - qa * (qc - limit * limit);
                    const double root = std::sqrt(std::max(disc, 0.0));
                    lo = (-qb - root) / qa + static_cast<double>(a.z);
                    hi = (-qb + root) / qa + static_cast<double>(a.z);
                    lo = std::clamp(lo, static_cast<double>(z_min) - 3,
                                    static_cast<double>(z_max) + 3);
                    hi = std::clamp(hi, static_cast<double>(z_min) - 3,
                                    static_cast<double>(z_max) + 3);
                }
                Interval i{static_cast<std::int64_t>(std::floor(lo)),
                           static_cast<std::int64_t>(std::ceil(hi))};
                if (!trim_interval(i.first, i.last, z_min, z_max, holds)) return {};
                return i;
            };
            for (const Piece& p : pieces)
            {
                double lo = static_cast<double>(z_min);
                double hi = static_cast<double>(z_max);
                if (std::fabs(u.z) > 1e-12)
                {
                    const double e0 = (p.t_min - flat) / u.z + static_cast<double>(a.z);
                    const double e1 = (p.t_max - flat) / u.z + static_cast<double>(a.z);
                    lo = std::clamp(std::min(e0, e1), lo - 3, hi + 3);
                    hi = std::clamp(std::max(e0, e1), lo, hi + 3);
                }
                Interval t{static_cast<std::int64_t>(std::floor(lo)),
                           static_cast<std::int64_t>(std::ceil(hi))};
                const auto in_slab = [&](std::int64_t z)
                {
                    const double v = along(z);
                    return p.t_open ? v > p.t_min && v < p.t_max : v >= p.t_min && v <= p.t_max;
                };
                if (!trim_interval(t.first, t.last, z_min, z_max, in_slab)) continue;
                const Interval outer =
                    ring(p.q_max, [&](std::int64_t z)
                         { return p.q_open ? across(z) < p.q_max : across(z) <= p.q_max; });
                if (outer.is_empty()) continue;
                const Interval inner = p.q_min < 0 ? Interval{}
                                                   : ring(p.q_min, [&](std::int64_t z)
                                                          { return across(z) <= p.q_min; });
                push_without(out, y, meet(outer, t), inner);
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
    const double width = state.constants.ellipsoid;
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
