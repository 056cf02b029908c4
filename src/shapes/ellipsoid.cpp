#include "meshes/round_surface.h"
#include "shapes/kinds.h"
#include "shapes/round_columns.h"
#include "shapes/round_facets.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace fppg::kinds
{
namespace
{

/// The points whose distances to two foci sum to `sum`: a geodesic sphere, stretched. A tip more
/// slender than 1 : 30 may keep edges that count as sharp.
///
/// returns  no facet if `sum` is not above the distance of the foci: nothing lies inside
ShapeMesh ellipsoid_mesh(const Vec3& focus0, const Vec3& focus1, double sum, double dp)
{
    check_size("an ellipsoid with a sum of distances", sum);
    ShapeMesh out;
    const auto level = [focus0, focus1, sum](const Vec3& p) -> Level {
        return {norm(p - focus0) + norm(p - focus1) - sum, unit(p - focus0) + unit(p - focus1)};
    };
    out.round = std::make_shared<const RoundSurface>(RoundSurface{level, sum, {}, false});
    const double apart = norm(focus1 - focus0);
    const double along = 0.5 * sum;
    const double side = 0.5 * std::sqrt(std::max(0.0, (sum - apart) * (sum + apart)));
    if (!(side > 0)) return out;
    // A facet's depth is stretched by no more than the half axis; edges of the tips are sharper
    // than those of the sphere by the ratio of the axes.
    const double parts =
        std::max({5.0, parts_for_chord(along / dp), std::ceil(std::min(5 * along / side, 150.0))});
    check_facets(20 * parts * parts);
    SharedFacets mesh = geodesic_sphere(static_cast<std::uint32_t>(parts));
    const Vec3 u = apart > 0 ? (focus1 - focus0) / apart : Vec3{0, 0, 1};
    const auto [v, w] = across(u);
    const Vec3 center = (focus0 + focus1) * 0.5;
    // Between the sphere's z, x, y and the axes u, v, w nothing is mirrored.
    for (Vec3& p : mesh.vertices)
        p = center + u * (along * p.z) + v * (side * p.x) + w * (side * p.y);
    out.soup = mesh.soup();
    return out;
}

/// One column of nodes beside the foci. The sum of the distances, in dp, is convex in z: its least
/// node splits the column into two monotone halves.
class FociColumn
{
public:
    FociColumn(const std::array<Node, 2>& foci, const NodeBox& box, const Vec3& stretch,
               std::uint32_t x, std::int64_t y)
        : foci_(foci), stretch_(stretch), x_(x), y_(y), begin_(box.begin[2]), end_(box.end[2])
    {
        std::int64_t low = begin_;
        std::int64_t high = end_ - 1;
        while (high - low > 2)
        {
            const std::int64_t m = low + (high - low) / 2;
            if (sum(m) <= sum(m + 1))
                high = m + 1;
            else
                low = m;
        }
        best_ = low;
        for (std::int64_t z = low; z <= high; ++z)
            if (sum(z) < sum(best_)) best_ = z;
    }

    double sum(std::int64_t z) const
    {
        const auto distance = [&](const Node& f)
        {
            const double dx = static_cast<double>(x_ - f.x) * stretch_.x;
            const double dy = static_cast<double>(y_ - f.y) * stretch_.y;
            const double dz = static_cast<double>(z - f.z) * stretch_.z;
            return std::sqrt(dx * dx + dy * dy + dz * dz);
        };
        return distance(foci_[0]) + distance(foci_[1]);
    }

    /// The nodes that hold; they are an interval around the one of the least sum.
    template <typename Holds>
    Interval widest(const Holds& holds) const
    {
        if (!holds(best_)) return {};
        std::int64_t below = begin_ - 1;
        std::int64_t first = best_;
        while (first - below > 1)
        {
            const std::int64_t m = below + (first - below) / 2;
            holds(m) ? first = m : below = m;
        }
        std::int64_t above = end_;
        std::int64_t last = best_;
        while (above - last > 1)
        {
            const std::int64_t m = last + (above - last) / 2;
            holds(m) ? last = m : above = m;
        }
        return {first, last};
    }

private:
    std::array<Node, 2> foci_;
    Vec3 stretch_;
    std::int64_t x_;
    std::int64_t y_;
    std::int64_t begin_;
    std::int64_t end_;
    std::int64_t best_ = 0;
};

} // namespace

Box3 bounds_of(const EllipsoidOp& ellipsoid, double)
{
    Box3 box;
    const Vec3 along = ellipsoid.focus1 - ellipsoid.focus0;
    const double a = ellipsoid.radius / 2;
    const double c = norm(along) / 2;
    if (!(a > c)) return box;
    Vec3 half;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double u = c > 0 ? along[axis] / (2 * c) : 0;
        half[axis] = std::sqrt(a * a - c * c * (1 - u * u));
    }
    add_ball(box, (ellipsoid.focus0 + ellipsoid.focus1) * 0.5, half);
    return box;
}

