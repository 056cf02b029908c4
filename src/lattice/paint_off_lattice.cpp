#include "lattice/paint_off_lattice.h"

#include "fppg/error.h"

#include "lattice/draw_pattern.h"
#include "lattice/off_lattice_points.h"
#include "shapes/off_lattice_parts.h"
#include "shapes/polyhedra.h"
#include "shapes/solids.h"

#include <fmt/format.h>

namespace fppg
{
namespace
{

template <typename MakePoints>
void paint_made(Painting& painting, const Brush& brush, const MakePoints& make_points)
{
    if (!brush.state->draw_points) return;
    std::vector<Vec3> points;
    try
    {
        points = make_points();
    }
    catch (const GeometryError& e)
    {
        throw CaseError(painting.def.file, brush.source->line,
                        fmt::format("<{}>: {}", brush.source->command, e.what()));
    }
    painting.canvas.paint_off_lattice(brush, points);
}

void append(std::vector<Vec3>& points, const std::vector<Vec3>& more)
{
    points.insert(points.end(), more.begin(), more.end());
}

} // namespace

void paint_off_lattice_points(Painting& painting, const Brush& brush,
                              const std::vector<Vec3>& points)
{
    paint_made(painting, brush, [&] { return points; });
}

void paint_off_lattice_lines(Painting& painting, const Brush& brush,
                             const std::vector<std::pair<Vec3, Vec3>>& segments)
{
    paint_made(painting, brush,
               [&]
               {
                   std::vector<Vec3> points;
                   for (const auto& [from, to] : segments)
                       append(points, off_lattice_line(from, to, painting.grid()));
                   return points;
               });
}

void paint_off_lattice_pieces(Painting& painting, const Brush& brush,
                              const std::vector<std::vector<Vec3>>& pieces)
{
    paint_made(painting, brush,
               [&]
               {
                   std::vector<Vec3> points;
                   for (const std::vector<Vec3>& corners : pieces)
                       append(points, off_lattice_polygon(corners, painting.grid()));
                   return points;
               });
}

void paint_off_lattice_polyhedron(Painting& painting, const Brush& brush, const PolyhedronOp& op)
{
    const DrawState& state = *brush.state;
    const LatticeGrid& grid = painting.grid();
    if (state.mode == DrawMode::Wire && op.solid != SolidKind::Box)
    {
        paint_off_lattice_wire(painting, brush, op);
        return;
    }
    if (op.solid == SolidKind::Box && !grid.is_2d)
    {
        const auto corner = [&](std::size_t i) { return op.vertices[op.solid_vertices[i]]; };
        paint_made(painting, brush,
                   [&] {
                       return off_lattice_block(corner(0), {corner(1), corner(3), corner(4)}, grid);
                   });
        return;
    }
    std::vector<OffLatticePart> parts = off_lattice_parts(op, state.mode, state.matrix, grid);
    if (op.part_count > 0) parts = {parts.at(op.part)};
    std::vector<SlabRegion> insides;
    for (const OffLatticePart& part : parts)
    {
        if (!part.inside)
        {
            paint_off_lattice_pieces(painting, brush, part.pieces);
            continue;
        }
        if (insides.empty())
            insides = op.solid == SolidKind::Prism
                          ? solid_parts(op, grid, state.constants.triangle_weight,
                                        state.constants.triangle_limits)
                          : std::vector<SlabRegion>{solid_of(op, state, grid)};
        painting.canvas.paint(brush, insides.at(*part.inside));
    }
}

void paint_off_lattice_wire(Painting& painting, const Brush& brush, const PolyhedronOp& op)
{
    std::vector<std::pair<Vec3, Vec3>> segments;
    const auto add_sides = [&](const auto& corners)
    {
        for (std::size_t i = 0; i < corners.size(); ++i)
            segments.emplace_back(op.vertices[corners[i]],
                                  op.vertices[corners[(i + 1) % corners.size()]]);
    };
    for (const PolyhedronFace& face : op.faces)
    {
        if (!face.is_visible) continue;
        if (face.triangles.empty() && face.cut.empty())
            add_sides(face.vertices);
        else
            for (const auto& t : face_triangles(op, face)) add_sides(t);
    }
    if (op.part_count > 0) segments = {segments.at(op.part)};
    paint_off_lattice_lines(painting, brush, segments);
}

void paint_off_lattice_sphere(Painting& painting, const Brush& brush, const SphereOp& op)
{
    const DrawState& state = *brush.state;
    const LatticeGrid& grid = painting.grid();
    if (grid.is_2d)
        paint_made(painting, brush, [&] { return off_lattice_disc(op, state.mode, grid); });
    else
        paint_made(painting, brush,
                   [&] { return off_lattice_sphere(op, state.matrix, state.mode, grid); });
}

void paint_off_lattice_cylinder(Painting& painting, const Brush& brush, const CylinderOp& op)
{
    const DrawState& state = *brush.state;
    const LatticeGrid& grid = painting.grid();
    if (state.draw_points && fills_off_lattice_cylinder(op, state.mode))
    {
        std::vector<Spans> emptied =
            emptied_by_cylinder(op, state.clips, grid, painting.canvas.threads());
        // A pattern leaves nodes out here, though not of the particles.
        if (state.pattern)
            for (std::uint32_t x = 0; x < emptied.size(); ++x)
                emptied[x] = split_by_pattern(*state.pattern, emptied[x], x).drawn;
        Brush nothing = brush;
        nothing.mk = {};
        nothing.heeds_pattern = false;
        painting.canvas.paint(nothing, emptied);
    }
    paint_made(painting, brush, [&] { return off_lattice_cylinder(op, state.mode, grid); });
}

} // namespace fppg
