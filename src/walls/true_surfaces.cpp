#include "walls/true_surfaces.h"

#include "fppg/error.h"

#include "meshes/surface_distance.h"
#include "scene/shape_files.h"
#include "scene/surfaces.h"
#include "walls/step_surfaces.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

/// Nearer than this two surfaces are one, farther than that they are two things, dp.
constexpr double one_surface_dp = 0.05;
constexpr double before_nodes_dp = 0.9;
/// So much of a wall has the surface at most this far away, dp: its layers end alike.
constexpr double covered_share = 0.95;
constexpr double covered_dp = 2;

/// The surface of a draw with what searches it.
struct DrawnSurface
{
    bool is_solid = false;
    MeshQuery query;

    const TriangleSoup& soup() const { return query.soup(); }
};

/// Nothing for a draw without a surface; what is wrong with it is said where it is drawn.
std::optional<DrawnSurface> drawn_surface(const Scene& scene, const DrawOp& draw, int threads)
{
    TriangleSoup soup;
    bool is_solid = false;
    try
    {
        for (const ShapeMesh& shape : surfaces_of(scene, draw, PartsAs::One, threads))
        {
            soup.vertices.insert(soup.vertices.end(), shape.soup.vertices.begin(),
                                 shape.soup.vertices.end());
            is_solid = is_solid || shape.is_solid;
        }
        const LatticeGrid& grid = scene.def->grid;
        if (grid.is_2d) soup = pressed_to_plane(soup, grid.origin.y);
        if (soup.vertices.empty()) return std::nullopt;
        return DrawnSurface{is_solid, MeshQuery(std::move(soup), threads)};
    }
    catch (const GeometryError&)
    {
        return std::nullopt;
    }
}

/// The draws whose shapes the file of `<norgeometry>` holds.
std::vector<const DrawOp*> draws_for_normals(const Scene& scene)
{
    const CaseDef& def = *scene.def;
    std::vector<const DrawOp*> out;
    for (ShapeFileDraws& file : shape_file_draws(scene))
        if (!file.is_snapped && def.case_name + file.name() == def.normals.geometry->file)
            out = std::move(file.draws);
    return out;
}

bool is_in_layers(const SceneStep& step, const CaseDef& def)
{
    if (step.combination || !draws_bound(step)) return false;
    const FitSettings* settings = fit_settings(def.fit, step.draw->state->mk.mk);
    return settings != nullptr && settings->boundary == WallBoundary::Mdbc &&
           settings->place != Placement::Inside && !settings->depths_dp.empty();
}

/// A wall with the shape of another draw. Of two boxes, or others with the same corners, only these
/// are taken: the one for normals is often drawn as faces where the wall is solid.
DrawOp drawn_as(const DrawOp& wall, const DrawOp& shape)
{
    DrawOp out = wall;
    const auto* own = shape_as<PolyhedronOp>(wall);
    const auto* other = shape_as<PolyhedronOp>(shape);
    if (own != nullptr && other != nullptr && own->vertices.size() == other->vertices.size() &&
        own->faces.size() == other->faces.size())
    {
        PolyhedronOp moved = *own;
        moved.vertices = other->vertices;
        out.what = Shape(std::move(moved));
    }
    else
        out.what = shape.what;
    out.surface = nullptr;
    out.inner_surface = nullptr;
    DrawState state = *wall.state;
    state.off_lattice = shape.state->off_lattice;
    state.matrix = shape.state->matrix;
    state.normal_invert = shape.state->normal_invert;
    out.state = std::make_shared<const DrawState>(std::move(state));
    return out;
}

/// How far the surface of a wall is before its nodes, dp; nothing where it is none.
std::optional<double> distance_before(const DrawnSurface& wall, const DrawnSurface& shape,
                                      double dp)
{
    const double to_shape = distance_of_share(wall.soup(), shape.query, 0.5) / dp;
    if (!(to_shape > one_surface_dp && to_shape <= before_nodes_dp)) return std::nullopt;
    const double to_wall = distance_of_share(shape.soup(), wall.query, 0.5) / dp;
    if (!(to_wall > one_surface_dp && to_wall <= before_nodes_dp)) return std::nullopt;
    if (distance_of_share(wall.soup(), shape.query, covered_share) > covered_dp * dp)
        return std::nullopt;
    return to_shape;
}

} // namespace

std::vector<std::string> draw_true_surfaces(const Scene& scene, int threads, CaseDef& def)
{
    if (!def.normals.geometry || def.fit.is_empty()) return {};
    const std::vector<const DrawOp*> shapes = draws_for_normals(scene);
    std::set<const DrawOp*> walls;
    for (const SceneStep& step : scene.steps)
        if (is_in_layers(step, def)) walls.insert(step.draw);
    for (const DrawOp* shape : shapes) walls.erase(shape);
    if (walls.empty()) return {};
    std::vector<std::string> out;
    for (DrawOp& op : def.ops)
    {
        if (!walls.contains(&op)) continue;
        const auto wall = drawn_surface(scene, op, threads);
        if (!wall) continue;
        const DrawOp* nearest = nullptr;
        double least = before_nodes_dp;
        for (const DrawOp* shape : shapes)
        {
            if (!(shape->state->mk == op.state->mk)) continue;
            const auto surface = drawn_surface(scene, drawn_as(op, *shape), threads);
            if (!surface || surface->is_solid != wall->is_solid) continue;
            const auto distance = distance_before(*wall, *surface, def.grid.dp);
            if (!distance || *distance > least) continue;
            least = *distance;
            nearest = shape;
        }
        if (nearest == nullptr) continue;
        op = drawn_as(op, *nearest);
        out.push_back(fmt::format(
            "{}: its surface is that for normals, {} in line {}, {:.2g} dp "
            "before the nodes that it is drawn on",
            place_of(def, op.source), nearest->source.command, nearest->source.line, least));
    }
    return out;
}

} // namespace fppg
