#include "meshes/round_surface.h"
#include "shapes/kinds.h"
#include "shapes/round_columns.h"
#include "shapes/round_facets.h"
#include "shapes/shape_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace fppg::kinds
{
namespace
{

/// A ring of corners, counter-clockwise seen from the tip of the axis.
using Ring = std::vector<std::uint32_t>;

class CylinderMesher
{
public:
    CylinderMesher(const Vec3& p0, const Vec3& p1, double radius, double dp) : p0_(p0), p1_(p1)
    {
        const Vec3 axis = p1 - p0;
        u_ = axis / norm(axis);
        [[maybe_unused]] const auto [v, w] = across(u_);
        const double least = sides_for_chord(radius, dp);
        check_facets(least);
        // The number of sides is such that it can be halved towards the middle of a cover.
        while (least / (1U << (halvings_ + 1)) >= 6) ++halvings_;
        sides_ = static_cast<std::uint32_t>(std::ceil(least / (1U << halvings_))) << halvings_;
        for (std::uint32_t i = 0; i < sides_; ++i)
        {
            const double turn = 2 * std::numbers::pi * i / sides_;
            spokes_.push_back(v * (radius * std::cos(turn)) + w * (radius * std::sin(turn)));
        }
        // Facets of the tube are at most four times as long as wide.
        rows_ = std::max(1.0, std::ceil(norm(axis) / (8 * std::numbers::pi * radius / sides_)));
        check_facets(2 * rows_ * sides_);
    }

    SharedFacets run(const std::array<bool, 3>& is_visible)
    {
        const Ring bottom = is_visible[0] || is_visible[2] ? ring(p0_, 1, 1) : Ring{};
        Ring top;
        if (is_visible[2])
        {
            Ring below = bottom;
            const auto rows = static_cast<std::uint32_t>(rows_);
            for (std::uint32_t row = 1; row <= rows; ++row)
            {
                top = ring(row == rows ? p1_ : p0_ + (p1_ - p0_) * (row / rows_), 1, 1);
                add_band(below, top);
                below = top;
            }
        }
        else if (is_visible[1])
            top = ring(p1_, 1, 1);
        if (is_visible[0]) add_cover(p0_, bottom, true);
        if (is_visible[1]) add_cover(p1_, top, false);
        return std::move(mesh_);
    }

private:
    Ring ring(const Vec3& center, double share, std::uint32_t step)
    {
        Ring out;
        for (std::uint32_t i = 0; i < sides_; i += step)
            out.push_back(mesh_.add(center + spokes_[i] * share));
        return out;
    }

    void add_band(const Ring& below, const Ring& above)
    {
        for (std::uint32_t i = 0; i < sides_; ++i)
        {
            const std::uint32_t j = (i + 1) % sides_;
            mesh_.facets.push_back({below[i], below[j], above[j]});
            mesh_.facets.push_back({below[i], above[j], above[i]});
        }
    }

    /// Rings with half as many corners each towards the middle, so that facets stay well shaped.
    void add_cover(const Vec3& center, const Ring& rim, bool looks_down)
    {
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c)
        {
            mesh_.facets.push_back(looks_down ? std::array<std::uint32_t, 3>{a, c, b}
                                              : std::array<std::uint32_t, 3>{a, b, c});
        };
        Ring outer = rim;
        for (int halving = 1; halving <= halvings_; ++halving)
        {
            const std::uint32_t step = 1U << halving;
            const Ring inner = ring(center, 1 - 0.6 * (step - 1) / (1U << halvings_), step);
            for (std::size_t i = 0; i < inner.size(); ++i)
            {
                const std::uint32_t next = inner[(i + 1) % inner.size()];
                const std::uint32_t after = outer[(2 * i + 2) % outer.size()];
                add(outer[2 * i], outer[2 * i + 1], inner[i]);
                add(outer[2 * i + 1], next, inner[i]);
                add(outer[2 * i + 1], after, next);
            }
            outer = inner;
        }
        const std::uint32_t middle = mesh_.add(center);
        for (std::size_t i = 0; i < outer.size(); ++i)
            add(outer[i], outer[(i + 1) % outer.size()], middle);
    }

    Vec3 p0_;
    Vec3 p1_;
    Vec3 u_;
    double rows_ = 1;
    int halvings_ = 0;
    std::uint32_t sides_ = 0;
    std::vector<Vec3> spokes_; ///< from the axis to the rim
    SharedFacets mesh_;
};

/// A tube with plane covers whose corners are those of its rims; none where the ends are one, as
/// the lattice draws none.
ShapeMesh cylinder_mesh(const CylinderLayer& cylinder, const std::array<bool, 3>& is_visible,
                        double dp)
{
    check_size("a cylinder with a radius", cylinder.radius);
    ShapeMesh out;
    const Vec3 u = unit(cylinder.p1 - cylinder.p0);
    const auto level = [p0 = cylinder.p0, u, radius = cylinder.radius](const Vec3& p) -> Level
    {
        const Vec3 away = p - p0 - u * dot(p - p0, u);
        return {norm(away) - radius, unit(away)};
    };
    out.round = std::make_shared<const RoundSurface>(RoundSurface{level, cylinder.radius, u});
    if (norm(cylinder.p1 - cylinder.p0) > 0)
        out.soup =
            CylinderMesher(cylinder.p0, cylinder.p1, cylinder.radius, dp).run(is_visible).soup();
    return out;
}

/// One way for a node to be taken.
struct Piece
{
    int cover = -1; ///< 0, 1: near that end's plane; -1: between the two
    double radius = 0;
    bool is_shell = false; ///< |distance - radius| < width, else distance <= radius
};

/// The distances up to which nodes are taken, metres.
struct Widths
{
    double tube = 0;
    double cover = 0;
};

/// A cylinder or a layer of it with snapped ends, as nodes are tested.
struct Body
{
    Node a_node;
    Node b_node;
    std::vector<Piece> pieces;
    NodeBox box; ///< of all nodes that may be taken; empty for an axis of no length
    Vec3 a;
    Vec3 b;
    Vec3 axis;
    Vec3 u; ///< of length 1
    double length = 0;
    double offset_a = 0;
    double offset_b = 0;
};

void add_faces(const CylinderOp& cylinder, double radius, double dp, std::vector<Piece>& pieces)
{
    if (cylinder.is_visible[2]) pieces.push_back({-1, rounded_radius(radius, dp) * dp, true});
    if (cylinder.is_visible[0]) pieces.push_back({0, radius, false});
    if (cylinder.is_visible[1]) pieces.push_back({1, radius, false});
}

void measure(Body& body, const Widths& widths, const LatticeGrid& grid)
{
    double reach = 0;
    for (const Piece& p : body.pieces)
        reach = std::max(reach, p.radius + (p.is_shell ? widths.tube : 0));
    reach = std::min(reach, 4e9 * grid.dp); // beyond every lattice, and still an index
    body.a = position(body.a_node, grid);
    body.b = position(body.b_node, grid);
    body.axis = body.b - body.a;
    body.length = norm(body.axis);
    if (body.length == 0) return;
    body.u = body.axis / body.length;
    body.offset_a = -dot(body.axis, body.a);
    body.offset_b = -dot(body.axis, body.b);
    for (int k = 0; k < 3; ++k)
    {
        const auto i = static_cast<std::size_t>(k);
        const double u = body.axis[k] / body.length;
        const double side =
            (reach * std::sqrt(std::max(0.0, 1 - u * u)) + widths.cover * std::fabs(u)) /
            grid.step(k);
        const auto steps = static_cast<std::int64_t>(std::ceil(side));
        body.box.begin[i] = std::min(body.a_node[k], body.b_node[k]) - steps - 1;
        body.box.end[i] = std::max(body.a_node[k], body.b_node[k]) + steps + 2;
    }
    body.box = intersect(body.box, whole_lattice(grid));
}

std::vector<Body> bodies_of(const CylinderOp& cylinder, const DrawState& state,
                            const Widths& widths, const LatticeGrid& grid)
{
    std::vector<Body> bodies;
    const auto add = [&](const Vec3& p0, const Vec3& p1) -> Body&
    {
        Body& body = bodies.emplace_back();
        body.a_node = snap(p0, grid);
        body.b_node = snap(p1, grid);
        return body;
    };
    for (const CylinderLayer& layer : cylinder.layers)
        add_faces(cylinder, layer.radius, grid.dp, add(layer.p0, layer.p1).pieces);
    if (cylinder.layers.empty())
    {
        std::vector<Piece>& pieces = add(cylinder.p0, cylinder.p1).pieces;
        if (state.mode != DrawMode::Solid || cylinder.is_masked)
            add_faces(cylinder, cylinder.radius, grid.dp, pieces);
        if (state.mode != DrawMode::Face && !cylinder.is_masked)
            pieces.push_back({-1, cylinder.radius, false});
    }
    for (Body& body : bodies) measure(body, widths, grid);
    return bodies;
}

/// One column of nodes through a cylinder. The values va and vb are those along the axis at its two
/// ends, not divided by its length.
class CylinderColumn
{
public:
    CylinderColumn(const Body& body, const Widths& widths, const LatticeGrid& grid,
                   std::uint32_t slab, std::int64_t iy)
        : body_(body),
          widths_(widths),
          grid_(grid),
          x_(grid.origin.x + slab * grid.step(0)),
          y_(grid.origin.y + static_cast<double>(iy) * grid.step(1)),
          iy_(iy),
          z_min_(body.box.begin[2]),
          z_max_(body.box.end[2] - 1)
    {
        const Vec3& a = body.a;
        const Vec3& u = body.u;
        flat_ = (x_ - a.x) * u.x + (y_ - a.y) * u.y;
        qa_ = 1 - u.z * u.z;
        qb_ = -flat_ * u.z;
        qc_ = (x_ - a.x) * (x_ - a.x) + (y_ - a.y) * (y_ - a.y) - flat_ * flat_;
    }

    void list(const Piece& p, Spans& out) const
    {
        if (is_tie(p))
        {
            for (std::int64_t k = z_min_; k <= z_max_; ++k)
                if (is_taken(p, k)) push(out, iy_, k, k);
            return;
        }
        const Interval t = beside_the_ends(p);
        if (t.is_empty()) return;
        if (!p.is_shell)
        {
            const Interval disc =
                within(p.radius, [&](std::int64_t k) { return distance(k) <= p.radius; });
            push_without(out, iy_, meet(disc, t), {});
            return;
        }
        const Interval outer = within(p.radius + widths_.tube, [&](std::int64_t k)
                                      { return distance(k) - p.radius < widths_.tube; });
        const Interval inner = within(p.radius - widths_.tube, [&](std::int64_t k)
                                      { return !(p.radius - distance(k) < widths_.tube); });
        push_without(out, iy_, meet(outer, t), inner);
    }

private:
    Vec3 at(std::int64_t k) const
    {
        return {x_, y_, grid_.origin.z + static_cast<double>(k) * grid_.step(2)};
    }
    double distance(std::int64_t k) const
    {
        const Vec3 p = at(k);
        return norm(cross(body_.a - p, body_.b - p)) / body_.length;
    }
    double value_a(std::int64_t k) const { return dot(body_.axis, at(k)) + body_.offset_a; }
    double value_b(std::int64_t k) const { return dot(body_.axis, at(k)) + body_.offset_b; }
    bool is_near_a(std::int64_t k) const
    {
        return std::fabs(value_a(k) / body_.length) < widths_.cover;
    }
    bool is_near_b(std::int64_t k) const
    {
        return std::fabs(value_b(k) / body_.length) < widths_.cover;
    }
    bool is_between(std::int64_t k) const { return value_a(k) >= 0 && value_b(k) <= 0; }

    double to_index(double w) const
    {
        const double i = (body_.a.z + w - grid_.origin.z) / grid_.step(2);
        return std::clamp(i, static_cast<double>(z_min_) - 3, static_cast<double>(z_max_) + 3);
    }

    /// Nodes nearer to the axis than `limit`. Estimates: distance^2 = qa w^2 + 2 qb w + qc with w
    /// the height above a, in metres.
    template <typename Holds>
    Interval within(double limit, const Holds& holds) const
    {
        if (limit < 0) return {};
        Interval i{z_min_, z_max_};
        if (qa_ > 1e-12)
        {
            const double root = std::sqrt(std::max(0.0, qb_ * qb_ - qa_ * (qc_ - limit * limit)));
            i.first = static_cast<std::int64_t>(std::floor(to_index((-qb_ - root) / qa_)));
            i.last = static_cast<std::int64_t>(std::ceil(to_index((-qb_ + root) / qa_)));
        }
        else if (!holds(z_min_))
            return {};
        if (!trim_interval(i.first, i.last, z_min_, z_max_, holds)) return {};
        return i;
    }

    /// Nodes from `t_min` to `t_max` along the axis.
    template <typename Holds>
    Interval along(double t_min, double t_max, const Holds& holds) const
    {
        Interval i{z_min_, z_max_};
        if (std::fabs(body_.u.z) > 1e-12)
        {
            const double e0 = to_index((t_min - flat_) / body_.u.z);
            const double e1 = to_index((t_max - flat_) / body_.u.z);
            i.first = static_cast<std::int64_t>(std::floor(std::min(e0, e1)));
            i.last = static_cast<std::int64_t>(std::ceil(std::max(e0, e1)));
        }
        else if (!holds(z_min_))
            return {};
        if (!trim_interval(i.first, i.last, z_min_, z_max_, holds)) return {};
        return i;
    }

    Interval beside_the_ends(const Piece& p) const
    {
        if (p.cover == 0)
            return along(-widths_.cover, widths_.cover,
                         [&](std::int64_t k) { return is_near_a(k); });
        if (p.cover == 1)
            return along(body_.length - widths_.cover, body_.length + widths_.cover,
                         [&](std::int64_t k) { return is_near_b(k); });
        return along(0, body_.length, [&](std::int64_t k) { return is_between(k); });
    }

    /// Upright axes: the distance is the same all along the column but for rounding. Within
    /// rounding of a limit, nodes are asked one by one; else the first stands for all.
    bool is_tie(const Piece& p) const
    {
        if (qa_ > 1e-12) return false;
        const double d = distance(z_min_);
        const double gap = p.is_shell ? std::fabs(std::fabs(d - p.radius) - widths_.tube)
                                      : std::fabs(d - p.radius);
        return gap < 1e-6 * grid_.dp;
    }

    bool is_taken(const Piece& p, std::int64_t k) const
    {
        if (!(p.cover == 0 ? is_near_a(k) : p.cover == 1 ? is_near_b(k) : is_between(k)))
            return false;
        return p.is_shell ? std::fabs(distance(k) - p.radius) < widths_.tube
                          : distance(k) <= p.radius;
    }

    const Body& body_;
    const Widths& widths_;
    const LatticeGrid& grid_;
    double x_;
    double y_;
    std::int64_t iy_;
    std::int64_t z_min_;
    std::int64_t z_max_;
    double flat_ = 0;
    double qa_ = 0;
    double qb_ = 0;
    double qc_ = 0;
};

void add_cells_of(const CylinderLayer& cylinder, const std::array<bool, 3>& is_visible,
                  CellList& out)
{
    const ShapeContext& context = out.context;
    const Vec3 a = context.place(cylinder.p0);
    const Vec3 b = context.place(cylinder.p1);
    if (norm(b - a) == 0) return;
    const DrawConstants& constants = context.state.constants;
    const double more = context.snapped ? constants.cylinder_tube * context.grid.dp : 0;
    const auto [near, far] = cylinder_rings(a, b, cylinder.radius + more, constants.cylinder_sides);
    const std::size_t n = near.size();
    for (std::size_t i = 0; is_visible[0] && i < n; ++i)
        out.add_round_face({near[i], near[(i + 1) % n], a});
    for (std::size_t i = 0; is_visible[1] && i < n; ++i)
        out.add_round_face({far[i], b, far[(i + 1) % n]});
    for (std::size_t i = 0; is_visible[2] && i < n; ++i)
    {
        const std::size_t j = (i + 1) % n;
        out.add_round_face({near[j], near[i], far[i], far[j]});
    }
}

} // namespace

