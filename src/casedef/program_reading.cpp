// What commands read of their elements.
#include "casedef/program.h"
#include "core/finite_number.h"
#include "shapes/polyhedra.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace fppg
{

void Program::add_polyhedron(const Element& e, PolyhedronOp polyhedron)
{
    transform_polyhedron(polyhedron, matrix);
    add(e, std::move(polyhedron));
}

void Program::add_layer(const Element& e, PolyhedronOp polyhedron, bool is_shown)
{
    const bool draw_shapes = state.draw_shapes;
    state.draw_shapes = draw_shapes && is_shown;
    add_polyhedron(e, std::move(polyhedron));
    state.draw_shapes = draw_shapes;
}

std::shared_ptr<const Shape> Program::surface_of(PolyhedronOp polyhedron) const
{
    transform_polyhedron(polyhedron, matrix);
    return std::make_shared<const Shape>(std::move(polyhedron));
}

std::vector<Vec3> Program::points_of(const Element& e, std::size_t at_least,
                                     std::size_t at_most) const
{
    std::vector<Vec3> points = read.points(e);
    if (points.size() < at_least || points.size() > at_most)
    {
        const std::string wanted = at_least == at_most ? fmt::format("{}", at_least)
                                   : at_most < many_points
                                       ? fmt::format("{} to {}", at_least, at_most)
                                       : fmt::format("at least {}", at_least);
        read.fail(e, fmt::format("has {} points, expected {}", points.size(), wanted));
    }
    return points;
}

std::vector<Vec3> Program::transformed_points(const Element& e, std::size_t at_least,
                                              std::size_t at_most) const
{
    std::vector<Vec3> points = points_of(e, at_least, at_most);
    for (Vec3& p : points) p = matrix(p);
    return points;
}

PolyhedronOp Program::polyhedron_of(const Element& e) const
{
    PolyhedronOp polyhedron;
    polyhedron.vertices = read.points(read.child(e, "points"));
    for (const Element& t : read.child(e, "triangles").children)
    {
        if (t.kind != Element::Kind::Tag || t.name != "triangle") continue;
        PolyhedronFace face;
        for (const char* axis : {"x", "y", "z"})
            face.vertices.push_back(static_cast<std::uint32_t>(
                read.integer(t, axis, 0, static_cast<int>(polyhedron.vertices.size()) - 1, true)));
        polyhedron.faces.push_back(std::move(face));
    }
    return polyhedron;
}

BoxRegion Program::box_of(const Element& e) const
{
    BoxRegion box;
    box.corner0 = read.child_vec3(e, "point");
    if (const Element* end = e.find_child("endpoint"))
        box.corner1 = read.vec3(*end);
    else
        box.corner1 = box.corner0 + read.child_vec3(e, "size");
    return box;
}

/// The box of a fill or redraw before the matrix. Only its strict interior counts: to take in its
/// limits (setboxlimitmode full), it grows by dp.
BoxRegion Program::limit_box_of(const Element& e, bool with_limits) const
{
    BoxRegion box = box_of(e);
    if (!with_limits) return box;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double low = std::min(box.corner0[axis], box.corner1[axis]);
        const double high = std::max(box.corner0[axis], box.corner1[axis]);
        box.corner0[axis] = low - def.grid.dp;
        box.corner1[axis] = high + def.grid.dp;
    }
    return box;
}

void Program::keep_debug_box(const Element& e, bool with_limits, std::optional<Vec3> seed)
{
    std::vector<DebugBox>& pictures = def.debug_boxes;
    const auto forgotten_end = pictures.begin() + static_cast<std::ptrdiff_t>(pictures_forgotten);
    const auto kept = std::remove_if(pictures.begin(), forgotten_end,
                                     [&](const DebugBox& p) { return p.command == e.name; });
    pictures_forgotten = static_cast<std::size_t>(kept - pictures.begin());
    pictures.erase(kept, forgotten_end);
    const BoxRegion box = limit_box_of(e, with_limits);
    DebugBox picture;
    picture.command = e.name;
    picture.mk = state.mk.kind == MkKind::Void ? 0 : state.mk.mk;
    picture.seed = seed;
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double a = box.corner0[axis];
            const double b = box.corner1[axis];
            p[axis] = (corner >> axis & 1U) != 0 ? std::max(a, b) : std::min(a, b);
        }
        picture.corners[corner] = matrix(p);
    }
    pictures.push_back(std::move(picture));
}

