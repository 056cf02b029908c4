#include "walls/lattice_shift.h"

#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/moving_parts.h"

#include "core/parallel.h"
#include "nodes/run_at.h"
#include "nodes/spans.h"
#include "walls/fluid_ends.h"
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

bool may_move(const Scene& scene)
{
    const CaseDef& def = *scene.def;
    const InOutZones& inout = def.solver.inout;
    if (def.fit.is_empty() || def.vres.is_active() || !inout.fluids.empty() ||
        !inout.boxes.empty() || !relaxes_fluid(def))
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
                const double at = (v[i][axis] - field_.grid.origin[axis]) / field_.grid.dp + depth;
                const double wet =
                    wet_share({v[i], v[i + 1], v[i + 2]}, across / size, !shape.is_solid);
                places_[static_cast<std::size_t>(axis)].add(at - std::floor(at), wet * size / 2);
            }
        }
    }

    const WallPlaces& of(int axis) const { return places_[static_cast<std::size_t>(axis)]; }

private:
    bool is_fluid(const Vec3& p) const { return has_fluid_near(field_, p, first_bound_); }

    /// How much of a facet has fluid before it, or behind it where it is a sheet.
    double wet_share(const std::array<Vec3, 3>& corners, const Vec3& normal, bool is_sheet) const
    {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, norm(corners[(k + 1) % 3] - corners[k]));
        const int parts = static_cast<int>(std::clamp(longest / (piece_dp * field_.grid.dp), 1.0,
                                                      static_cast<double>(most_pieces)));
        int wet = 0;
        int all = 0;
        for (int a = 0; a < parts; ++a)
            for (int b = 0; a + b < parts; ++b)
            {
                const double s = (a + 1.0 / 3) / parts;
                const double t = (b + 1.0 / 3) / parts;
                const Vec3 p =
                    corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
                ++all;
                for (const double look : looks_dp)
                {
                    const Vec3 off = (look * field_.grid.dp) * normal;
                    if (!is_fluid(p + off) && !(is_sheet && is_fluid(p - off))) continue;
                    ++wet;
                    break;
                }
            }
        return static_cast<double>(wet) / all;
    }

    const RunField& field_;
    std::uint16_t first_bound_;
    std::array<WallPlaces, 3> places_;
};

/// The nodes of the moved lattice that are dp or less from nodes of the other along each axis; no
/// slabs where there are none.
SpanSet nodes_beside(const SpanSet& nodes, const LatticeGrid& grid, const Vec3& shift, int threads)
{
    // Node k is beside those from k + first to k + 1 of the moved lattice, which has a node more
    // before it along the axes that it is moved along.
    std::array<std::int64_t, 3> first{};
    NodeBox all = whole_lattice(grid);
    for (int axis = 0; axis < 3; ++axis)
    {
        const bool is_moved = shift[axis] != 0;
        first[static_cast<std::size_t>(axis)] = is_moved ? 0 : -1;
        all.end[static_cast<std::size_t>(axis)] += is_moved ? 1 : 0;
    }
    SpanSet out;
    if (std::all_of(nodes.slabs.begin(), nodes.slabs.end(),
                    [](const Spans& s) { return s.empty(); }))
        return out;
    out.slabs.resize(static_cast<std::size_t>(all.end[0]));
    const auto slabs = static_cast<std::int64_t>(nodes.slabs.size());
    parallel_for(
        out.slabs.size(), threads,
        [&](std::size_t slab)
        {
            const auto x = static_cast<std::int64_t>(slab);
            Spans& found = out.slabs[slab];
            for (std::int64_t k = std::max(x - 1, std::int64_t{0}); k <= x - first[0] && k < slabs;
                 ++k)
                for (const Span& s : nodes.slabs[static_cast<std::size_t>(k)])
                    for (std::int64_t y = s.y + first[1]; y <= s.y + std::int64_t{1}; ++y)
                    {
                        if (y < 0 || y >= all.end[1]) continue;
                        const std::int64_t begin = std::max(s.z_begin + first[2], std::int64_t{0});
                        const std::int64_t end = std::min(s.z_end + std::int64_t{1}, all.end[2]);
                        found.push_back({static_cast<std::uint32_t>(y),
                                         static_cast<std::uint32_t>(begin),
                                         static_cast<std::uint32_t>(end)});
                    }
            sort_and_join(found);
        });
    return out;
}

} // namespace

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
            const std::optional<double> place = walls.of(axis).most();
            if (!place) continue;
            const double moved = *place - std::floor(*place);
            if (moved > rounding && moved < 1 - rounding) move.shift[axis] = moved * def.grid.dp;
        }
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
    for (const SpanSet& nodes : move.flooded)
        scene.fill_limits.push_back(nodes_beside(nodes, grid, move.shift, threads));
    std::array<bool, 3> is_moved{};
    for (int axis = 0; axis < 3; ++axis)
    {
        if (move.shift[axis] == 0) continue;
        is_moved[static_cast<std::size_t>(axis)] = true;
        // A node more: walls at the ends of the domain keep all of their layers.
        grid.origin[axis] += move.shift[axis] - grid.dp;
        ++grid.n[static_cast<std::size_t>(axis)];
    }
    end_fluid_between_nodes(is_moved, def);
}

} // namespace fppg
