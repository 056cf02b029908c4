#include "walls/fluid_ends.h"

#include "fppg/draw_ops.h"
#include "fppg/error.h"

#include "walls/step_surfaces.h"
#include "walls/thickened.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

/// Places nearer than this are one, dp.
constexpr double same_place = 1e-6;
/// Lattices are moved to the walls of one side, and may be stretched to those of the other.
constexpr double same_row = 0.3;

/// A range along an axis, metres.
using Range = std::array<double, 2>;

/// From one node of an axis to another; nothing where the last comes before the first.
std::optional<Range> range_of_nodes(double first, double last, int axis, const LatticeGrid& grid)
{
    if (last < first) return std::nullopt;
    return Range{grid.origin[axis] + first * grid.step(axis),
                 grid.origin[axis] + last * grid.step(axis)};
}

/// The outermost nodes of the lattice within [low, high] along an axis.
std::optional<Range> nodes_within(double low, double high, int axis, const LatticeGrid& grid)
{
    return range_of_nodes(std::ceil((low - grid.origin[axis]) / grid.step(axis) - same_place),
                          std::floor((high - grid.origin[axis]) / grid.step(axis) + same_place),
                          axis, grid);
}

/// Rows of fluid beside flat walls on a lattice that was moved to these.
class FirstRows
{
public:
    /// reach  of a row, steps
    FirstRows(WetPlanesOfAxes planes, const LatticeGrid& grid, double reach)
        : planes_(std::move(planes)), grid_(grid), reach_(reach)
    {
    }

    /// nodes_within(), with the row beside a wall where an end is nearer to it than the reach.
    std::optional<Range> nodes_within(double low, double high, int axis) const
    {
        std::optional<Range> nodes = fppg::nodes_within(low, high, axis, grid_);
        if (!nodes) return nodes;
        const double step = grid_.step(axis);
        const auto [first, last] = *nodes;
        if (low - (first - step) < reach_ * step && is_row(first - step, 1, axis))
            (*nodes)[0] -= step;
        if (last + step - high < reach_ * step && is_row(last + step, -1, axis))
            (*nodes)[1] += step;
        return nodes;
    }

private:
    /// side  where fluid is, seen from the wall
    bool is_row(double at, int side, int axis) const
    {
        const auto& planes = planes_[static_cast<std::size_t>(axis)];
        return std::any_of(planes.begin(), planes.end(),
                           [&](const WetPlane& plane)
                           {
                               const double row = plane.at + side * (grid_.dp - plane.depth);
                               return (plane.side == side || plane.side == 0) &&
                                      std::abs(at - row) < same_row * grid_.dp;
                           });
    }

    WetPlanesOfAxes planes_;
    const LatticeGrid& grid_;
    double reach_;
};

/// The outermost nodes between the nodes that the ends of a body are rounded to, as solid mode
/// draws it.
std::optional<Range> nodes_inside(double low, double high, int axis, const LatticeGrid& grid)
{
    return range_of_nodes(std::floor((low - grid.origin[axis]) / grid.step(axis) + 0.5) + 1,
                          std::floor((high - grid.origin[axis]) / grid.step(axis) + 0.5) - 1, axis,
                          grid);
}

/// The limits of a fill, which takes the nodes strictly inside its snapped box.
///
/// grown  metres by which setboxlimitmode full has moved them out
void fit_limits(BoxRegion& box, double grown, int axis, const LatticeGrid& grid)
{
    double& low = box.corner0[axis] <= box.corner1[axis] ? box.corner0[axis] : box.corner1[axis];
    double& high = &low == &box.corner0[axis] ? box.corner1[axis] : box.corner0[axis];
    const std::optional<Range> nodes = nodes_within(low + grown, high - grown, axis, grid);
    if (!nodes) return;
    low = (*nodes)[0] - grid.step(axis);
    high = (*nodes)[1] + grid.step(axis);
}

/// The polyhedron that is drawn with this kind of mk; null: none.
PolyhedronOp* polyhedron_of(MkKind kind, DrawOp& op)
{
    if (op.state->mk.kind != kind || op.state->mode == DrawMode::Wire || op.state->off_lattice)
        return nullptr;
    auto* shape = std::get_if<Shape>(&op.what);
    return shape != nullptr ? std::get_if<PolyhedronOp>(shape) : nullptr;
}

/// The same where it is filled.
PolyhedronOp* body_of(MkKind kind, DrawOp& op)
{
    PolyhedronOp* body = polyhedron_of(kind, op);
    return body != nullptr && body->solid != SolidKind::None ? body : nullptr;
}

/// Where a body begins and ends along an axis.
Range extent_of(const PolyhedronOp& body, int axis)
{
    Range out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Vec3& v : body.vertices)
        out = {std::min(out[0], v[axis]), std::max(out[1], v[axis])};
    return out;
}

/// Moves the ends of a body along an axis to these nodes of it; to none where there are none.
///
/// may_move  bool(double): whether an end at this place moves
template <typename MayMove>
void fit_ends(PolyhedronOp& body, int axis, const std::optional<Range>& nodes,
              const LatticeGrid& grid, const MayMove& may_move)
{
    if (!nodes) return;
    const auto [low, high] = extent_of(body, axis);
    const bool moves_low = may_move(low);
    const bool moves_high = may_move(high);
    for (Vec3& v : body.vertices)
    {
        if (moves_low && v[axis] < low + same_place * grid.dp) v[axis] = (*nodes)[0];
        if (moves_high && v[axis] > high - same_place * grid.dp) v[axis] = (*nodes)[1];
    }
}

