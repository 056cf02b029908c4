#include "scene/near_domain.h"

#include "fppg/moving_parts.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace fppg
{
namespace
{

/// Hardly beyond a plane of nodes, so that nodes go on a step behind the cut, as the volume asks,
/// and not quite on it, where faces of meshes lie.
constexpr double far_dp = 12.001;

/// Radius, in dp and over that of the ball around the domain, from which on a ball has coarse
/// facets beyond the domain: most of it is cut off then (walls/part_in_domain.h).
constexpr double large_ball_dp = 1500;
constexpr double ball_over_box = 20;

/// The part of a line, from 0 to `length` along it, whose planes across it meet a box.
std::array<double, 2> part_beside(const Box3& box, const Vec3& from, const Vec3& along,
                                  double length)
{
    double low = length;
    double high = 0;
    for (int corner = 0; corner < 8; ++corner)
    {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
        const double at = dot(p - from, along);
        low = std::min(low, at);
        high = std::max(high, at);
    }
    return {std::clamp(low, 0.0, length), std::clamp(high, 0.0, length)};
}

/// Ends a cylinder or a layer of one beside a box, where most of it is beyond; returns whether it
/// did.
template <typename Cylinder>
bool end_beside(Cylinder& cylinder, const Box3& box, double dp)
{
    const double length = norm(cylinder.p1 - cylinder.p0);
    const Vec3 along = (cylinder.p1 - cylinder.p0) / length;
    auto [low, high] = part_beside(box, cylinder.p0, along, length);
    // Of one that is wholly beyond a step is left, as beyond as the rest.
    if (high - low < dp) (low > 0 ? low : high) += low > 0 ? -dp : dp;
    const double beyond = length - (high - low);
    if (!(beyond > times_beyond_of_round * (high - low)) ||
        !(2 * std::numbers::pi * cylinder.radius * beyond > least_beyond_dp2 * dp * dp))
        return false;
    const Vec3 from = cylinder.p0;
    cylinder.p0 = from + low * along;
    cylinder.p1 = from + high * along;
    return true;
}

} // namespace

Box3 box_near_domain(const LatticeGrid& grid)
{
    return box_around(grid, far_dp);
}

Box3 box_around(const LatticeGrid& grid, double margin_dp)
{
    const double margin = margin_dp * grid.dp;
    const Vec3 last{grid.n[0] - 1.0, grid.n[1] - 1.0, grid.n[2] - 1.0};
    return {grid.origin - Vec3{margin, margin, margin},
            grid.place(last) + Vec3{margin, margin, margin}};
}

bool is_laid_whole(const CaseDef& def, std::uint16_t mk)
{
    const FitSettings* settings = fit_settings(def.fit, mk);
    return (settings != nullptr && settings->place == Placement::Inside) || floats(def, mk);
}

std::optional<DrawOp> made_near_domain(const DrawOp& draw, const CaseDef& def)
{
    const LatticeGrid& grid = def.grid;
    if (grid.is_2d || is_laid_whole(def, draw.state->mk.mk)) return std::nullopt;
    const Box3 box = box_near_domain(grid);
    DrawOp out = draw;
    if (const auto* cylinder = shape_as<CylinderOp>(draw))
    {
        CylinderOp shorter = *cylinder;
        bool is_shorter = shorter.layers.empty() && end_beside(shorter, box, grid.dp);
        for (CylinderLayer& layer : shorter.layers)
            is_shorter = end_beside(layer, box, grid.dp) || is_shorter;
        if (!is_shorter) return std::nullopt;
        out.what = Shape(std::move(shorter));
        return out;
    }
    if (const auto* sphere = shape_as<SphereOp>(draw))
    {
        double radius = sphere->radius;
        for (const double layer : sphere->layers_dp)
            radius = std::min(radius, sphere->radius + layer * grid.dp);
        if (!(radius > large_ball_dp * grid.dp) ||
            !(radius > ball_over_box * 0.5 * norm(box.max - box.min)))
            return std::nullopt;
        SphereOp coarse = *sphere;
        coarse.near = box;
        out.what = Shape(std::move(coarse));
        return out;
    }
    return std::nullopt;
}

} // namespace fppg
