#include "walls/fit_walls.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "lattice/depth_region.h"
#include "lattice/paint_mesh.h"
#include "meshes/mesh_query.h"
#include "meshes/open_edges.h"
#include "scene/near_domain.h"
#include "scene/surfaces.h"
#include "walls/boolean_wall.h"
#include "walls/fast_walls.h"
#include "walls/fit_shape.h"
#include "walls/fluid_boxes.h"
#include "walls/lost_layers.h"
#include "walls/periodic_ends.h"
#include "walls/stacked_shells.h"
#include "walls/step_surfaces.h"
#include "walls/thickened.h"
#include "walls/wet_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fppg
{
namespace
{

/// From the lowest y of some shapes to their highest, in dp from the plane of a 2D case.
std::pair<double, double> heights_over_plane(const std::vector<ShapeMesh>& shapes,
                                             const LatticeGrid& grid)
{
    Box3 bounds;
    for (const ShapeMesh& shape : shapes)
        for (const Vec3& v : shape.soup.vertices) bounds.add(v);
    return {(bounds.min.y - grid.origin.y) / grid.step(1),
            (bounds.max.y - grid.origin.y) / grid.step(1)};
}

/// Limits of depths are met to rounding: nodes stand on the lattice, faces often too.
constexpr double depth_slack_dp = 1e-9;

/// Rounding of the place of a shape, dp.
constexpr double plane_tolerance = 1e-9;

/// In 2D, whether shapes have no line in common with the plane of the particles though the lattice
/// has nodes for them: they are beside it by less than half a step, or touch it in points.
bool lacks_section(const std::vector<ShapeMesh>& shapes, const std::vector<FittedDraw>& walls,
                   const LatticeGrid& grid)
{
    if (!grid.is_2d) return false;
    // What is beside the domain has no mesh left (cut_to_domain).
    const bool is_empty = std::all_of(
        walls.begin(), walls.end(),
        [](const FittedDraw& wall)
        { return !wall.body.mesh.facets.empty() && wall.particles.size() + wall.cut.size() == 0; });
    const auto [low, high] = heights_over_plane(shapes, grid);
    const bool is_beside = low > -0.5 && high < 0.5;
    const bool touches = low <= plane_tolerance && high >= -plane_tolerance;
    return is_empty && (is_beside || touches);
}

/// Of the inside, the nodes that GenCase takes at the depth that is asked for. Rows in the plane of
/// a facet miss some by rounding.
void keep_depth_of_rows(const MeshFileOp& file, const TriangleSoup& soup, const LatticeGrid& grid,
                        int threads, FittedDraw& fitted)
{
    fitted.body.measures.filled = 0; // only a layer of it is
    const SlabRegion region = depth_region(soup, file, grid, threads);
    parallel_for(fitted.volume.size(), threads,
                 [&](std::size_t x)
                 {
                     fitted.volume[x] = intersect(
                         fitted.volume[x], listed(region, static_cast<std::uint32_t>(x), {}, grid));
                 });
}

/// Of the inside, the nodes whose distance from the surface is within [depth_min, depth_max].
void keep_depth_by_distance(const MeshFileOp& file, TriangleSoup soup, const LatticeGrid& grid,
                            int threads, FittedDraw& fitted)
{
    const double least = file.depth_min - depth_slack_dp * grid.dp;
    const double most = file.depth_max + depth_slack_dp * grid.dp;
    if (least <= 0 && std::isinf(most)) return;
    fitted.body.measures.filled = 0; // only a layer of it is
    const MeshQuery surface(std::move(soup), threads);
    surface.prepare_nearest();
    parallel_for(fitted.volume.size(), threads,
                 [&](std::size_t x)
                 {
                     Spans kept;
                     for (const Span& s : fitted.volume[x])
                         for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
                         {
                             const Vec3 node = grid.place(static_cast<double>(x), s.y, z);
                             const double depth = surface.closest_point(node, most).distance;
                             if (depth >= least && depth <= most) append_node(kept, s.y, z);
                         }
                     fitted.volume[x] = std::move(kept);
                 });
}

/// `advanced`: of the inside, the nodes whose depth is asked for.
void keep_depth(const Scene& scene, const DrawOp& draw, int threads, FittedDraw& fitted)
{
    const auto* file = shape_as<MeshFileOp>(draw);
    if (file == nullptr || !file->advanced || file->any_depth) return;
    const LatticeGrid& grid = scene.def->grid;
    TriangleSoup moved = moved_soup(mesh_of(scene, draw, threads)->soup, file->transform, threads);
    if (draw.state->normal_invert || file->reverse)
    {
        if (draw.state->normal_invert) turn_over(moved);
        keep_depth_of_rows(*file, moved, grid, threads, fitted);
    }
    else
        keep_depth_by_distance(*file, std::move(moved), grid, threads, fitted);
}

/// Completes the warnings of a fitted draw: each names its place.
void say_place(const Scene& scene, const DrawOp& draw, FittedDraw& fitted)
{
    const std::string place = place_of(*scene.def, draw.source);
    const auto* file = shape_as<MeshFileOp>(draw);
    for (std::string& w : fitted.warnings)
        w = file != nullptr ? fmt::format("{}: {}: {}", place, file->file, w)
                            : fmt::format("{}: {}", place, w);
    // Zones of <vres> are meant to have parts of a case only.
    if (fitted.particles.size() == 0 && scene.def->zone == 0)
        fitted.warnings.push_back(
            fmt::format("{}: no particle of the body-fitted wall lies inside the domain", place));
}

/// Gives sheets the layers that FitSettings::sheet_depths_dp has for them.
void layer_sheet(FitSettings& settings)
{
    if (!settings.fluid_places.empty() && settings.depths_dp.empty() && !settings.has_fluid_behind)
        settings.depths_dp = settings.sheet_depths_dp;
}

/// What a wall is fitted to, by its settings.
struct WallForm
{
    FitSettings settings; ///< of what it is fitted to
    std::optional<WetSide> side;
    bool thickens = false;
    std::string continued_along; ///< as FittedBody::continued_along, so far
};

/// has_sides  whether one side of it may stand for all
WallForm form_of(const ShapeMesh& shape, const FitSettings& given, const LatticeGrid& grid,
                 bool has_sides, int threads)
{
    WallForm out;
    FitSettings& settings = out.settings;
    settings = given;
    // What has fluid on both sides of it holds with one layer.
    out.thickens = settings.thickens && (shape.is_solid || !settings.has_fluid_behind);
    if (has_sides) out.side = wet_side(shape, grid, settings, threads);
    if (out.side && settings.has_fluid_behind)
    {
        // Between its sides a shell has the layers that a closed surface has.
        out.side.reset();
        settings.has_fluid_behind = false;
    }
    if (out.side) out.thickens = false;
    const bool is_solid = shape.is_solid && !out.side;
    if (!is_solid && settings.may_be_open) settings = of_open_body(settings);
    if (!is_solid) layer_sheet(settings);
    return out;
}

/// The wall of a shape, or of the one side of it that its form has.
FittedDraw fit_form(const Scene& scene, const DrawOp& draw, ShapeMesh shape, WallForm form,
                    int threads)
{
    const LatticeGrid& grid = scene.def->grid;
    const double thickness = form.thickens ? thicken(grid, threads, shape) : 0;
    if (form.side) shape = std::move(form.side->sheet);
    const BodyExtent extent =
        is_laid_whole(*scene.def, draw.state->mk.mk) ? BodyExtent::Whole : BodyExtent::NearDomain;
    if (extent == BodyExtent::NearDomain && shape.cad == nullptr)
        form.continued_along += continue_over_periods(grid, shape.soup);
    FittedDraw out =
        fit_shape(std::move(shape), form.settings, grid, draw.state->clips, extent, threads);
    const auto* file = shape_as<MeshFileOp>(draw);
    // A tank drawn without its lid is open on purpose.
    if (file == nullptr && !out.body.is_solid) out.warnings.clear();
    if (thickness > 0) out.warnings.push_back(thickened_from(thickness, grid.dp));
    out.body.is_thickened = thickness > 0;
    out.body.is_wet_side = form.side.has_value();
    if (form.side) out.warnings = warnings_of(*form.side, form.settings.depths_dp, grid.dp);
    out.body.continued_along = std::move(form.continued_along);
    out.body.line = draw.source.line;
    out.body.name = draw.source.command;
    out.body.mk = draw.state->mk.mk;
    if (file != nullptr) out.body.name += " " + file->file;
    return out;
}

/// The walls of a shape: where its form is one side, the shells that have fluid on both sides
/// unlike the others are one more.
std::vector<FittedDraw> fit_forms(const Scene& scene, const DrawOp& draw, ShapeMesh shape,
                                  WallForm form, const FitSettings& given, int threads)
{
    ShapeMesh rest;
    if (form.side) rest = std::move(form.side->rest);
    std::vector<FittedDraw> out;
    out.push_back(fit_form(scene, draw, std::move(shape), std::move(form), threads));
    if (rest.soup.size() > 0)
    {
        WallForm of_rest = form_of(rest, given, scene.def->grid, false, threads);
        out.push_back(fit_form(scene, draw, std::move(rest), std::move(of_rest), threads));
    }
    return out;
}

void refuse_unfittable(const DrawOp& draw)
{
    if (shape_as<WaveOp>(draw) != nullptr)
        throw GeometryError(
            "it has no surface for body-fitted particles; draw it with a mk that "
            "is not body-fitted");
    const auto* file = shape_as<MeshFileOp>(draw);
    if (file != nullptr && file->clip_resize && !file->advanced)
        throw GeometryError(
            "<clipdomain> opens the surface, which body-fitted particles cannot "
            "follow; they end at the domain without it");
}

/// Depths of a file's inside from here on leave its surface out, dp: its nodes are within half a
/// step of it.
constexpr double below_surface_dp = 0.5;

FittedStep fit_draw(const Scene& scene, const DrawOp& draw, const FitSettings& settings,
                    int threads)
{
    const DrawState& state = *draw.state;
    const LatticeGrid& grid = scene.def->grid;
    FittedStep out;
    const auto* file = shape_as<MeshFileOp>(draw);
    if (file != nullptr && file->advanced && file->depth_min > below_surface_dp * grid.dp)
    {
        out.warnings.push_back(fmt::format(
            "{}: <depth depthmin> = {:g} m leaves the surface out, on which body-fitted particles "
            "stand; it is drawn on the lattice, not body-fitted",
            place_of(*scene.def, draw.source), file->depth_min));
        return out;
    }
    const std::optional<DrawOp> shorter = made_near_domain(draw, *scene.def);
    std::vector<ShapeMesh> shapes =
        surfaces_of(scene, shorter ? *shorter : draw, PartsAs::Drawn, threads);
    if (shapes.empty()) return out;
    if (state.pattern && state.draw_points)
        throw GeometryError(
            "setpattern leaves nodes of the lattice out, which body-fitted "
            "particles cannot follow; draw this shape with a mk that is not "
            "body-fitted, or without a pattern");
    std::vector<FittedDraw> walls;
    if (state.draw_points)
        for (ShapeMesh& shape : shapes)
        {
            WallForm form = form_of(shape, settings, grid, true, threads);
            for (FittedDraw& wall : fit_forms(scene, draw, grid.is_2d ? shape : std::move(shape),
                                              std::move(form), settings, threads))
                walls.push_back(std::move(wall));
        }
    if (state.draw_points && lacks_section(shapes, walls, grid))
    {
        out.warnings.push_back(fmt::format(
            "{}: the shape lies within dp/2 of the plane y = {:g} of this 2D case or only touches "
            "it, so it has no section to put particles on; it is drawn on the lattice, not "
            "body-fitted",
            place_of(*scene.def, draw.source), grid.origin.y));
        return out;
    }
    out.is_fitted = true;
    for (FittedDraw& wall : walls)
    {
        keep_depth(scene, draw, threads, wall);
        say_place(scene, draw, wall);
        out.draws.push_back(std::move(wall));
    }
    return out;
}

/// The warning of a sheet that fluid was drawn through.
///
/// left  metres squared of it
std::string fluid_through(const TriangleSoup& sheet, double left)
{
    double area = 0;
    for (std::size_t f = 0; f < sheet.size(); ++f)
    {
        const Vec3* c = &sheet.vertices[3 * f];
        area += norm(cross(c[1] - c[0], c[2] - c[0])) / 2;
    }
    return fmt::format(
        "fluid that is drawn later passes through {:.1f} % of its surface: no wall is left there, "
        "as on the lattice",
        100 * (1 - left / area));
}

/// The walls of a combination of bodies.
std::vector<FittedDraw> fit_bodies(const Scene& scene, const Combination& combination,
                                   CombinedParts combined, std::string continued_along,
                                   const FitSettings& settings, int threads)
{
    const LatticeGrid& grid = scene.def->grid;
    const DrawOp& whole = combination.whole;
    ShapeMesh shape = shape_of(combined);
    WallForm form =
        form_of(shape, settings, grid, may_have_sides(mks_of_facets(combined)), threads);
    form.continued_along = std::move(continued_along);
    std::vector<FittedDraw> out;
    if (form.side)
    {
        std::vector<std::string>& warnings = form.side->of_mesh;
        warnings.insert(warnings.begin(), combined.warnings.begin(), combined.warnings.end());
        out = fit_forms(scene, whole, std::move(shape), std::move(form), settings, threads);
    }
    else
    {
        form.settings.thickens = form.thickens;
        out.push_back(
            fit_boolean(std::move(combined), form.settings, grid, whole.state->clips, threads));
        out[0].body.continued_along = std::move(form.continued_along);
    }
    if (combination.hollowed != nullptr)
        for (FittedDraw& draw : out) draw.hollowed_by = combination.hollowed->by;
    return out;
}

FittedStep fit_combination(const Scene& scene, const Combination& combination,
                           const FitSettings& settings, int threads)
{
    const BooleanDef& boolean = *combination.boolean;
    const bool is_sheet = boolean.parts[0].is_surface;
    std::vector<BooleanWallPart> parts = boolean_parts(scene, combination, PartsAs::Drawn, threads);
    std::string axes; // of the part that goes on along most of them
    for (BooleanWallPart& part : parts)
        if (part.cad == nullptr && !is_laid_whole(*scene.def, part.mk))
            if (std::string of_part = continue_over_periods(scene.def->grid, part.soup);
                of_part.size() > axes.size())
                axes = std::move(of_part);
    FittedStep out;
    out.is_fitted = true;
    if (!combination.whole.state->draw_points) return out;
    const TriangleSoup sheet = is_sheet ? parts[0].soup : TriangleSoup{};
    try
    {
        CombinedParts combined =
            combine_parts(std::move(parts), boolean.tree, scene.def->grid.dp, threads);
        if (is_sheet)
        {
            out.draws.push_back(fit_boolean(std::move(combined), settings, scene.def->grid,
                                            combination.whole.state->clips, threads));
            FittedBody& body = out.draws[0].body;
            body.continued_along = axes;
            // It is open where fluid was drawn through it.
            const std::vector<double>& areas = body.mesh.areas;
            out.draws[0].warnings = {
                fluid_through(sheet, std::accumulate(areas.begin(), areas.end(), 0.0))};
        }
        else
            out.draws =
                fit_bodies(scene, combination, std::move(combined), axes, settings, threads);
    }
    catch (const GeometryError& e)
    {
        const std::string place = place_of(*scene.def, combination.whole.source);
        if (!is_hollowed_away(&combination, e))
            throw GeometryError(fmt::format("{}: {}", place, e.what()));
        if (is_sheet) out.warnings.push_back(fmt::format("{}: {}", place, fluid_through(sheet, 0)));
    }
    const SourceRef& source = combination.whole.source;
    for (FittedDraw& draw : out.draws)
    {
        draw.body.line = boolean.line;
        draw.body.name = source.name.empty() ? source.command : source.command + " " + source.name;
        say_place(scene, combination.whole, draw);
    }
    return out;
}

/// Whether any wall has, or may have, layers behind its surface.
bool has_layers(const FitDef& fit)
{
    const auto has = [](const FitSettings& s)
    { return !s.depths_dp.empty() || !s.sheet_depths_dp.empty(); };
    return (fit.all && has(*fit.all)) ||
           std::any_of(fit.of_mk.begin(), fit.of_mk.end(),
                       [&](const auto& of_mk) { return has(of_mk.second); });
}

/// Warns of layers whose side no fluid decides. Closed bodies in the midst of fluid are dry inside.
void warn_of_sides(const Scene& scene, const DrawOp& draw, const FitSettings& settings,
                   bool has_fluid, FittedStep& step)
{
    if (settings.depths_dp.empty() || settings.may_be_open || settings.side ||
        !settings.fluid_places.empty())
        return;
    for (const FittedDraw& fitted : step.draws)
    {
        if (fitted.body.is_solid || (has_fluid && fitted.body.measures.volume > 0)) continue;
        step.warnings.push_back(fmt::format(
            "{}: layers of this surface stand behind it, where its facets do not look, as no fluid "
            "beside it is drawn: side=\"front\" or \"both\" of <bodyfitted> changes that, "
            "side=\"behind\" says that it is meant.",
            place_of(*scene.def, draw.source)));
        return;
    }
}

/// The holes that a void or the fluid of an inlet makes in sheets.
std::vector<WallOpening> openings_of(const Scene& scene, const SceneStep& step, int threads)
{
    const DrawState& state = *step.draw->state;
    const bool is_inlet =
        state.mk.kind == MkKind::Fluid && scene.def->solver.inout.fluids.contains(state.mk.mk);
    const bool draws = step.shape() != nullptr && state.draw_points && state.clips.empty() &&
                       !state.pattern && state.mode != DrawMode::Wire;
    if (!draws || (state.mk.kind != MkKind::Void && !is_inlet)) return {};
    std::vector<WallOpening> out;
    try
    {
        for (ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::Drawn, threads))
            if (!shape.soup.vertices.empty()) out.push_back({std::move(shape), is_inlet});
    }
    catch (const GeometryError&) // its nodes cut what they cover
    {
        out.clear();
    }
    return out;
}

/// The true shape of a void, or of fluid that no inlet lets in; empty where it is not known, or not
/// closed.
TriangleSoup extent_of(const Scene& scene, const SceneStep& step, int threads)
{
    const DrawState& state = *step.draw->state;
    if (step.shape() == nullptr || !state.draw_points ||
        scene.def->solver.inout.fluids.contains(state.mk.mk))
        return {};
    TriangleSoup out;
    try
    {
        for (const ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::Drawn, threads))
        {
            if (!shape.is_solid || open_edge_count(shape.soup) > 0) return {};
            const std::vector<Vec3>& vertices = shape.soup.vertices;
            out.vertices.insert(out.vertices.end(), vertices.begin(), vertices.end());
        }
    }
    catch (const GeometryError&) // its nodes cut what they cover
    {
        return {};
    }
    return out;
}

