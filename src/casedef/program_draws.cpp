// Commands that draw.
#include "fppg/error.h"

#include "casedef/program.h"
#include "shapes/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace fppg
{

void ProgramRunner::add_figure(const Element& e, FigureOp figure)
{
    transform_figure(figure, matrix_);
    add(e, std::move(figure));
}

void ProgramRunner::add_layer(const Element& e, FigureOp figure, bool is_shown)
{
    const bool draw_shapes = state_.draw_shapes;
    const auto set = [&](bool value)
    {
        if (state_.draw_shapes == value) return;
        state_.draw_shapes = value;
        shared_state_.reset();
    };
    set(draw_shapes && is_shown);
    add_figure(e, std::move(figure));
    set(draw_shapes);
}

std::vector<Vec3> ProgramRunner::points_of(const Element& e, std::size_t at_least,
                                           std::size_t at_most) const
{
    std::vector<Vec3> points = read_.points(e);
    if (points.size() < at_least || points.size() > at_most)
        read_.fail(
            e, at_least == at_most
                   ? fmt::format("has {} points, expected {}", points.size(), at_least)
                   : fmt::format("has {} points, expected at least {}", points.size(), at_least));
    return points;
}

std::vector<Vec3> ProgramRunner::transformed_points(const Element& e, std::size_t at_least,
                                                    std::size_t at_most) const
{
    std::vector<Vec3> points = points_of(e, at_least, at_most);
    for (Vec3& p : points) p = matrix_(p);
    return points;
}

FigureOp ProgramRunner::figure_of(const Element& e) const
{
    FigureOp figure;
    figure.vertices = read_.points(read_.child(e, "points"));
    for (const Element& t : read_.child(e, "triangles").children)
    {
        if (t.kind != Element::Kind::Tag || t.name != "triangle") continue;
        FigureFace face;
        for (const char* axis : {"x", "y", "z"})
            face.vertices.push_back(static_cast<std::uint32_t>(
                read_.integer(t, axis, 0, static_cast<int>(figure.vertices.size()) - 1, true)));
        figure.faces.push_back(std::move(face));
    }
    return figure;
}

bool ProgramRunner::flag_of(const Element& e, std::string_view name) const
{
    read_.text(e, name);
    return read_.flag_or(e, name, false);
}

std::vector<ProgramRunner::Layer> ProgramRunner::layers_of(const Element& e) const
{
    std::vector<Layer> out;
    const Element* layers = e.find_child("layers");
    if (layers == nullptr) return out;
    const std::string list = read_.text_or(*layers, "vdp", "");
    std::size_t begin = 0;
    while (begin <= list.size())
    {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        std::string part = list.substr(begin, end - begin);
        // A star changes no node. With one or more, shapeout shows the layers that have one and no
        // others (8 boxes, spheres, cylinders and extrusions of v5.4).
        const bool is_starred = part.find('*') != std::string::npos;
        std::erase_if(part, [](char c) { return c == ' ' || c == '\t' || c == '*'; });
        begin = end + 1;
        if (part.empty()) continue;
        double value = 0;
        const char* first = part.data() + (!part.empty() && part[0] == '+' ? 1 : 0);
        const auto [stop, error] = std::from_chars(first, part.data() + part.size(), value);
        if (error != std::errc() || stop != part.data() + part.size() || !std::isfinite(value))
            read_.fail(
                *layers,
                fmt::format("vdp=\"{}\" is invalid, expected numbers like \"0,-1,2.5\"", list));
        out.push_back({value, is_starred});
    }
    if (std::none_of(out.begin(), out.end(), [](const Layer& l) { return l.is_shown; }))
        for (Layer& layer : out) layer.is_shown = true;
    // GenCase draws the outermost layer first: it is the first part under setmknextauto (30 boxes
    // of v5.0, 7 extrusions of v5.4), and of free particles nearer than 0.75 dp those of inner
    // layers stay (5 spheres, cylinders and extrusions of v5.4).
    std::stable_sort(out.begin(), out.end(),
                     [](const Layer& a, const Layer& b) { return a.dp > b.dp; });
    return out;
}

double ProgramRunner::radius_of(const Element& e) const
{
    const double radius = read_.number(e, "radius");
    if (!(radius > 0)) read_.fail(e, fmt::format("radius is {:g}, expected above 0", radius));
    return radius;
}

Box3 ProgramRunner::moved_cube(const Vec3& center, double radius) const
{
    Box3 box;
    for (const double x : {-radius, radius})
        for (const double y : {-radius, radius})
            for (const double z : {-radius, radius}) box.add(matrix_(center + Vec3{x, y, z}));
    return box;
}

void ProgramRunner::check_layers(const Element& e, double radius,
                                 const std::vector<Layer>& layers) const
{
    for (const Layer& layer : layers)
        if (!(radius + layer.dp * def_.grid.dp > 0))
            read_.fail(*e.find_child("layers"),
                       fmt::format("layer {:g} leaves a radius of {:g}, expected above 0", layer.dp,
                                   radius + layer.dp * def_.grid.dp));
}

std::vector<int> ProgramRunner::mask_of(const Element& e) const
{
    std::vector<int> out;
    const std::string* mask = e.find_attribute("mask");
    if (mask == nullptr) return out;
    constexpr unsigned faces = 32;
    const auto wrong = [&]
    {
        read_.fail(e, fmt::format("mask=\"{}\" is invalid, expected face numbers from 1 to {} like "
                                  "\"1 | 3\", or a bit mask",
                                  *mask, faces));
    };
    unsigned bits = 0;
    if (mask->find('|') != std::string::npos)
        bits = sum_of_words(*mask,
                            [&](const std::string& part)
                            {
                                const auto face = whole_number(part);
                                if (!face || *face < 1 || *face > faces) wrong();
                                return 1U << (*face - 1);
                            });
    else if (const auto number = whole_number(*mask))
        bits = static_cast<unsigned>(*number);
    else
        wrong();
    for (unsigned face = 1; face <= faces; ++face)
        if ((bits >> (face - 1) & 1) != 0) out.push_back(static_cast<int>(face));
    return out;
}

ProgramRunner::BoxSides ProgramRunner::box_sides(const Element& e, const Element& list) const
{
    constexpr unsigned solid = 64;
    const unsigned bits = read_.word_bits(e, list.text, list.name.c_str(),
                                          {{"solid", solid},
                                           {"all", 63},
                                           {"bottom", 1U << BoxBottom},
                                           {"top", 1U << BoxTop},
                                           {"left", 1U << BoxLeft},
                                           {"right", 1U << BoxRight},
                                           {"front", 1U << BoxFront},
                                           {"back", 1U << BoxBack}});
    BoxSides out;
    out.is_solid = (bits & solid) != 0;
    for (std::size_t side = 0; side < 6; ++side)
        out.sides[side] = out.is_solid || (bits >> side & 1) != 0;
    return out;
}

void ProgramRunner::draw_box(const Element& e)
{
    const auto [sides, is_solid] = box_sides(e, read_.child(e, "boxfill"));
    const Vec3 corner = read_.child_vec3(e, "point");
    const Element* end = e.find_child("endpoint");
    const Vec3 size = end != nullptr ? read_.vec3(*end) - corner : read_.child_vec3(e, "size");
    std::vector<Layer> layers = layers_of(e);
    // GenCase leaves one mk out after every box but one with layers and one that is a block of free
    // particles (30 boxes of v5.0).
    const bool leaves_one_out =
        layers.empty() && !(state_.off_lattice && is_solid && !def_.grid.is_2d);
    // Of a solid box the outermost layer alone is drawn (34 lists of layers in GenCase v5.0: in
    // face mode the others leave no shell).
    if (is_solid && !layers.empty()) layers.erase(layers.begin() + 1, layers.end());
    std::vector<double> layers_dp;
    for (const Layer& layer : layers) layers_dp.push_back(layer.dp);
    std::vector<FigureOp> figures =
        make_box(corner, size, sides, is_solid, layers_dp, def_.grid.dp);
    for (std::size_t i = 0; i < figures.size(); ++i)
        add_layer(e, std::move(figures[i]), layers.empty() || layers[i].is_shown);
    if (state_.mk_next_auto && leaves_one_out) take_next_mk(e);
}

void ProgramRunner::draw_wave(const Element& e)
{
    if (state_.off_lattice)
        read_.fail(e, "is not possible with setfrdrawmode (GenCase refuses it too)");
    WaveOp op;
    op.corner = matrix_(read_.child_vec3(e, "point"));
    const Vec3 size = read_.child_vec3(e, "size");
    if (size.x < 0 || size.y < 0 || size.z < 0)
        read_.fail(*e.find_child("size"), "negative values are not possible here");
    op.size = size;
    op.matrix = matrix_;
    op.depth = read_.number(e, "depth");
    op.h_max = read_.number(e, "hmaxwave");
    if (!(op.depth > 0)) read_.fail(e, fmt::format("depth={:g}, expected more than 0", op.depth));
    if (!(op.h_max >= 0)) read_.fail(e, fmt::format("hmaxwave={:g}, expected 0 or more", op.h_max));
    const Vec3 crest = matrix_({read_.number(e, "x0"), 0, read_.number(e, "z0")});
    op.x0 = crest.x;
    op.z0 = crest.z;
    if (!matrix_.is_identity())
        def_.warnings.push_back(
            fmt::format("{}:{}: <drawwave>: as in GenCase, the matrix acts twice on the far corner "
                        "of the box and not at all on depth and height of the wave.",
                        def_.file, e.line));
    add(e, op);
}

bool ProgramRunner::run_draw(const Element& e)
{
    const std::string& name = e.name;
    constexpr std::size_t many = 100'000'000;
    if (name == "drawpoint")
        add(e, PointsOp{{matrix_(read_.vec3(e))}});
    else if (name == "drawpoints")
        add(e, PointsOp{transformed_points(e, 2, many)});
    else if (name == "setlinebegin")
        line_begin_ = read_.vec3(e);
    else if (name == "drawlineto")
    {
        const Vec3 end = read_.vec3(e);
        add(e, LinesOp{{{matrix_(line_begin_), matrix_(end)}}});
        line_begin_ = end;
    }
    else if (name == "drawline" || name == "drawlines")
    {
        const std::vector<Vec3> points = points_of(e, 2, name == "drawline" ? 2 : many);
        LinesOp op;
        for (std::size_t i = 1; i < points.size(); ++i)
            op.segments.emplace_back(matrix_(points[i - 1]), matrix_(points[i]));
        line_begin_ = points.back();
        add(e, std::move(op));
    }
    else if (name == "drawtriangle" || name == "drawquadri")
    {
        const std::size_t n = name == "drawtriangle" ? 3 : 4;
        FigureOp op;
        op.vertices = transformed_points(e, n, n);
        op.faces.push_back(
            {n == 3 ? std::vector<std::uint32_t>{0, 1, 2} : std::vector<std::uint32_t>{0, 1, 2, 3},
             true,
             {},
             0,
             {}});
        add(e, std::move(op));
    }
    else if (name == "drawtrianglesstrip")
        add(e, make_strip(transformed_points(e, 3, many)));
    else if (name == "drawtrianglesfan")
        add(e, make_fan(transformed_points(e, 3, many)));
    else if (name == "drawpolygon")
    {
        FigureOp op = make_polygon(points_of(e, 3, many));
        cut_faces(op);
        add_figure(e, std::move(op));
    }
    else if (name == "drawtriangles" || name == "drawfigure")
    {
        FigureOp op = figure_of(e);
        if (name == "drawfigure") op.solid = SolidKind::Faces;
        add_figure(e, std::move(op));
    }
    else if (name == "drawbox")
        draw_box(e);
    else if (name == "drawprism")
    {
        const std::vector<Vec3> points = points_of(e, 6, many);
        if (points.size() % 2 != 0)
            read_.fail(e,
                       fmt::format("has {} points, expected as many for the bottom as for the top",
                                   points.size()));
        FigureOp op = make_prism(points);
        cut_faces(op);
        hide_faces(op, mask_of(e));
        add_figure(e, std::move(op));
    }
    else if (name == "drawbeach")
    {
        FigureOp op = make_beach(read_.points(e));
        if (op.vertices.size() < 6)
            read_.fail(e,
                       fmt::format("has {} points, expected at least 3", op.vertices.size() / 2));
        cut_faces(op);
        hide_faces(op, mask_of(e));
        add_figure(e, std::move(op));
    }
    else if (name == "drawpyramid")
    {
        FigureOp op = make_pyramid(points_of(e, 4, many));
        hide_faces(op, mask_of(e));
        add_figure(e, std::move(op));
    }
    else if (name == "drawextrude")
    {
        const Vec3 extrude = read_.child_vec3(e, "extrude");
        const bool is_closed = flag_of(e, "closed");
        const std::vector<Layer> layers = layers_of(e);
        const std::vector<Vec3> points = points_of(e, 2, many);
        for (const Layer& layer : layers)
            add_layer(e,
                      make_extrusion(
                          shifted_polyline(points, extrude, is_closed, layer.dp * def_.grid.dp),
                          extrude, is_closed),
                      layer.is_shown);
        if (layers.empty()) add_figure(e, make_extrusion(points, extrude, is_closed));
    }
    else if (name == "drawsphere")
    {
        const Vec3 center = points_of(e, 1, 1)[0];
        const double radius = radius_of(e);
        if (state_.mode == DrawMode::Wire)
        {
            // The wire of a sphere is that of the solid box around it, turned and scaled with it
            // (24 of 24 spheres in GenCase v5.4, 7 matrices in v5.0).
            const Vec3 reach{radius, radius, radius};
            add_figure(e, make_box(center - reach, 2 * reach, {true, true, true, true, true, true},
                                   true, {}, def_.grid.dp)[0]);
            // Its box leaves one mk out, off the lattice none, and the sphere one more.
            if (state_.mk_next_auto)
                for (int i = state_.off_lattice ? 1 : 0; i < 2; ++i) take_next_mk(e);
        }
        else
        {
            // Free spheres without a radius are a point.
            const std::vector<Layer> layers = layers_of(e);
            if (!state_.off_lattice) check_layers(e, radius, layers);
            SphereOp op{matrix_(center), radius, {}, {}};
            for (const Layer& layer : layers)
            {
                op.layers_dp.push_back(layer.dp);
                if (layer.is_shown) op.shown_layers_dp.push_back(layer.dp);
                op.limits.push_back(moved_cube(center, radius + layer.dp * def_.grid.dp));
            }
            if (layers.empty()) op.limits.push_back(moved_cube(center, radius));
            add(e, std::move(op));
        }
    }
    else if (name == "drawcylinder")
    {
        if (state_.mode == DrawMode::Wire)
            read_.fail(
                e, "draw mode wire is not possible for a cylinder, expected face, solid or full");
        const std::vector<Vec3> points = points_of(e, 2, 2);
        const double radius = radius_of(e);
        const std::vector<Layer> layers = layers_of(e);
        CylinderOp op{matrix_(points[0]), matrix_(points[1]), radius, {true, true, true}, {}};
        for (const int face : mask_of(e))
            if (face >= 1 && face <= 3) op.is_visible[static_cast<std::size_t>(face - 1)] = false;
        // On the lattice such a layer draws no tube.
        if (state_.off_lattice && op.is_visible[2]) check_layers(e, radius, layers);
        // Layers grow before the matrix moves them (18 cylinders, two scaled, in GenCase v5.4).
        // Visible covers move outwards with the layer, hidden ones stay where they are; without
        // its tube a cylinder keeps its radius in every layer (30 in GenCase v5.4).
        const double length = norm(points[1] - points[0]);
        const Vec3 u = length > 0 ? (points[1] - points[0]) / length : Vec3{};
        for (const Layer& layer : layers)
        {
            const double shift = layer.dp * def_.grid.dp;
            op.layers.push_back({op.is_visible[0] ? matrix_(points[0] - u * shift) : op.p0,
                                 op.is_visible[1] ? matrix_(points[1] + u * shift) : op.p1,
                                 op.is_visible[2] ? radius + shift : radius, layer.is_shown});
        }
        add(e, std::move(op));
    }
    else if (name == "drawellipsoid")
    {
        const std::vector<Vec3> points = transformed_points(e, 2, 2);
        if (state_.mode != DrawMode::Wire) // draws nothing in wire mode
            add(e, EllipsoidOp{points[0], points[1], read_.number(e, "radius")});
    }
    else if (name == "drawwave")
        draw_wave(e);
    else if (name == "drawbathymetry")
        draw_bathymetry(e);
    else if (name.starts_with("drawfile"))
        draw_mesh_file(e);
    else
        return false;
    return true;
}

} // namespace fppg
