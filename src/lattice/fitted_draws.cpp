#include "lattice/fitted_draws.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "lattice/boolean_wall.h"
#include "lattice/depth_region.h"
#include "lattice/paint_mesh.h"
#include "lattice/shape_mesh.h"

#include <fmt/format.h>

#include <algorithm>

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
    return {(bounds.min.y - grid.origin.y) / grid.dp, (bounds.max.y - grid.origin.y) / grid.dp};
}

/// Rounding of the place of a shape, dp.
constexpr double plane_tolerance = 1e-9;

bool lies_in_plane(const std::vector<ShapeMesh>& shapes, const LatticeGrid& grid)
{
    if (!grid.is_2d) return false;
    const auto [low, high] = heights_over_plane(shapes, grid);
    return low >= -plane_tolerance && high <= plane_tolerance;
}

/// In 2D, whether shapes have no line in common with the plane of the particles though the lattice
/// has nodes for them: they lie in the plane, beside it by less than half a step, or touch it in
/// points.
bool lacks_section(const std::vector<ShapeMesh>& shapes, const std::vector<FittedDraw>& walls,
                   const LatticeGrid& grid)
{
    if (!grid.is_2d) return false;
    const bool is_empty = std::all_of(walls.begin(), walls.end(),
                                      [](const FittedDraw& wall)
                                      { return wall.particles.size() + wall.cut.size() == 0; });
    const auto [low, high] = heights_over_plane(shapes, grid);
    const bool is_beside = low > -0.5 && high < 0.5;
    const bool touches = low <= plane_tolerance && high >= -plane_tolerance;
    return is_empty && (is_beside || touches);
}

/// `advanced`: of the inside, the nodes whose depth is asked for.
void keep_depth(Painting& painting, const Brush& brush, const MeshFileOp& op, FittedDraw& draw)
{
    const Canvas& canvas = painting.canvas;
    TriangleSoup moved =
        moved_soup(mesh_of(painting, brush, op).soup, op.transform, canvas.threads());
    if (brush.state->normal_invert) turn_over(moved);
    const SlabRegion region = depth_region(moved, op, canvas.grid(), canvas.threads());
    parallel_for(draw.volume.size(), canvas.threads(),
                 [&](std::size_t x)
                 {
                     draw.volume[x] = intersect(
                         draw.volume[x],
                         canvas.listed(region, static_cast<std::uint32_t>(x), brush.state->clips));
                 });
}

void add_wall(Painting& painting, const Brush& brush, FittedDraw&& draw, const MeshFileOp* file)
{
    const std::string place = place_of(painting.def, *brush.source);
    painting.report.triangles += draw.body.report.facets_read;
    if (file != nullptr)
    {
        draw.body.name += " " + file->file;
        if (file->advanced) keep_depth(painting, brush, *file, draw);
    }
    // A tank drawn without its lid is open on purpose.
    if (file == nullptr && !draw.body.is_solid && draw.body.facet_mk.empty()) draw.warnings.clear();
    for (const std::string& w : draw.warnings)
        painting.report.warnings.push_back(file != nullptr
                                               ? fmt::format("{}: {}: {}", place, file->file, w)
                                               : fmt::format("{}: {}", place, w));
    if (draw.particles.size() == 0)
        painting.report.warnings.push_back(
            fmt::format("{}: no particle of the body-fitted wall lies inside the domain", place));
    painting.canvas.add_wall(std::move(draw));
}

void refuse_unfittable(const Painting& painting, const Brush& brush, const DrawOp& draw)
{
    const std::string place = place_of(painting.def, *brush.source);
    if (std::holds_alternative<WaveOp>(draw.what))
        throw GeometryError(
            fmt::format("{}: it has no surface for body-fitted particles; draw it "
                        "with a mk that is not body-fitted",
                        place));
    const auto* file = std::get_if<MeshFileOp>(&draw.what);
    if (file != nullptr && file->clip_resize && !file->advanced)
        throw GeometryError(
            fmt::format("{}: <clipdomain> opens the surface, which body-fitted "
                        "particles cannot follow; they end at the domain without "
                        "it",
                        place));
}

FittedDraw fit(const Painting& painting, const Brush& brush, const ShapeMesh& shape,
               const FitSettings& settings)
{
    FittedDraw draw =
        fit_shape(shape, settings, painting.grid(), brush.state->clips, painting.canvas.threads());
    draw.body.line = brush.source->line;
    draw.body.name = brush.source->command;
    draw.body.mk = brush.mk.mk;
    return draw;
}