/// Which sheets of dynamic boundaries get layers.
enum class SheetLayers
{
    None,
    NoneInFluid, ///< those get none whose layers would stand in fluid
    All
};

/// fluid  boxes_of_fluid()
FittedStep fit_step(const Scene& scene, const SceneStep& step, SheetLayers layers,
                    const std::vector<Box3>& fluid, int threads)
{
    const DrawState& state = *step.draw->state;
    if (state.mk.kind != MkKind::Bound)
    {
        FittedStep out;
        out.openings = openings_of(scene, step, threads);
        out.extent = extent_of(scene, step, threads);
        out.is_void = state.mk.kind == MkKind::Void;
        return out;
    }
    const FitSettings* given = fit_settings(scene.def->fit, state.mk.mk);
    if (given == nullptr) return {};
    FitSettings own = *given;
    if (layers == SheetLayers::None) own.sheet_depths_dp.clear();
    own.has_fluid_behind = layers == SheetLayers::NoneInFluid;
    own.thickens = may_thicken(*scene.def, state.mk.mk);
    const FitSettings* settings = &own;
    if (step.combination)
    {
        const Combination& combination = *step.combination;
        own.fluid_places = places_in_fluid(fluid, scene, combination, threads);
        if (combination.boolean->parts[0].is_surface) layer_sheet(own);
        return fit_combination(scene, *step.combination, *settings, threads);
    }
    if (step.shape() == nullptr || state.mode == DrawMode::Wire) return {};
    mesh_of(scene, *step.draw, threads); // what is wrong with the file is said with its place
    try
    {
        refuse_unfittable(*step.draw);
        own.fluid_places = places_in_fluid(fluid, scene, *step.draw, threads);
        FittedStep out = fit_draw(scene, *step.draw, *settings, threads);
        warn_of_sides(scene, *step.draw, *settings, !fluid.empty(), out);
        return out;
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(
            fmt::format("{}: {}", place_of(*scene.def, step.draw->source), e.what()));
    }
}

} // namespace

