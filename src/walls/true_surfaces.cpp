#include "walls/true_surfaces.h"

#include "fppg/error.h"

#include "meshes/surface_distance.h"
#include "scene/shape_files.h"
#include "scene/surfaces.h"
#include "walls/step_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
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

/// The last command that makes everything before it void; null: none.
const DrawOp* last_voiding(const CaseDef& def)
{
    const DrawOp* out = nullptr;
    for (const DrawOp& op : def.ops)
    {
        const auto* edit = std::get_if<Edit>(&op.what);
        const auto* redraw = edit != nullptr ? std::get_if<RedrawOp>(edit) : nullptr;
        if (redraw != nullptr && op.state->mk.kind == MkKind::Void && redraw->filters.empty() &&
            !redraw->region)
            out = &op;
    }
    return out;
}

/// The draws of true surfaces: those whose shapes the file of `<norgeometry>` holds, and those in
/// other shape files that leave no particles (the piston of the public CaseWavesFrCylinder).
std::vector<const DrawOp*> draws_of_surfaces(const Scene& scene)
{
    const CaseDef& def = *scene.def;
    const DrawOp* voiding = last_voiding(def);
    std::set<const DrawOp*> known;
    std::vector<const DrawOp*> out;
    for (const ShapeFileDraws& file : shape_file_draws(scene))
    {
        if (file.is_snapped) continue;
        const bool is_for_normals = def.case_name + file.name() == def.normals.geometry->file;
        for (const DrawOp* draw : file.draws)
        {
            const bool leaves_none =
                !draw->state->draw_points || std::less<const DrawOp*>()(draw, voiding);
            if ((is_for_normals || leaves_none) && known.insert(draw).second) out.push_back(draw);
        }
    }
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

/// A wall as it was drawn and as it is now.
struct MovedWall
{
    MeshQuery from;
    MeshQuery to;
};

struct TrueSurface
{
    const DrawOp* draw = nullptr;
    double distance_dp = 0;
    MovedWall wall;
};

/// The surface for normals that is nearest before a wall.
std::optional<TrueSurface> true_surface_of(const DrawOp& wall,
                                           const std::vector<const DrawOp*>& shapes,
                                           const Scene& scene, int threads)
{
    std::optional<DrawnSurface> own = drawn_surface(scene, wall, threads);
    if (!own) return std::nullopt;
    const DrawOp* nearest = nullptr;
    double least = before_nodes_dp;
    std::optional<DrawnSurface> found;
    for (const DrawOp* shape : shapes)
    {
        if (!(shape->state->mk == wall.state->mk)) continue;
        std::optional<DrawnSurface> surface = drawn_surface(scene, drawn_as(wall, *shape), threads);
        if (!surface || surface->is_solid != own->is_solid) continue;
        const auto distance = distance_before(*own, *surface, scene.def->grid.dp);
        if (!distance || *distance > least) continue;
        least = *distance;
        nearest = shape;
        found = std::move(surface);
    }
    if (nearest == nullptr) return std::nullopt;
    return TrueSurface{nearest, least, {std::move(own->query), std::move(found->query)}};
}

/// The corners of a wall, or ends of a cylinder, that stand on moved walls go along with them, as
/// those of a piston without a surface for normals that is drawn onto the nodes of the floor. Else
/// it would stand half a dp deep in the floor, would lack its lowest row, and leak (public
/// CaseFloatingWaves: 25 particles of 11,237 in 1.5 s).
///
/// returns  whether any moved
bool move_corners(const std::vector<MovedWall>& moved, const LatticeGrid& grid, DrawOp& wall)
{
    bool has_moved = false;
    const auto move = [&](Vec3& corner)
    {
        for (const MovedWall& of : moved)
        {
            Vec3 place = corner;
            if (grid.is_2d) place.y = grid.origin.y;
            if (of.from.closest_point(place).distance > one_surface_dp * grid.dp) continue;
            const Vec3 way = of.to.closest_point(place).point - place;
            corner = corner + Vec3{way.x, grid.is_2d ? 0 : way.y, way.z};
            has_moved = true;
        }
    };
    if (const auto* polyhedron = shape_as<PolyhedronOp>(wall))
    {
        PolyhedronOp shape = *polyhedron;
        for (Vec3& corner : shape.vertices) move(corner);
        wall.what = Shape(std::move(shape));
    }
    else if (const auto* cylinder = shape_as<CylinderOp>(wall))
    {
        CylinderOp shape = *cylinder;
        for (Vec3* end : {&shape.p0, &shape.p1}) move(*end);
        wall.what = Shape(std::move(shape));
    }
    return has_moved;
}

bool has_corners(const DrawOp& wall)
{
    return shape_as<PolyhedronOp>(wall) != nullptr || shape_as<CylinderOp>(wall) != nullptr;
}

/// Whether a wall, such as a mesh or a sphere, touches moved walls as they were drawn.
bool stands_on(const std::vector<MovedWall>& moved, const Scene& scene, const DrawOp& wall,
               int threads)
{
    const std::optional<DrawnSurface> surface = drawn_surface(scene, wall, threads);
    if (!surface) return false;
    const double near = one_surface_dp * scene.def->grid.dp;
    const std::vector<Vec3>& corners = surface->soup().vertices;
    return std::any_of(corners.begin(), corners.end(),
                       [&](const Vec3& corner)
                       {
                           return std::any_of(
                               moved.begin(), moved.end(),
                               [&](const MovedWall& of)
                               { return of.from.closest_point(corner, near).distance <= near; });
                       });
}

/// How far a wall reaches along a direction, metres; empty where it has no plane faces.
std::optional<double> outermost_of(const DrawOp& wall, const Vec3& outward)
{
    const auto* drawn = shape_as<PolyhedronOp>(wall);
    if (drawn == nullptr || drawn->vertices.empty()) return std::nullopt;
    double out = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : drawn->vertices) out = std::max(out, dot(v, outward));
    return out;
}

