// Commands that draw points, lines and what planes bound.
#include "casedef/command_table.h"
#include "shapes/polyhedra.h"

#include <fmt/format.h>

#include <utility>

namespace fppg::commands
{
namespace
{

void draw_polyline(Program& p, const Element& e, std::size_t at_most)
{
    const std::vector<Vec3> points = p.points_of(e, 2, at_most);
    LinesOp op;
    for (std::size_t i = 1; i < points.size(); ++i)
        op.segments.emplace_back(p.matrix(points[i - 1]), p.matrix(points[i]));
    p.line_begin = points.back();
    p.add(e, std::move(op));
}

} // namespace

void draw_point(Program& p, const Element& e)
{
    p.add(e, PointsOp{{p.matrix(p.read.vec3(e))}});
}

void draw_points(Program& p, const Element& e)
{
    p.add(e, PointsOp{p.transformed_points(e, 2, many_points)});
}

void set_line_begin(Program& p, const Element& e)
{
    p.line_begin = p.read.vec3(e);
}

void draw_line_to(Program& p, const Element& e)
{
    const Vec3 end = p.read.vec3(e);
    p.add(e, LinesOp{{{p.matrix(p.line_begin), p.matrix(end)}}});
    p.line_begin = end;
}

void draw_line(Program& p, const Element& e)
{
    draw_polyline(p, e, 2);
}

void draw_lines(Program& p, const Element& e)
{
    draw_polyline(p, e, many_points);
}

void draw_triangle(Program& p, const Element& e)
{
    PolyhedronOp op;
    op.vertices = p.transformed_points(e, 3, 3);
    op.faces.push_back({{0, 1, 2}, true, {}, 0, {}});
    p.add(e, std::move(op));
}

void draw_quadri(Program& p, const Element& e)
{
    PolyhedronOp op;
    op.vertices = p.transformed_points(e, 4, 4);
    op.faces.push_back({{0, 1, 2, 3}, true, {}, 0, {}});
    p.add(e, std::move(op));
}

void draw_triangles_strip(Program& p, const Element& e)
{
    p.add(e, make_strip(p.transformed_points(e, 3, many_points)));
}

void draw_triangles_fan(Program& p, const Element& e)
{
    p.add(e, make_fan(p.transformed_points(e, 3, many_points)));
}

void draw_polygon(Program& p, const Element& e)
{
    PolyhedronOp op = make_polygon(p.points_of(e, 3, many_points));
    cut_faces(op);
    p.add_polyhedron(e, std::move(op));
}

void draw_triangles(Program& p, const Element& e)
{
    p.add_polyhedron(e, p.polyhedron_of(e));
}

void draw_figure(Program& p, const Element& e)
{
    PolyhedronOp op = p.polyhedron_of(e);
    op.solid = SolidKind::Faces;
    p.add_polyhedron(e, std::move(op));
}

void draw_box(Program& p, const Element& e)
{
    const auto [sides, is_solid] = p.box_sides(e, p.read.child(e, "boxfill"));
    const Vec3 corner = p.read.child_vec3(e, "point");
    const Element* end = e.find_child("endpoint");
    const Vec3 size = end != nullptr ? p.read.vec3(*end) - corner : p.read.child_vec3(e, "size");
    std::vector<Program::Layer> layers = p.layers_of(e);
    // GenCase leaves one mk out after every box but one with layers and one that is a block off the
    // lattice (30 boxes of v5.0).
    const bool leaves_one_out =
        layers.empty() && !(p.state.off_lattice && is_solid && !p.def.grid.is_2d);
    // Of a solid box the outermost layer alone is drawn (34 lists of layers in GenCase v5.0: in
    // face mode the others leave no shell).
    if (is_solid && !layers.empty()) layers.erase(layers.begin() + 1, layers.end());
    std::vector<double> layers_dp;
    for (const Program::Layer& layer : layers) layers_dp.push_back(layer.dp);
    std::vector<PolyhedronOp> polyhedra =
        make_box(corner, size, sides, is_solid, layers_dp, p.def.grid.dp);
    if (!layers.empty())
        p.surface = p.surface_of(make_box(corner, size, sides, is_solid, {}, p.def.grid.dp)[0]);
    if (!layers.empty() && layers.back().dp < 0)
        p.inner_surface = p.surface_of(
            make_box(corner, size, sides, is_solid, {layers.back().dp}, p.def.grid.dp)[0]);
    for (std::size_t i = 0; i < polyhedra.size(); ++i)
        p.add_layer(e, std::move(polyhedra[i]), layers.empty() || layers[i].is_shown);
    p.surface = p.inner_surface = nullptr;
    if (p.state.mk_next_auto && leaves_one_out) p.take_next_mk(e);
}

void draw_prism(Program& p, const Element& e)
{
    const std::vector<Vec3> points = p.points_of(e, 6, many_points);
    if (points.size() % 2 != 0)
        p.read.fail(e, fmt::format("has {} points, expected as many for the bottom as for the top",
                                   points.size()));
    PolyhedronOp op = make_prism(points);
    cut_faces(op);
    hide_faces(op, p.mask_of(e));
    p.add_polyhedron(e, std::move(op));
}

void draw_beach(Program& p, const Element& e)
{
    PolyhedronOp op = make_beach(p.read.points(e));
    if (op.vertices.size() < 6)
        p.read.fail(e, fmt::format("has {} points, expected at least 3", op.vertices.size() / 2));
    cut_faces(op);
    hide_faces(op, p.mask_of(e));
    p.add_polyhedron(e, std::move(op));
}

void draw_pyramid(Program& p, const Element& e)
{
    PolyhedronOp op = make_pyramid(p.points_of(e, 4, many_points));
    hide_faces(op, p.mask_of(e));
    p.add_polyhedron(e, std::move(op));
}

void draw_extrude(Program& p, const Element& e)
{
    const Vec3 extrude = p.read.child_vec3(e, "extrude");
    const bool is_closed = p.flag_of(e, "closed");
    const std::vector<Program::Layer> layers = p.layers_of(e);
    const std::vector<Vec3> points = p.points_of(e, 2, many_points);
    if (!layers.empty()) p.surface = p.surface_of(make_extrusion(points, extrude, is_closed));
    for (const Program::Layer& layer : layers)
        p.add_layer(
            e,
            make_extrusion(shifted_polyline(points, extrude, is_closed, layer.dp * p.def.grid.dp),
                           extrude, is_closed),
            layer.is_shown);
    p.surface = nullptr;
    if (layers.empty()) p.add_polyhedron(e, make_extrusion(points, extrude, is_closed));
}

} // namespace fppg::commands