std::vector<FittedStep> fit_walls(const Scene& scene, const std::set<std::uint32_t>& wet,
                                  int threads, const LatticeProgress& progress)
{
    std::vector<FittedStep> out(scene.steps.size());
    if (scene.def->fit.is_empty()) return out;
    const bool layered = has_layers(scene.def->fit);
    const std::vector<Box3> fluid = layered ? boxes_of_fluid(scene, threads) : std::vector<Box3>{};
    const std::set<std::uint16_t> fast =
        layered ? mks_of_fast_walls(scene, fluid, threads) : std::set<std::uint16_t>{};
    for (std::uint32_t i = 0; i < out.size(); ++i)
    {
        if (progress) progress(i, out.size());
        const SheetLayers layers = wet.contains(i) ? SheetLayers::NoneInFluid
                                   : may_layer_sheets(scene.steps[i], fast) ? SheetLayers::All
                                                                            : SheetLayers::None;
        out[i] = fit_step(scene, scene.steps[i], layers, fluid, threads);
        const FitSettings* settings =
            fit_settings(scene.def->fit, scene.steps[i].draw->state->mk.mk);
        for (FittedDraw& draw : out[i].draws)
            if ((settings->depths_dp.empty() && !draw.layers.empty()) || draw.body.is_wet_side ||
                (draw.body.is_thickened && !draw.body.is_solid))
                draw.body.layered_step = i;
        // Zones of <vres> are meant to have parts of a case only.
        if (!scene.def->vres.is_active())
            warn_of_lost_layers(place_of(*scene.def, scene.steps[i].draw->source), scene.def->grid,
                                out[i]);
    }
    if (!layered) return out;
    for (const std::uint32_t i : leave_out_stacked_shells(scene, out))
        out[i] = fit_step(scene, scene.steps[i], SheetLayers::None, fluid, threads);
    return out;
}

} // namespace fppg