/// Lets a body end at the outermost nodes in it along the axes whose nodes were moved. One that
/// solid mode draws without its surface nodes is then drawn with them, as its ends lie between
/// nodes and none of those in it are on its surface.
///
/// rows  of fluid beside walls; those of a void have none
void end_body(PolyhedronOp& body, const std::array<bool, 3>& is_moved, const LatticeGrid& grid,
              const FirstRows& rows, DrawOp& op)
{
    const bool is_solid_mode = op.state->mode == DrawMode::Solid;
    for (int axis = 0; axis < 3; ++axis)
    {
        const bool moves = is_moved[static_cast<std::size_t>(axis)];
        if (!moves && (!is_solid_mode || (axis == 1 && grid.is_2d))) continue;
        const auto [low, high] = extent_of(body, axis);
        fit_ends(body, axis,
                 moves ? rows.nodes_within(low, high, axis) : nodes_inside(low, high, axis, grid),
                 grid, [](double) { return true; });
    }
    if (!is_solid_mode) return;
    auto state = std::make_shared<DrawState>(*op.state);
    state->mode = DrawMode::Full;
    op.state = std::move(state);
}

using Planes = std::array<std::vector<double>, 3>;

void add_planes(const TriangleSoup& soup, Planes& planes)
{
    const std::vector<Vec3>& v = soup.vertices;
    for (std::size_t i = 0; i + 2 < v.size(); i += 3)
    {
        const Vec3 across = cross(v[i + 1] - v[i], v[i + 2] - v[i]);
        for (int axis = 0; axis < 3; ++axis)
            if (lies_across(across, axis))
                planes[static_cast<std::size_t>(axis)].push_back(v[i][axis]);
    }
}

/// Where the fitted walls of a case have facets across the axes, sorted.
Planes planes_of_walls(const Scene& scene, int threads)
{
    Planes out;
    for (const SceneStep& step : scene.remaining())
    {
        if (!draws_bound(step) || fit_settings(scene.def->fit, step.draw->state->mk.mk) == nullptr)
            continue;
        for (const StepSurface& surface : fitted_surfaces(scene, step, threads))
            add_planes(surface.shape.soup, out);
    }
    for (std::vector<double>& places : out)
    {
        std::sort(places.begin(), places.end());
        places.erase(std::unique(places.begin(), places.end()), places.end());
    }
    return out;
}

} // namespace

void end_fluid_between_nodes(const std::array<bool, 3>& is_moved, const WetPlanesOfAxes& planes,
                             CaseDef& def)
{
    constexpr double half = 0.5;
    const FirstRows rows(planes, def.grid, half);
    // Inlets are mostly drawn from the node beside a wall on, as a lattice that is not moved has
    // it: exactly half a step off the row. Fluid that is missing there is added later, particles of
    // inlets are not.
    const FirstRows rows_of_inlets(planes, def.grid, half + same_place);
    const FirstRows none({}, def.grid, half);
    for (DrawOp& op : def.ops)
    {
        const bool is_inlet = def.solver.inout.fluids.contains(op.state->mk.mk);
        if (PolyhedronOp* body =
                is_inlet ? polyhedron_of(MkKind::Fluid, op) : body_of(MkKind::Fluid, op))
            end_body(*body, is_moved, def.grid, is_inlet ? rows_of_inlets : rows, op);
        if (PolyhedronOp* body = body_of(MkKind::Void, op))
            end_body(*body, is_moved, def.grid, none, op);
        auto* edit = std::get_if<Edit>(&op.what);
        auto* fill = edit != nullptr ? std::get_if<FillOp>(edit) : nullptr;
        if (fill == nullptr || !fill->region || op.state->mk.kind != MkKind::Fluid) continue;
        auto* box = std::get_if<BoxRegion>(&*fill->region);
        for (int axis = 0; axis < 3; ++axis)
            if (box != nullptr && is_moved[static_cast<std::size_t>(axis)])
                fit_limits(*box, op.state->box_limit_full ? def.grid.dp : 0, axis, def.grid);
    }
}

void end_fluid_at_walls(const Scene& scene, int threads, CaseDef& def)
{
    if (def.fit.is_empty() ||
        std::none_of(def.ops.begin(), def.ops.end(),
                     [](DrawOp& op) { return body_of(MkKind::Fluid, op) != nullptr; }))
        return;
    Planes planes;
    try
    {
        planes = planes_of_walls(scene, threads);
    }
    catch (const Error&)
    {
        return; // drawing the walls says what is wrong
    }
    const double room = same_place * def.grid.dp;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (axis == 1 && def.grid.is_2d) continue;
        const std::vector<double>& places = planes[static_cast<std::size_t>(axis)];
        const auto is_at_wall = [&](double end)
        {
            const auto next = std::lower_bound(places.begin(), places.end(), end - room);
            return next != places.end() && *next <= end + room;
        };
        for (DrawOp& op : def.ops)
            if (PolyhedronOp* body = body_of(MkKind::Fluid, op))
            {
                const auto [low, high] = extent_of(*body, axis);
                fit_ends(*body, axis, nodes_within(low, high, axis, def.grid), def.grid,
                         is_at_wall);
            }
    }
}

} // namespace fppg
