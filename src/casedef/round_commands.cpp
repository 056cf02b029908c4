// Commands that draw spheres, cylinders, ellipsoids and waves.
#include "casedef/command_table.h"
#include "shapes/polyhedra.h"
#include "shapes/solid_shape.h"

#include <fmt/format.h>

#include <utility>

namespace fppg::commands
{
namespace
{

class ElementReader : public DrawReader
{
public:
    ElementReader(const Program& p, const Element& e) : p_(p), e_(e) {}

    DrawMode mode() const override { return p_.state.mode; }
    std::vector<Vec3> points(std::size_t at_least, std::size_t at_most) const override
    {
        return p_.transformed_points(e_, at_least, at_most);
    }
    std::optional<Vec3> direction(const char* child) const override
    {
        const Element* found = e_.find_child(child);
        if (found == nullptr) return std::nullopt;
        Transform turn = p_.matrix;
        turn.offset = {};
        return turn(p_.read.vec3(*found));
    }
    double number(const char* attribute) const override { return p_.read.number(e_, attribute); }
    [[noreturn]] void fail(const std::string& text) const override { p_.read.fail(e_, text); }

private:
    const Program& p_;
    const Element& e_;
};

} // namespace

/// A shape that reads its own command.
void draw_read(Program& p, const Element& e, std::optional<Shape> (*read)(const DrawReader&))
{
    if (std::optional<Shape> shape = read(ElementReader(p, e))) p.add(e, std::move(*shape));
}

void draw_sphere(Program& p, const Element& e)
{
    const Vec3 center = p.points_of(e, 1, 1)[0];
    const double radius = p.radius_of(e);
    if (p.state.mode == DrawMode::Wire)
    {
        // The wire of a sphere is that of the solid box around it, turned and scaled with it
        // (24 of 24 spheres in GenCase v5.4, 7 matrices in v5.0).
        const Vec3 reach{radius, radius, radius};
        p.add_polyhedron(
            e, make_box(center - reach, 2 * reach, {true, true, true, true, true, true}, true, {},
                        p.def.grid.dp)[0]);
        // Its box leaves one mk out, off the lattice none, and the sphere one more.
        if (p.state.mk_next_auto)
            for (int i = p.state.off_lattice ? 1 : 0; i < 2; ++i) p.take_next_mk(e);
    }
    else
    {
        // Off the lattice a sphere without a radius is a point.
        const std::vector<Program::Layer> layers = p.layers_of(e);
        if (!p.state.off_lattice) p.check_layers(e, radius, layers);
        SphereOp op{p.matrix(center), radius, {}, {}};
        for (const Program::Layer& layer : layers)
        {
            op.layers_dp.push_back(layer.dp);
            if (layer.is_shown) op.shown_layers_dp.push_back(layer.dp);
            op.limits.push_back(p.moved_cube(center, radius + layer.dp * p.def.grid.dp));
        }
        if (layers.empty())
            op.limits.push_back(p.moved_cube(center, radius));
        else
            p.surface = std::make_shared<const Shape>(
                SphereOp{op.center, radius, {0}, {0}, {p.moved_cube(center, radius)}});
        if (!layers.empty() && layers.back().dp < 0)
        {
            const double inner = radius + layers.back().dp * p.def.grid.dp;
            p.inner_surface = std::make_shared<const Shape>(
                SphereOp{op.center, inner, {0}, {0}, {p.moved_cube(center, inner)}});
        }
        p.add(e, std::move(op));
        p.surface = p.inner_surface = nullptr;
    }
}

void draw_cylinder(Program& p, const Element& e)
{
    if (p.state.mode == DrawMode::Wire)
        p.read.fail(e,
                    "draw mode wire is not possible for a cylinder, expected face, solid or full");
    const std::vector<Vec3> points = p.points_of(e, 2, 2);
    const double radius = p.radius_of(e);
    const std::vector<Program::Layer> layers = p.layers_of(e);
    CylinderOp op{p.matrix(points[0]), p.matrix(points[1]), radius, {true, true, true}, {}};
    const std::vector<int> hidden = p.mask_of(e);
    op.is_masked = !hidden.empty();
    for (const int face : hidden)
        if (face >= 1 && face <= 3) op.is_visible[static_cast<std::size_t>(face - 1)] = false;
    // On the lattice such a layer draws no tube.
    if (p.state.off_lattice && op.is_visible[2]) p.check_layers(e, radius, layers);
    // Layers grow before the matrix moves them (18 cylinders, two scaled, in GenCase v5.4).
    // Visible covers move outwards with the layer, hidden ones stay where they are; without
    // its tube a cylinder keeps its radius in every layer (30 in GenCase v5.4).
    const double length = norm(points[1] - points[0]);
    const Vec3 u = length > 0 ? (points[1] - points[0]) / length : Vec3{};
    for (const Program::Layer& layer : layers)
    {
        const double shift = layer.dp * p.def.grid.dp;
        op.layers.push_back({op.is_visible[0] ? p.matrix(points[0] - u * shift) : op.p0,
                             op.is_visible[1] ? p.matrix(points[1] + u * shift) : op.p1,
                             op.is_visible[2] ? radius + shift : radius, layer.is_shown});
    }
    if (!layers.empty())
    {
        CylinderOp shape = op;
        shape.layers = {{op.p0, op.p1, radius, true}};
        p.surface = std::make_shared<const Shape>(std::move(shape));
    }
    if (!layers.empty() && layers.back().dp < 0)
    {
        CylinderOp inner = op;
        inner.layers = {op.layers.back()};
        inner.layers[0].is_shown = true;
        p.inner_surface = std::make_shared<const Shape>(std::move(inner));
    }
    p.add(e, std::move(op));
    p.surface = p.inner_surface = nullptr;
}

void draw_ellipsoid(Program& p, const Element& e)
{
    const std::vector<Vec3> points = p.transformed_points(e, 2, 2);
    if (p.state.mode != DrawMode::Wire) // draws nothing in wire mode
        p.add(e, EllipsoidOp{points[0], points[1], p.read.number(e, "radius")});
}

void draw_wave(Program& p, const Element& e)
{
    if (p.state.off_lattice)
        p.read.fail(e, "is not possible with setfrdrawmode (GenCase refuses it too)");
    WaveOp op;
    op.corner = p.matrix(p.read.child_vec3(e, "point"));
    const Vec3 size = p.read.child_vec3(e, "size");
    if (size.x < 0 || size.y < 0 || size.z < 0)
        p.read.fail(*e.find_child("size"), "negative values are not possible here");
    op.size = size;
    op.matrix = p.matrix;
    op.depth = p.read.number(e, "depth");
    op.h_max = p.read.number(e, "hmaxwave");
    if (!(op.depth > 0)) p.read.fail(e, fmt::format("depth={:g}, expected more than 0", op.depth));
    if (!(op.h_max >= 0))
        p.read.fail(e, fmt::format("hmaxwave={:g}, expected 0 or more", op.h_max));
    const Vec3 crest = p.matrix({p.read.number(e, "x0"), 0, p.read.number(e, "z0")});
    op.x0 = crest.x;
    op.z0 = crest.z;
    if (!p.matrix.is_identity())
        p.def.warnings.push_back(
            fmt::format("{}:{}: <drawwave>: as in GenCase, the matrix acts twice on the far corner "
                        "of the box and not at all on depth and height of the wave.",
                        p.def.file, e.line));
    p.add(e, op);
}

} // namespace fppg::commands