Box3 bounds_of(const CylinderOp& cylinder, double)
{
    Box3 box;
    const Vec3 along = cylinder.p1 - cylinder.p0;
    const double length = norm(along);
    if (!(length > 0)) return box;
    double r = cylinder.radius;
    for (const CylinderLayer& layer : cylinder.layers) r = std::max(r, layer.radius);
    Vec3 half;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double u = along[axis] / length;
        half[axis] = r * std::sqrt(std::max(0.0, 1 - u * u));
    }
    add_ball(box, cylinder.p0, half);
    add_ball(box, cylinder.p1, half);
    return box;
}

bool is_body(const CylinderOp& cylinder, DrawMode)
{
    return cylinder.layers.empty();
}

std::vector<ShapeMesh> surfaces_of(const CylinderOp& cylinder, const ShapeContext& context)
{
    std::vector<ShapeMesh> out;
    if (context.is_wire()) return out;
    for (const CylinderLayer& layer : cylinder.layers)
        out.push_back(cylinder_mesh(layer, cylinder.is_visible, context.grid.dp));
    if (!out.empty()) return out;
    out.push_back(cylinder_mesh({cylinder.p0, cylinder.p1, cylinder.radius}, cylinder.is_visible,
                                context.grid.dp));
    out.back().is_solid = context.may_fill() && !cylinder.is_masked;
    return out;
}