BoxLimits Program::limits_of(const Element& e, bool with_limits) const
{
    const BoxRegion box = limit_box_of(e, with_limits);
    if (!keeps_boxes(matrix)) return turned_box(box.corner0, box.corner1, matrix);
    return BoxRegion{matrix(box.corner0), matrix(box.corner1)};
}

bool Program::flag_of(const Element& e, std::string_view name) const
{
    read.text(e, name);
    return read.flag_or(e, name, false);
}

std::vector<Program::Layer> Program::layers_of(const Element& e) const
{
    std::vector<Layer> out;
    const Element* layers = e.find_child("layers");
    if (layers == nullptr) return out;
    const std::string list = read.text_or(*layers, "vdp", "");
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
        const std::optional<double> value = finite_signed_number(part);
        if (!value)
            read.fail(
                *layers,
                fmt::format("vdp=\"{}\" is invalid, expected numbers like \"0,-1,2.5\"", list));
        out.push_back({*value, is_starred});
    }
    if (std::none_of(out.begin(), out.end(), [](const Layer& l) { return l.is_shown; }))
        for (Layer& layer : out) layer.is_shown = true;
    // GenCase draws the outermost layer first: it is the first part under setmknextauto (30 boxes
    // of v5.0, 7 extrusions of v5.4), and of particles off the lattice nearer than 0.75 dp those of
    // inner layers stay (5 spheres, cylinders and extrusions of v5.4).
    std::stable_sort(out.begin(), out.end(),
                     [](const Layer& a, const Layer& b) { return a.dp > b.dp; });
    return out;
}

double Program::radius_of(const Element& e) const
{
    const double radius = read.number(e, "radius");
    if (!(radius > 0)) read.fail(e, fmt::format("radius is {:g}, expected above 0", radius));
    return radius;
}

Box3 Program::moved_cube(const Vec3& center, double radius) const
{
    Box3 box;
    for (const double x : {-radius, radius})
        for (const double y : {-radius, radius})
            for (const double z : {-radius, radius}) box.add(matrix(center + Vec3{x, y, z}));
    return box;
}

void Program::check_layers(const Element& e, double radius, const std::vector<Layer>& layers) const
{
    for (const Layer& layer : layers)
        if (!(radius + layer.dp * def.grid.dp > 0))
            read.fail(*e.find_child("layers"),
                      fmt::format("layer {:g} leaves a radius of {:g}, expected above 0", layer.dp,
                                  radius + layer.dp * def.grid.dp));
}

std::vector<int> Program::mask_of(const Element& e) const
{
    std::vector<int> out;
    const std::string* mask = e.find_attribute("mask");
    if (mask == nullptr) return out;
    constexpr unsigned faces = 32;
    const auto wrong = [&]
    {
        read.fail(e, fmt::format("mask=\"{}\" is invalid, expected face numbers from 1 to {} like "
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

Program::BoxSides Program::box_sides(const Element& e, const Element& list) const
{
    constexpr unsigned solid = 64;
    const unsigned bits = read.word_bits(e, list.text, list.name.c_str(),
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

void Program::check_mk(const Element& e, const char* attribute, MkKind kind) const
{
    const bool is_bound = kind == MkKind::Bound;
    const int count = is_bound ? def.mkbound_count : def.mkfluid_count;
    if (e.find_attribute(attribute) == nullptr) return;
    const int number = read.integer(e, attribute, 0, 65000, false);
    if (number >= count)
        read.fail(e, fmt::format("{}=\"{}\" is invalid, expected 0 to {} (<mkconfig {}=\"{}\">)",
                                 attribute, number, count - 1,
                                 is_bound ? "boundcount" : "fluidcount", count));
}

std::optional<std::uint16_t> Program::absolute_mk(const Element& e, const char* attribute,
                                                  MkKind kind) const
{
    if (e.find_attribute(attribute) == nullptr) return std::nullopt;
    const int first = kind == MkKind::Bound ? def.mk_bound_first : def.mk_fluid_first;
    return static_cast<std::uint16_t>(read.integer(e, attribute, 0, 65000 - first, false) + first);
}

} // namespace fppg