/// returns  false where a shape has no surface, or no section in 2D
bool paint_shapes(Painting& painting, const Brush& brush, const DrawOp& draw,
                  const FitSettings& settings)
{
    const DrawState& state = *brush.state;
    const LatticeGrid& grid = painting.grid();
    const auto* file = std::get_if<MeshFileOp>(&draw.what);
    const MeshFile* mesh = file != nullptr ? &mesh_of(painting, brush, *file) : nullptr;
    const std::vector<ShapeMesh> shapes =
        shape_meshes(draw, mesh != nullptr ? &mesh->soup : nullptr, grid.dp);
    if (shapes.empty()) return false;
    if (state.pattern && state.draw_points)
        throw GeometryError(
            "setpattern leaves nodes of the lattice out, which body-fitted "
            "particles cannot follow; draw this shape with a mk that is not "
            "body-fitted, or without a pattern");
    std::vector<FittedDraw> walls;
    if (state.draw_points && !lies_in_plane(shapes, grid))
        for (const ShapeMesh& shape : shapes)
            walls.push_back(fit(painting, brush, shape, settings));
    if (state.draw_points && lacks_section(shapes, walls, grid))
    {
        painting.report.warnings.push_back(fmt::format(
            "{}: the shape lies within dp/2 of the plane y = {:g} of this 2D case or only touches "
            "it, so it has no section to put particles on; it is drawn on the lattice, not "
            "body-fitted",
            place_of(painting.def, *brush.source), grid.origin.y));
        return false;
    }
    for (FittedDraw& wall : walls) add_wall(painting, brush, std::move(wall), file);
    if (file != nullptr && !file->advanced)
        paint_points_and_lines(painting, brush, *mesh, file->transform);
    return true;
}

/// The surface of a part, for Booleans.
BooleanWallPart surface_of_part(Painting& painting, const BooleanDef& boolean, std::size_t index)
{
    const DrawOp& op = painting.def.ops[boolean.parts[index].op];
    const std::string place = place_of(painting.def, op.source);
    BooleanWallPart part;
    part.name = op.source.name.empty()
                    ? fmt::format("<{}> in line {}", op.source.command, op.source.line)
                    : op.source.name;
    part.mk = mk_of_part(painting.def, boolean, index).mk;
    part.may_be_sheet = boolean.parts[index].is_sheet;
    const auto* file = std::get_if<MeshFileOp>(&op.what);
    const TriangleSoup* soup =
        file != nullptr ? &mesh_of(painting, Brush(op), *file).soup : nullptr;
    try
    {
        if (soup == nullptr || !soup->vertices.empty())
            for (const ShapeMesh& shape : shape_meshes(op, soup, painting.grid().dp))
            {
                part.soup.vertices.insert(part.soup.vertices.end(), shape.soup.vertices.begin(),
                                          shape.soup.vertices.end());
                part.is_solid = part.is_solid || shape.is_solid;
            }
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(fmt::format("{}: {}", place, e.what()));
    }
    if (part.soup.vertices.empty())
        throw GeometryError(
            fmt::format("{}: has no surface, so that it cannot be a part of the <boolean> in "
                        "line {}",
                        place, boolean.line));
    return part;
}

} // namespace

MkValue mk_of_part(const CaseDef& def, const BooleanDef& boolean, std::size_t part)
{
    if (!boolean.mk) return def.ops[boolean.parts[part].op].state->mk;
    return {MkKind::Bound, *boolean.mk,
            static_cast<std::uint16_t>(*boolean.mk - def.mk_bound_first)};
}

bool paint_fitted(Painting& painting, const Brush& brush, const DrawOp& draw)
{
    const FitSettings* settings =
        brush.mk.kind == MkKind::Bound ? fit_settings(painting.def.fit, brush.mk.mk) : nullptr;
    if (settings == nullptr || brush.state->mode == DrawMode::Wire) return false;
    refuse_unfittable(painting, brush, draw);
    const auto* file = std::get_if<MeshFileOp>(&draw.what);
    if (file != nullptr && mesh_of(painting, brush, *file).soup.vertices.empty()) return false;
    try
    {
        return paint_shapes(painting, brush, draw, *settings);
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(fmt::format("{}: {}", place_of(painting.def, *brush.source), e.what()));
    }
}

void paint_fitted(Painting& painting, const BooleanDef& boolean, const DrawOp& whole,
                  const FitSettings& settings)
{
    std::vector<BooleanWallPart> parts;
    for (std::size_t p = 0; p < boolean.parts.size(); ++p)
        parts.push_back(surface_of_part(painting, boolean, p));
    const Brush brush(whole);
    if (!whole.state->draw_points) return;
    try
    {
        FittedDraw draw = fit_boolean(parts, boolean.tree, settings, painting.grid(),
                                      whole.state->clips, painting.canvas.threads());
        draw.body.line = boolean.line;
        draw.body.name = boolean.name.empty() ? "boolean" : "boolean " + boolean.name;
        add_wall(painting, brush, std::move(draw), nullptr);
    }
    catch (const GeometryError& e)
    {
        throw GeometryError(fmt::format("{}: {}", place_of(painting.def, whole.source), e.what()));
    }
}

} // namespace fppg