/// Moves the outermost corners of a wall along a direction, metres.
void move_outermost(const Vec3& outward, double way, double dp, DrawOp& wall)
{
    PolyhedronOp shape = *shape_as<PolyhedronOp>(wall);
    const double outermost = *outermost_of(wall, outward);
    for (Vec3& v : shape.vertices)
        if (dot(v, outward) > outermost - one_surface_dp * dp) v = v + way * outward;
    wall.what = Shape(std::move(shape));
}

/// Moves walls onto the planes that `<norplane>` has for their normals: up to a dp before the nodes
/// that the case draws. A plane without a point lies before the outermost wall of its mk, if all of
/// them have plane faces.
void move_to_planes(CaseDef& def, const std::set<const DrawOp*>& walls,
                    std::vector<std::string>& said)
{
    const double dp = def.grid.dp;
    for (const NormalOp& normals : def.normals.ops)
    {
        const auto* plane = std::get_if<PlaneNormals>(&normals.what);
        if (plane == nullptr || !(norm(plane->normal) > 0) || normals.only != PositionFilter{})
            continue;
        const Vec3 outward = plane->normal / norm(plane->normal);
        for (const std::uint16_t mk : normals.mk)
        {
            std::vector<DrawOp*> of_mk;
            for (DrawOp& op : def.ops)
                if (walls.contains(&op) && op.state->mk.mk == mk) of_mk.push_back(&op);
            double outermost = -std::numeric_limits<double>::infinity();
            for (const DrawOp* op : of_mk)
                outermost = std::max(
                    outermost,
                    outermost_of(*op, outward).value_or(std::numeric_limits<double>::infinity()));
            const double place =
                plane->point ? dot(*plane->point, outward) : outermost + plane->limit_dp * dp;
            for (DrawOp* op : of_mk)
            {
                const std::optional<double> own = outermost_of(*op, outward);
                const double way = own ? place - *own : 0;
                if (way <= one_surface_dp * dp || way > before_nodes_dp * dp) continue;
                move_outermost(outward, way, dp, *op);
                said.push_back(
                    fmt::format("{}: its surface is the plane of <norplane> in line {}, "
                                "{:.2g} dp from where it is drawn",
                                place_of(def, op->source), normals.line, way / dp));
            }
        }
    }
}

/// Gives walls the surfaces of the file for normals, and takes them out of `walls`.
void move_to_geometry(const Scene& scene, int threads, CaseDef& def, std::set<const DrawOp*>& walls,
                      std::vector<std::string>& out)
{
    const std::vector<const DrawOp*> shapes = draws_of_surfaces(scene);
    for (const DrawOp* shape : shapes) walls.erase(shape);
    std::vector<MovedWall> moved;
    for (DrawOp& op : def.ops)
    {
        if (!walls.contains(&op)) continue;
        std::optional<TrueSurface> found = true_surface_of(op, shapes, scene, threads);
        if (!found) continue;
        out.push_back(
            fmt::format("{}: its surface is that for normals, <{}> in line {}, {:.2g} dp "
                        "from where it is drawn",
                        place_of(def, op.source), found->draw->source.command,
                        found->draw->source.line, found->distance_dp));
        op = drawn_as(op, *found->draw);
        walls.erase(&op);
        moved.push_back(std::move(found->wall));
    }
    for (DrawOp& op : def.ops)
    {
        if (moved.empty() || !walls.contains(&op)) continue;
        if (move_corners(moved, def.grid, op))
            out.push_back(
                fmt::format("{}: where it stands on walls that have a surface for "
                            "normals, it ends at that surface",
                            place_of(def, op.source)));
        else if (!has_corners(op) && stands_on(moved, scene, op, threads))
            def.hints.push_back(
                fmt::format("{}: it stands on walls whose surface is that for normals, and stays "
                            "where it is drawn, up to a dp in or off them: its lowest particles "
                            "may be missing, or fluid get under it. Draw its surface for normals "
                            "too.",
                            place_of(def, op.source)));
    }
}

} // namespace

std::vector<std::string> draw_true_surfaces(const Scene& scene, int threads, CaseDef& def)
{
    std::vector<std::string> out;
    if (!def.normals.is_active || def.fit.is_empty()) return out;
    std::set<const DrawOp*> walls;
    for (const SceneStep& step : scene.steps)
        if (is_in_layers(step, def)) walls.insert(step.draw);
    if (def.normals.geometry) move_to_geometry(scene, threads, def, walls, out);
    move_to_planes(def, walls, out);
    return out;
}

} // namespace fppg
