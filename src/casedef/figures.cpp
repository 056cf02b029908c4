#include "casedef/figures.h"

#include <algorithm>
#include <numeric>

namespace fppg
{
namespace
{

using Face = std::vector<std::uint32_t>;

std::vector<std::uint32_t> all_faces(const FigureOp& figure)
{
    std::vector<std::uint32_t> out(figure.faces.size());
    std::iota(out.begin(), out.end(), 0u);
    return out;
}

/// Corner of a box by its bits x, y, z.
constexpr std::uint32_t corner(unsigned x, unsigned y, unsigned z)
{
    return x | (y << 1) | (z << 2);
}

FigureOp make_one_box(const Vec3& low, const Vec3& high, const std::array<bool, 6>& sides,
                      bool is_solid)
{
    FigureOp box;
    for (unsigned c = 0; c < 8; ++c)
        box.vertices.push_back({(c & 1) != 0 ? high.x : low.x, (c & 2) != 0 ? high.y : low.y,
                                (c & 4) != 0 ? high.z : low.z});
    const std::array<Face, 6> quads{
        Face{corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0)},
        Face{corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)},
        Face{corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0)},
        Face{corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)},
        Face{corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)},
        Face{corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)}};
    for (std::size_t side = 0; side < 6; ++side) box.faces.push_back({quads[side], sides[side]});
    if (!is_solid) return box;

    // Two prisms, each with its own faces; those are only used to test for the inside.
    const auto add = [&box](const Face& f)
    {
        box.faces.push_back({f, false});
        return static_cast<std::uint32_t>(box.faces.size() - 1);
    };
    const std::uint32_t diagonal =
        add({corner(1, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 0, 1)});
    const std::uint32_t diagonal_back =
        add({corner(0, 1, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 1, 1)});
    box.bodies.push_back({add({corner(0, 0, 0), corner(0, 1, 0), corner(1, 0, 0)}),
                          add({corner(0, 0, 1), corner(1, 0, 1), corner(0, 1, 1)}), BoxLeft,
                          BoxFront, diagonal});
    box.bodies.push_back({add({corner(1, 1, 0), corner(1, 0, 0), corner(0, 1, 0)}),
                          add({corner(1, 1, 1), corner(0, 1, 1), corner(1, 0, 1)}), BoxRight,
                          BoxBack, diagonal_back});
    box.inner_faces = {diagonal};
    return box;
}

} // namespace

std::vector<FigureOp> make_box(const Vec3& corner0, const Vec3& corner1,
                               const std::array<bool, 6>& sides, bool is_solid,
                               const std::vector<double>& layers_dp, double dp)
{
    Vec3 low;
    Vec3 high;
    for (int axis = 0; axis < 3; ++axis)
    {
        low[axis] = std::min(corner0[axis], corner1[axis]);
        high[axis] = std::max(corner0[axis], corner1[axis]);
    }
    if (layers_dp.empty()) return {make_one_box(low, high, sides, is_solid)};
    std::vector<FigureOp> out;
    for (const double layer : layers_dp)
    {
        Vec3 l = low;
        Vec3 h = high;
        const double shift = layer * dp;
        if (sides[BoxBottom]) l.z -= shift;
        if (sides[BoxTop]) h.z += shift;
        if (sides[BoxLeft]) l.x -= shift;
        if (sides[BoxRight]) h.x += shift;
        if (sides[BoxFront]) l.y -= shift;
        if (sides[BoxBack]) h.y += shift;
        out.push_back(make_one_box(l, h, sides, is_solid));
    }
    return out;
}

FigureOp make_prism(const std::vector<Vec3>& points)
{
    FigureOp prism;
    prism.vertices = points;
    const auto n = static_cast<std::uint32_t>(points.size() / 2);
    Face bottom;
    Face top;
    for (std::uint32_t i = 0; i < n; ++i)
    {
        bottom.push_back(n - 1 - i);
        top.push_back(n + i);
    }
    prism.faces.push_back({bottom, true});
    prism.faces.push_back({top, true});
    for (std::uint32_t i = 0; i < n; ++i)
    {
        const std::uint32_t j = (i + 1) % n;
        prism.faces.push_back({{i, j, n + j, n + i}, true});
    }
    prism.bodies = {all_faces(prism)};
    return prism;
}