SlabRegion nodes_of(const CylinderOp& cylinder, const DrawState& state, const LatticeGrid& grid)
{
    const Widths widths{state.constants.cylinder_tube * grid.dp,
                        state.constants.cylinder_cover * grid.dp};
    const std::vector<Body> bodies = bodies_of(cylinder, state, widths, grid);
    NodeBox all{{INT64_MAX, INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN, INT64_MIN}};
    for (const Body& body : bodies)
        for (std::size_t i = 0; i < 3 && !body.box.is_empty(); ++i)
        {
            all.begin[i] = std::min(all.begin[i], body.box.begin[i]);
            all.end[i] = std::max(all.end[i], body.box.end[i]);
        }
    SlabRegion region = slabs_of(all);
    region.emit = [=](std::uint32_t slab, Spans& out)
    {
        for (const Body& body : bodies)
        {
            const NodeBox& box = body.box;
            if (box.is_empty() || slab < box.begin[0] || slab >= box.end[0]) continue;
            for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
            {
                const CylinderColumn nodes(body, widths, grid, slab, y);
                for (const Piece& p : body.pieces) nodes.list(p, out);
            }
        }
    };
    return region;
}

void add_cells(const CylinderOp& cylinder, CellList& out)
{
    for (const CylinderLayer& layer : cylinder.layers)
        if (layer.is_shown) add_cells_of(layer, cylinder.is_visible, out);
    if (cylinder.layers.empty())
        add_cells_of({cylinder.p0, cylinder.p1, cylinder.radius}, cylinder.is_visible, out);
}

std::optional<ExactBody> body_of(const CylinderOp& cylinder, const ShapeContext&,
                                 std::string& why_not)
{
    const Vec3 along = cylinder.p1 - cylinder.p0;
    const double length = norm(along);
    const double r = cylinder.radius;
    if (!cylinder.layers.empty() || cylinder.is_masked)
        why_not = "it is drawn by layers or a part of a closed shape only";
    else if (!(length > 0))
        why_not = "its cylinder has no length";
    else
    {
        ExactBody body;
        body.volume = std::numbers::pi * r * r * length;
        body.center = (cylinder.p0 + cylinder.p1) * 0.5;
        body.inertia = inertia_around(along / length, body.volume * r * r / 2,
                                      body.volume * (3 * r * r + length * length) / 12);
        return body;
    }
    return std::nullopt;
}

} // namespace fppg::kinds
