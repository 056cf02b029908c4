// Commands that change the matrix.
#include "casedef/command_table.h"
#include "core/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fppg::commands
{
namespace
{

/// Multiplies the matrix on the right; clips follow it.
void apply(Program& p, const Element& e, const Transform& map)
{
    p.matrix = p.matrix * map;
    const auto& [x, y, z] = p.matrix.linear;
    if (!is_finite(x) || !is_finite(y) || !is_finite(z) || !is_finite(p.matrix.offset))
        p.read.fail(e, "it moves places to infinity, expected smaller numbers");
    p.place_clips();
}

} // namespace

void reset_matrix(Program& p, const Element&)
{
    p.matrix = {};
    p.place_clips();
}

void save_matrix(Program& p, const Element&)
{
    p.saved_matrices.push_back(p.matrix);
}

void load_matrix(Program& p, const Element&)
{
    if (!p.saved_matrices.empty())
    {
        p.matrix = p.saved_matrices.back();
        p.saved_matrices.pop_back();
    }
    p.place_clips();
}

void move(Program& p, const Element& e)
{
    apply(p, e, translation(p.read.vec3(e)));
}

void scale(Program& p, const Element& e)
{
    apply(p, e, scaling(p.read.vec3(e)));
}

void rotate(Program& p, const Element& e)
{
    const Vec3 axis = p.read.vec3(e);
    if (norm(axis) == 0) p.read.fail(e, "the axis (x, y, z) is zero, expected a direction");
    // Clockwise seen from the tip of the axis (rule T2).
    apply(p, e, rotation(axis, -radians(p.read.number(e, "ang"))));
}

void rotate_line(Program& p, const Element& e)
{
    const std::vector<Vec3> points = p.read.points(e);
    if (points.size() != 2) p.read.fail(e, fmt::format("has {} points, expected 2", points.size()));
    const Vec3 axis = points[1] - points[0];
    if (norm(axis) == 0) p.read.fail(e, "its two points are the same, expected an axis");
    apply(p, e, around(points[0], rotation(axis, -radians(p.read.number(e, "ang")))));
}

void rotate_adv(Program& p, const Element& e)
{
    const std::string axes = p.read.text(e, "axes");
    const auto is_axis = [](char c) { return c >= 'X' && c <= 'Z'; };
    if (axes.size() != 3 || !std::all_of(axes.begin(), axes.end(), is_axis))
        p.read.fail(e, fmt::format("axes \"{}\" is invalid, expected three of X, Y, Z", axes));
    std::array<Transform, 3> turns;
    const std::array<const char*, 3> names{"ang1", "ang2", "ang3"};
    for (std::size_t i = 0; i < 3; ++i)
        turns[i] = rotation_about_axis(axes[i] - 'X', radians(p.read.number(e, names[i])));
    const Transform t =
        p.flag_of(e, "intrinsic") ? turns[0] * turns[1] * turns[2] : turns[2] * turns[1] * turns[0];
    const Element* center = e.find_child("center");
    apply(p, e, (center != nullptr ? around(p.read.vec3(*center), t) : t));
}

} // namespace fppg::commands
