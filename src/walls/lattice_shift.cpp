#include "walls/lattice_shift.h"

#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/moving_parts.h"

#include "core/parallel.h"
#include "nodes/run_at.h"
#include "nodes/snap.h"
#include "nodes/spans.h"
#include "walls/fluid_ends.h"
#include "walls/lattice_stretch.h"
#include "walls/step_surfaces.h"
#include "walls/thickened.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace fppg
{
namespace
{

/// Facets are judged in pieces of about this length, dp; a side in this many at most.
constexpr double piece_dp = 4;
constexpr int most_pieces = 200;
/// Where fluid is looked for off a facet, dp.
constexpr std::array<double, 2> looks_dp{1.0, 2.0};
/// What is nearer than a bin of dp counts as one place.
constexpr std::size_t bins = 100;
constexpr double rounding = 1e-6;

/// Area of walls beside fluid, by the place of their planes within a step of the lattice, 0 to 1.
class WallPlaces
{
public:
    void add(double place, double wet)
    {
        // Round places are in the middles of bins.
        const double at = place * bins + 0.5;
        const double bin = std::floor(at);
        const auto b = static_cast<std::size_t>(bin) % bins;
        area_[b] += wet;
        off_[b] += wet * (at - bin - 0.5);
    }

    /// The place of the most area; nothing without any. Of two with as much, as of walls that face
    /// each other, the first from half a step on.
    std::optional<double> most() const
    {
        std::size_t best = bins / 2;
        for (std::size_t k = 1; k < bins; ++k)
            if (const std::size_t b = (bins / 2 + k) % bins;
                area_[b] > area_[best] * (1 + rounding))
                best = b;
        if (!(area_[best] > 0)) return std::nullopt;
        return (static_cast<double>(best) + off_[best] / area_[best]) / bins;
    }

private:
    std::array<double, bins> area_{};
    std::array<double, bins> off_{}; ///< times area, in bins from the middle
};

/// How far behind the surface the first particles of the fitted wall that a step draws are, dp;
/// nothing of other steps, and of what floats, which goes to its own place.
std::optional<double> depth_of_wall(const SceneStep& step, const CaseDef& def)
{
    const MkValue& mk = step.draw->state->mk;
    if (mk.kind != MkKind::Bound || floats(def, mk.mk)) return std::nullopt;
    const FitSettings* settings = fit_settings(def.fit, mk.mk);
    if (settings == nullptr) return std::nullopt;
    return settings->depths_dp.empty() ? 0.0 : settings->depths_dp[0];
}

bool relaxes_fluid(const CaseDef& def)
{
    for (std::uint16_t mk = 0; mk < def.mk_bound_first; ++mk)
        if (const FluidBand* band = fluid_band(def, mk); band != nullptr && band->is_active)
            return true;
    return false;
}

/// Whether a step leaves boundary particles on the lattice.
bool bounds_lattice(const SceneStep& step, const FitDef& fit)
{
    const DrawState& state = *step.draw->state;
    if (state.mk.kind == MkKind::Bound && step.edit() != nullptr) return true;
    if (!draws_bound(step)) return false;
    return fit_settings(fit, state.mk.mk) == nullptr ||
           (!step.combination && state.mode == DrawMode::Wire);
}

/// Whether particles that are points of zones go in or out along an axis: their plane stays.
bool is_way_in(const InOutZones& inout, int axis)
{
    return std::any_of(inout.fluids.begin(), inout.fluids.end(),
                       [axis](const auto& of) { return of.second.way[axis] != 0; });
}

/// Whether zones let fluid in along axes through particles of the lattice, which move with it; the
/// points of the others stay where they are.
bool move_along(const InOutZones& inout)
{
    return inout.shapes.empty() && std::all_of(inout.fluids.begin(), inout.fluids.end(),
                                               [](const auto& of)
                                               {
                                                   const Vec3& way = of.second.way;
                                                   return way.x * way.y == 0 &&
                                                          way.y * way.z == 0 &&
                                                          way.z * way.x == 0 && way != Vec3{};
                                               });
}

bool may_move(const Scene& scene)
{
    const CaseDef& def = *scene.def;
    if (def.fit.is_empty() || def.vres.is_active() || !move_along(def.solver.inout) ||
        !relaxes_fluid(def))
        return false;
    const auto remaining = scene.remaining();
    return std::none_of(remaining.begin(), remaining.end(),
                        [&](const SceneStep& step) { return bounds_lattice(step, def.fit); }) &&
           std::any_of(remaining.begin(), remaining.end(),
                       [&](const SceneStep& step) { return depth_of_wall(step, def).has_value(); });
}

class WetPlanes
{
public:
    WetPlanes(const RunField& field, std::uint16_t first_bound)
        : field_(field), first_bound_(first_bound)
    {
    }

    /// depth  of the first particles behind the surface, dp
    void add(const ShapeMesh& shape, double depth)
    {
        const std::vector<Vec3>& v = shape.soup.vertices;
        for (std::size_t i = 0; i + 2 < v.size(); i += 3)
        {
            const Vec3 across = cross(v[i + 1] - v[i], v[i + 2] - v[i]);
            const double size = norm(across);
            for (int axis = 0; axis < 3; ++axis)
            {
                if (!lies_across(across, axis)) continue;
                // Depths are whole and half steps, which lie alike on both sides.
                const double at =
                    (v[i][axis] - field_.grid.origin[axis]) / field_.grid.step(axis) + depth;
                const WetShares wet =
                    wet_shares({v[i], v[i + 1], v[i + 2]}, across / size, !shape.is_solid);
                const auto a = static_cast<std::size_t>(axis);
                const double area = size / 2;
                places_[a].add(at - std::floor(at), wet.either * area);
                const int side = across[axis] > 0 ? 1 : -1;
                if (wet.either > 0)
                    planes_[a].push_back({v[i][axis], depth * field_.grid.dp, wet.either * area,
                                          wet.back == 0    ? side
                                          : wet.front == 0 ? -side
                                                           : 0});
            }
        }
    }

    const WallPlaces& of(int axis) const { return places_[static_cast<std::size_t>(axis)]; }
    const std::array<std::vector<WetPlane>, 3>& planes() const { return planes_; }

private:
    bool is_fluid(const Vec3& p) const { return has_fluid_near(field_, p, first_bound_); }

    /// How much of a facet has fluid before it, and behind it where it is a sheet.
    struct WetShares
    {
        double front = 0;
        double back = 0;
        double either = 0;
    };

    WetShares wet_shares(const std::array<Vec3, 3>& corners, const Vec3& normal,
                         bool is_sheet) const
    {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, norm(corners[(k + 1) % 3] - corners[k]));
        const int parts = static_cast<int>(std::clamp(longest / (piece_dp * field_.grid.dp), 1.0,
                                                      static_cast<double>(most_pieces)));
        int front = 0;
        int back = 0;
        int either = 0;
        int all = 0;
        for (int a = 0; a < parts; ++a)
            for (int b = 0; a + b < parts; ++b)
            {
                const double s = (a + 1.0 / 3) / parts;
                const double t = (b + 1.0 / 3) / parts;
                const Vec3 p =
                    corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
                ++all;
                const auto is_wet = [&](double sense)
                {
                    return std::any_of(
                        looks_dp.begin(), looks_dp.end(),
                        [&](double look)
                        { return is_fluid(p + (sense * look * field_.grid.dp) * normal); });
                };
                const bool is_front_wet = is_wet(1);
                const bool is_back_wet = is_sheet && is_wet(-1);
                front += is_front_wet ? 1 : 0;
                back += is_back_wet ? 1 : 0;
                either += is_front_wet || is_back_wet ? 1 : 0;
            }
        const auto share = [all](int wet) { return static_cast<double>(wet) / all; };
        return {share(front), share(back), share(either)};
    }

    const RunField& field_;
    std::uint16_t first_bound_;
    std::array<WallPlaces, 3> places_;
    std::array<std::vector<WetPlane>, 3> planes_;
};

/// Nodes [begin, end) along an axis.
struct NodeRange
{
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// Of each node along an axis of a lattice, those of another that are dp or less from it.
std::vector<NodeRange> ranges_beside(int axis, const LatticeGrid& grid, const LatticeGrid& other)
{
    const auto a = static_cast<std::size_t>(axis);
    std::vector<NodeRange> out;
    for (std::uint32_t k = 0; k < grid.n[a]; ++k)
    {
        const double at = grid.origin[axis] + k * grid.step(axis) - other.origin[axis];
        const double first = std::ceil((at - grid.dp) / other.step(axis) - rounding);
        const double last = std::floor((at + grid.dp) / other.step(axis) + rounding);
        out.push_back({std::max(to_index(first), std::int64_t{0}),
                       std::min(to_index(last) + 1, std::int64_t{other.n[a]})});
    }
    return out;
}

/// The nodes of a lattice that are dp or less from nodes of another along each axis; no slabs where
/// there are none.
///
/// nodes  of `grid`
SpanSet nodes_beside(const SpanSet& nodes, const LatticeGrid& grid, const LatticeGrid& other,
                     int threads)
{
    SpanSet out;
    if (std::all_of(nodes.slabs.begin(), nodes.slabs.end(),
                    [](const Spans& s) { return s.empty(); }))
        return out;
    const std::vector<NodeRange> slabs = ranges_beside(0, other, grid);
    const std::vector<NodeRange> rows = ranges_beside(1, grid, other);
    const std::vector<NodeRange> heights = ranges_beside(2, grid, other);
    out.slabs.resize(other.n[0]);
    parallel_for(
        out.slabs.size(), threads,
        [&](std::size_t slab)
        {
            Spans& found = out.slabs[slab];
            const auto known = static_cast<std::int64_t>(nodes.slabs.size());
            for (std::int64_t k = slabs[slab].begin; k < std::min(slabs[slab].end, known); ++k)
                for (const Span& s : nodes.slabs[static_cast<std::size_t>(k)])
                    for (std::int64_t y = rows[s.y].begin; y < rows[s.y].end; ++y)
                        found.push_back({static_cast<std::uint32_t>(y),
                                         static_cast<std::uint32_t>(heights[s.z_begin].begin),
                                         static_cast<std::uint32_t>(heights[s.z_end - 1].end)});
            sort_and_join(found);
        });
    return out;
}

/// The lattice with other steps along an axis, which has a plane of nodes at the anchor and holds
/// the nodes of the old one.
void stretch_axis(int axis, const LatticeStretch& to, LatticeGrid& grid)
{
    const auto a = static_cast<std::size_t>(axis);
    const double first = grid.origin[axis];
    const double last = first + (grid.n[a] - 1) * grid.step(axis);
    grid.stretch[axis] = to.stretch[axis];
    const double step = grid.step(axis);
    grid.origin[axis] =
        to.anchor[axis] - std::ceil((to.anchor[axis] - first) / step - rounding) * step;
    grid.n[a] =
        static_cast<std::uint32_t>(std::ceil((last - grid.origin[axis]) / step - rounding)) + 1;
}

} // namespace

bool LatticeMove::is_none() const
{
    return shift == Vec3{} && to.stretch == Vec3{1, 1, 1};
}

LatticeMove lattice_move(const Scene& scene, int threads)
{
    const CaseDef& def = *scene.def;
    if (!may_move(scene)) return {};
    LatticeMove move;
    try
    {
        LatticeReport report;
        report.keeps_floods = true;
        const RunField field = draw_on_lattice(scene, threads, {}, report);
        move.flooded = std::move(report.flooded);
        WetPlanes walls(field, def.mk_bound_first);
        for (const SceneStep& step : scene.remaining())
        {
            if (!draws_bound(step)) continue;
            const std::vector<StepSurface> surfaces = fitted_surfaces(scene, step, threads);
            if (surfaces.empty()) return {}; // points and lines stand on the lattice
            if (const std::optional<double> depth = depth_of_wall(step, def))
                for (const StepSurface& surface : surfaces) walls.add(surface.shape, *depth);
        }
        for (int axis = 0; axis < 3; ++axis)
        {
            if (def.grid.is_periodic[static_cast<std::size_t>(axis)]) continue;
            if (axis == 1 && def.grid.is_2d) continue;
            if (is_way_in(def.solver.inout, axis)) continue;
            const std::optional<double> place = walls.of(axis).most();
            if (!place) continue;
            const double moved = *place - std::floor(*place);
            if (moved > rounding && moved < 1 - rounding) move.shift[axis] = moved * def.grid.dp;
        }
        LatticeGrid moved = def.grid;
        moved.origin = moved.origin + move.shift;
        // As much fluid goes in as its particles stand for.
        if (def.solver.inout.is_empty())
            move.to = stretch_between_walls(walls.planes(), moved, def.constants.gravity);
        move.planes = walls.planes();
    }
    catch (const Error&)
    {
        return {}; // drawing the walls says what is wrong
    }
    return move;
}

void move_lattice(const LatticeMove& move, int threads, CaseDef& def, Scene& scene)
{
    LatticeGrid& grid = def.grid;
    const LatticeGrid before = grid;
    std::array<bool, 3> is_moved{};
    for (int axis = 0; axis < 3; ++axis)
    {
        if (move.shift[axis] == 0) continue;
        is_moved[static_cast<std::size_t>(axis)] = true;
        // A node more: walls at the ends of the domain keep all of their layers.
        grid.origin[axis] += move.shift[axis] - grid.dp;
        ++grid.n[static_cast<std::size_t>(axis)];
    }
    // Ends that are nodes with steps of dp become those nearest to them, so that rows are not lost.
    end_fluid_between_nodes(is_moved, move.planes, def);
    for (int axis = 0; axis < 3 && move.to.stretch != Vec3{1, 1, 1}; ++axis)
        stretch_axis(axis, move.to, grid);
    for (const SpanSet& nodes : move.flooded)
        scene.fill_limits.push_back(nodes_beside(nodes, before, grid, threads));
}

} // namespace fppg