bool is_body(const EllipsoidOp&, DrawMode)
{
    return true;
}

std::vector<ShapeMesh> surfaces_of(const EllipsoidOp& ellipsoid, const ShapeContext& context)
{
    if (context.is_wire()) return {};
    ShapeMesh mesh =
        ellipsoid_mesh(ellipsoid.focus0, ellipsoid.focus1, ellipsoid.radius, context.grid.dp);
    mesh.is_solid = context.may_fill();
    return {std::move(mesh)};
}

SlabRegion nodes_of(const EllipsoidOp& ellipsoid, const DrawState& state, const LatticeGrid& grid)
{
    const Node f0 = snap(ellipsoid.focus0, grid);
    const Node f1 = snap(ellipsoid.focus1, grid);
    const double s0 = rounded_radius(ellipsoid.radius, grid.dp);
    const double width = state.constants.sphere;
    const double outer_limit =
        state.mode == DrawMode::Solid ? ellipsoid.radius / grid.dp : s0 + width;
    const bool is_open = state.mode != DrawMode::Solid;
    const double inner_limit = state.mode == DrawMode::Face ? s0 - width : -1;
    const double steps = outer_limit * grid.dp / grid.least_step();
    const auto reach = static_cast<std::int64_t>(std::ceil(std::min(steps, 4e9)));
    const NodeBox box = intersect(around(f0, reach, grid), around(f1, reach, grid));
    SlabRegion region = slabs_of(box);
    region.emit = [=](std::uint32_t x, Spans& out)
    {
        for (std::int64_t y = box.begin[1]; y < box.end[1]; ++y)
        {
            const FociColumn nodes({f0, f1}, box, grid.stretch, x, y);
            const Interval outer = nodes.widest(
                [&](std::int64_t z)
                { return is_open ? nodes.sum(z) < outer_limit : nodes.sum(z) <= outer_limit; });
            const Interval inner =
                inner_limit < 0
                    ? Interval{}
                    : nodes.widest([&](std::int64_t z) { return nodes.sum(z) <= inner_limit; });
            push_without(out, y, outer, inner);
        }
    };
    return region;
}

std::optional<ExactBody> body_of(const EllipsoidOp& ellipsoid, const ShapeContext&,
                                 std::string& why_not)
{
    const Vec3 along = ellipsoid.focus1 - ellipsoid.focus0;
    const double a = ellipsoid.radius / 2;
    const double c = norm(along) / 2;
    const double b2 = a * a - c * c;
    if (!(b2 > 0))
    {
        why_not = "its ellipsoid has no volume";
        return std::nullopt;
    }
    ExactBody body;
    body.volume = 4.0 / 3 * std::numbers::pi * a * b2;
    body.center = (ellipsoid.focus0 + ellipsoid.focus1) * 0.5;
    body.inertia = inertia_around(c > 0 ? along / (2 * c) : Vec3{1, 0, 0}, body.volume * 0.4 * b2,
                                  body.volume * 0.2 * (a * a + b2));
    return body;
}

} // namespace fppg::kinds