FigureOp make_pyramid(const std::vector<Vec3>& points)
{
    FigureOp pyramid;
    pyramid.vertices = points;
    const auto n = static_cast<std::uint32_t>(points.size()) - 1;
    Face base;
    for (std::uint32_t i = 0; i < n; ++i) base.push_back(n - i);
    pyramid.faces.push_back({base, true});
    for (std::uint32_t i = 0; i < n; ++i)
        pyramid.faces.push_back({{1 + i, 1 + (i + 1) % n, 0}, true});
    pyramid.bodies = {all_faces(pyramid)};
    return pyramid;
}

FigureOp make_fan(const std::vector<Vec3>& points)
{
    FigureOp fan;
    fan.vertices = points;
    for (std::uint32_t i = 2; i < points.size(); ++i) fan.faces.push_back({{0, i - 1, i}, true});
    return fan;
}

FigureOp make_strip(const std::vector<Vec3>& points)
{
    FigureOp strip;
    strip.vertices = points;
    for (std::uint32_t i = 2; i < points.size(); ++i)
        strip.faces.push_back({{i - 2, i - 1, i}, true});
    return strip;
}

FigureOp make_polygon(const std::vector<Vec3>& points)
{
    FigureOp polygon;
    polygon.vertices = points;
    // The polygon's own normal (Newell) tells convex corners from concave ones.
    Vec3 normal;
    for (std::size_t i = 0; i < points.size(); ++i)
        normal = normal + cross(points[i], points[(i + 1) % points.size()]);
    std::vector<std::uint32_t> rest(points.size());
    std::iota(rest.begin(), rest.end(), 0u);
    const auto is_ear = [&](std::size_t at)
    {
        const std::size_t n = rest.size();
        const Vec3& a = points[rest[(at + n - 1) % n]];
        const Vec3& b = points[rest[at]];
        const Vec3& c = points[rest[(at + 1) % n]];
        if (dot(cross(b - a, c - b), normal) <= 0) return false;
        for (std::size_t k = 0; k < n; ++k)
        {
            if (k == at || k == (at + 1) % n || k == (at + n - 1) % n) continue;
            const Vec3& p = points[rest[k]];
            if (dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
                dot(cross(a - c, p - c), normal) >= 0)
                return false;
        }
        return true;
    };
    while (rest.size() > 3)
    {
        std::size_t ear = 0;
        while (ear < rest.size() && !is_ear(ear)) ++ear;
        if (ear == rest.size()) ear = 0; // degenerate: cut anywhere
        const std::size_t n = rest.size();
        polygon.faces.push_back({{rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]}, true});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    polygon.faces.push_back({{rest[0], rest[1], rest[2]}, true});
    return polygon;
}

FigureOp make_extrusion(const std::vector<Vec3>& points, const Vec3& extrude, bool is_closed)
{
    FigureOp out;
    out.vertices = points;
    const auto n = static_cast<std::uint32_t>(points.size());
    for (const Vec3& p : points) out.vertices.push_back(p + extrude);
    for (std::uint32_t i = 0; i + (is_closed ? 0 : 1) < n; ++i)
    {
        const std::uint32_t j = (i + 1) % n;
        out.faces.push_back({{i, j, n + j, n + i}, true});
    }
    return out;
}

void hide_faces(FigureOp& figure, const std::vector<int>& numbers)
{
    for (const int number : numbers)
    {
        if (number < 1 || number > static_cast<int>(figure.faces.size())) continue;
        figure.faces[static_cast<std::size_t>(number - 1)].is_visible = false;
        figure.bodies.clear();
        figure.inner_faces.clear();
    }
}

void transform_figure(FigureOp& figure, const Transform& transform)
{
    for (Vec3& v : figure.vertices) v = transform(v);
}

} // namespace fppg
