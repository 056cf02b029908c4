#include "shapes/polyhedra.h"

#include "shapes/polygon_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace fppg
{
namespace
{

using Face = std::vector<std::uint32_t>;

std::vector<std::uint32_t> all_vertices(const PolyhedronOp& polyhedron)
{
    std::vector<std::uint32_t> out(polyhedron.vertices.size());
    std::iota(out.begin(), out.end(), 0u);
    return out;
}

/// Corner of a box by its bits x, y, z.
constexpr std::uint32_t corner(unsigned x, unsigned y, unsigned z)
{
    return x | (y << 1) | (z << 2);
}

/// Bottom, top and sides of a prism; the bottom is cut by least perimeter and the top as the
/// bottom.
void add_prism_faces(PolyhedronOp& polyhedron, const std::vector<std::uint32_t>& corners)
{
    const auto n = static_cast<std::uint32_t>(corners.size() / 2);
    const Face bottom(corners.begin(), corners.begin() + n);
    const Face top(corners.begin() + n, corners.end());
    polyhedron.faces.push_back({Face(bottom.rbegin(), bottom.rend()), true, bottom, 0, {}});
    polyhedron.faces.push_back({top, true, bottom, top[0] - bottom[0], {}});
    for (std::uint32_t i = 0; i < n; ++i)
    {
        const std::uint32_t j = (i + 1) % n;
        polyhedron.faces.push_back({{bottom[i], bottom[j], top[j], top[i]}, true, {}, 0, {}});
    }
}

PolyhedronOp make_one_box(const Vec3& low, const Vec3& high, const std::array<bool, 6>& sides,
                          bool is_solid)
{
    PolyhedronOp box;
    for (unsigned c = 0; c < 8; ++c)
        box.vertices.push_back({(c & 1) != 0 ? high.x : low.x, (c & 2) != 0 ? high.y : low.y,
                                (c & 4) != 0 ? high.z : low.z});
    if (is_solid)
    {
        box.solid = SolidKind::Box;
        box.solid_vertices = {corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0),
                              corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)};
        add_prism_faces(box, box.solid_vertices);
        const std::vector<std::uint32_t>& c = box.solid_vertices;
        box.faces[0].triangles = {{c[3], c[1], c[0]}, {c[1], c[3], c[2]}};
        box.faces[1].triangles = {{c[7], c[5], c[4]}, {c[5], c[7], c[6]}};
        return box;
    }
    const std::array<Face, 6> quads{
        Face{corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0)},
        Face{corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)},
        Face{corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0)},
        Face{corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)},
        Face{corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)},
        Face{corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)}};
    // GenCase's order of drawing.
    for (const std::size_t side : {BoxBottom, BoxTop, BoxFront, BoxBack, BoxRight, BoxLeft})
        box.faces.push_back({quads[side], sides[side], {}, 0, {}});
    return box;
}

} // namespace

std::vector<PolyhedronOp> make_box(const Vec3& point, const Vec3& extent,
                                   const std::array<bool, 6>& sides, bool is_solid,
                                   const std::vector<double>& layers_dp, double dp)
{
    // Layers move outwards whichever corner of the box comes first.
    Vec3 corner = point;
    Vec3 size = extent;
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] < 0)
        {
            corner[axis] += size[axis];
            size[axis] = -size[axis];
        }
    // The arithmetic is GenCase's, halves included: 375 random boxes, 3375 coordinates. Layers that
    // turn a box over along one axis or three leave nothing inside, along two the box between its
    // moved sides (240 random boxes of v5.4.354, turned, moved or scaled).
    const auto grown = [&](double layer)
    {
        const double h = layer * dp;
        Vec3 low;
        Vec3 high;
        const std::array<std::array<BoxSide, 2>, 3> sides_of_axis{
            {{BoxLeft, BoxRight}, {BoxFront, BoxBack}, {BoxBottom, BoxTop}}};
        for (int axis = 0; axis < 3; ++axis)
        {
            const double near = corner[axis] - h;
            const double far = near + (size[axis] + 2 * h);
            const auto& [first, second] = sides_of_axis[static_cast<std::size_t>(axis)];
            low[axis] = sides[static_cast<std::size_t>(first)] ? near : corner[axis];
            high[axis] = sides[static_cast<std::size_t>(second)] ? far : corner[axis] + size[axis];
        }
        return make_one_box(low, high, sides, is_solid);
    };
    std::vector<PolyhedronOp> out;
    for (const double layer : layers_dp) out.push_back(grown(layer));
    if (layers_dp.empty()) out.push_back(grown(0));
    return out;
}

PolyhedronOp make_prism(const std::vector<Vec3>& points)
{
    PolyhedronOp prism;
    prism.vertices = points;
    prism.solid = SolidKind::Prism;
    prism.solid_vertices = all_vertices(prism);
    add_prism_faces(prism, prism.solid_vertices);
    return prism;
}

PolyhedronOp prism_limits(const std::vector<Vec3>& points)
{
    PolyhedronOp prism;
    prism.vertices = points;
    prism.solid = SolidKind::Faces;
    const auto n = static_cast<std::uint32_t>(points.size() / 2);
    prism.faces.push_back({{0, 2, 1}, true, {}, 0, {}});
    prism.faces.push_back({{n, n + 1, n + 2}, true, {}, 0, {}});
    for (std::uint32_t i = 0; i < n; ++i)
    {
        const std::uint32_t j = (i + 1) % n;
        prism.faces.push_back({{i, j, n + j}, true, {}, 0, {}});
    }
    return prism;
}

namespace
{

/// Whether the corners of a pyramid's base, all points but the first, lie in a plane as drawn.
bool is_flat_base(const std::vector<Vec3>& points)
{
    constexpr double tolerance = 1e-4; // of the base's width
    const Vec3 normal = cross(points[2] - points[1], points[3] - points[1]);
    const double length = norm(normal);
    if (length == 0) return true;
    double width = 0;
    double height = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
    {
        width = std::max(width, norm(points[i] - points[1]));
        height = std::max(height, std::abs(dot(points[i] - points[1], normal)) / length);
    }
    return height <= tolerance * width;
}

} // namespace

PolyhedronOp make_pyramid(const std::vector<Vec3>& points)
{
    PolyhedronOp pyramid;
    pyramid.vertices = points;
    const auto n = static_cast<std::uint32_t>(points.size()) - 1;
    PolyhedronFace base;
    for (std::uint32_t i = 0; i < n; ++i) base.vertices.push_back(n - i);
    // The order of corners decides nodes within rounding of a limit, that of triangles their mks
    // (drawn apart and as parts by GenCase): a fan from the first corner, the last triangle first,
    // and sides from the top.
    if (is_flat_base(points))
        for (std::uint32_t i = n; i >= 3; --i) base.triangles.push_back({1, i, i - 1});
    else
        base.cut.assign(base.vertices.rbegin(), base.vertices.rend());
    pyramid.faces.push_back(std::move(base));
    for (std::uint32_t i = 0; i < n; ++i)
        pyramid.faces.push_back({{0, 1 + i, 1 + (i + 1) % n}, true, {}, 0, {}});
    pyramid.solid = SolidKind::Pyramid;
    pyramid.solid_vertices = all_vertices(pyramid);
    cut_faces(pyramid);
    return pyramid;
}

PolyhedronOp make_fan(const std::vector<Vec3>& points)
{
    PolyhedronOp fan;
    fan.vertices = points;
    for (std::uint32_t i = 2; i < points.size(); ++i)
        fan.faces.push_back({{0, i - 1, i}, true, {}, 0, {}});
    return fan;
}

PolyhedronOp make_strip(const std::vector<Vec3>& points)
{
    PolyhedronOp strip;
    strip.vertices = points;
    // Every second triangle turns the other way: nodes at its limits are as GenCase's (150 strips,
    // 39 were not with all turned alike).
    for (std::uint32_t i = 2; i < points.size(); ++i)
        strip.faces.push_back(
            {i % 2 == 0 ? Face{i - 2, i - 1, i} : Face{i, i - 1, i - 2}, true, {}, 0, {}});
    return strip;
}

PolyhedronOp make_polygon(const std::vector<Vec3>& points)
{
    PolyhedronOp polygon;
    polygon.vertices = points;
    const Face face = all_vertices(polygon);
    // Four corners are cut as a quad.
    polygon.faces.push_back({face, true, face.size() == 4 ? Face{} : face, 0, {}});
    return polygon;
}

PolyhedronOp make_beach(const std::vector<Vec3>& points)
{
    std::vector<Vec3> both = points;
    for (Vec3& p : both) p.y = 0;
    both.insert(both.end(), points.begin(), points.end());
    return make_prism(both);
}

std::vector<Vec3> shifted_polyline(const std::vector<Vec3>& points, const Vec3& extrude,
                                   bool is_closed, double distance)
{
    const std::size_t n = points.size();
    // The side from each point to the next, and across it.
    std::vector<Vec3> sides(n);
    std::vector<Vec3> normals(n);
    for (std::size_t i = 0; i < n; ++i)
    {
        sides[i] = points[(i + 1) % n] - points[i];
        const Vec3 normal = cross(sides[i], extrude);
        const double length = norm(normal);
        if (length > 0) normals[i] = normal / length;
    }
    std::vector<Vec3> out = points;
    for (std::size_t i = 0; i < n; ++i)
    {
        const bool is_last = !is_closed && i + 1 == n;
        const Vec3& normal = normals[is_last ? i - 1 : i];
        out[i] = points[i] + normal * distance;
        if (is_last || (!is_closed && i == 0)) continue;
        const Vec3& before = normals[(i + n - 1) % n];
        const double rise = dot(sides[i], before);
        // Sides of one plane, or one that turns back on itself, have no corner.
        if (std::fabs(rise) <= 1e-9 * norm(sides[i])) continue;
        out[i] = out[i] + sides[i] * (distance * (1 - dot(normal, before)) / rise);
    }
    return out;
}

PolyhedronOp make_extrusion(const std::vector<Vec3>& points, const Vec3& extrude, bool is_closed)
{
    PolyhedronOp out;
    out.vertices = points;
    const auto n = static_cast<std::uint32_t>(points.size());
    for (const Vec3& p : points) out.vertices.push_back(p + extrude);
    for (std::uint32_t i = 0; i + (is_closed ? 0 : 1) < n; ++i)
    {
        const std::uint32_t j = (i + 1) % n;
        out.faces.push_back({{i, j, n + j, n + i}, true, {}, 0, {}});
    }
    return out;
}

std::optional<std::uint32_t> part_between(const PolyhedronOp& polyhedron, DrawMode mode)
{
    const bool fills = mode == DrawMode::Solid || mode == DrawMode::Full;
    if (!fills || polyhedron.solid != SolidKind::Pyramid || polyhedron.faces.at(0).cut.empty())
        return std::nullopt;
    return static_cast<std::uint32_t>(polyhedron.faces[0].cut.size()) - 2;
}

std::uint32_t count_parts(const PolyhedronOp& polyhedron, DrawMode mode)
{
    if (mode == DrawMode::Wire)
    {
        std::uint32_t sides = 0;
        for (const PolyhedronFace& f : polyhedron.faces)
        {
            if (!f.is_visible) continue;
            if (!f.triangles.empty())
                sides += 3 * static_cast<std::uint32_t>(f.triangles.size());
            else
                sides += f.cut.empty() ? static_cast<std::uint32_t>(f.vertices.size())
                                       : 3 * (static_cast<std::uint32_t>(f.cut.size()) - 2);
        }
        return sides;
    }
    const bool fills = mode != DrawMode::Face && polyhedron.solid != SolidKind::None;
    std::uint32_t count = 0;
    std::uint32_t corners = 3;
    if (polyhedron.solid == SolidKind::Box || polyhedron.solid == SolidKind::Prism)
        corners = static_cast<std::uint32_t>(polyhedron.solid_vertices.size() / 2);
    if (fills) count = corners - 2 + 2 * (corners - 3);
    if (const auto between = part_between(polyhedron, mode)) count = *between + 1;
    if (fills && mode == DrawMode::Solid) return count;
    for (const PolyhedronFace& f : polyhedron.faces)
    {
        if (!f.is_visible) continue;
        if (!f.triangles.empty())
            count += static_cast<std::uint32_t>(f.triangles.size());
        else
            count += f.cut.empty() ? 1 : static_cast<std::uint32_t>(f.cut.size()) - 2;
    }
    return count;
}

QuadKind quad_kind(const std::array<Vec3, 4>& corners, double dp)
{
    const auto& [a, b, c, d] = corners;
    if (norm(a + (c - b) - d) <= 0.05 * dp) return QuadKind::Parallelogram;
    const auto are_as_far = [dp](const Vec3& from, const Vec3& to, const Vec3& p, const Vec3& q)
    {
        const Vec3 along = to - from;
        const double length = norm(along);
        if (length == 0) return false;
        const double first = norm(cross(along, p - from)) / length;
        const double second = norm(cross(along, q - from)) / length;
        return std::fabs(first - second) <= 0.01 * dp;
    };
    if (are_as_far(a, b, d, c)) return QuadKind::Trapezoid;
    if (are_as_far(b, c, a, d)) return QuadKind::TurnedTrapezoid;
    return QuadKind::Other;
}

bool is_flat_quad(const std::array<Vec3, 4>& corners, double dp)
{
    const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Vec3 last = corners[3] - corners[0];
    return std::fabs(dot(normal, last)) <= 0.1 * dp * norm(normal);
}

void hide_faces(PolyhedronOp& polyhedron, const std::vector<int>& numbers)
{
    for (const int number : numbers)
        if (number >= 1 && number <= static_cast<int>(polyhedron.faces.size()))
            polyhedron.faces[static_cast<std::size_t>(number - 1)].is_visible = false;
    if (!numbers.empty()) polyhedron.solid = SolidKind::None;
}

void cut_faces(PolyhedronOp& polyhedron)
{
    // Bases are cut as seen from above and look down.
    const bool looks_down =
        polyhedron.solid == SolidKind::Prism || polyhedron.solid == SolidKind::Pyramid;
    for (PolyhedronFace& face : polyhedron.faces)
    {
        if (face.cut.empty()) continue;
        for (const auto& t : cut_polygon(polyhedron.vertices, {face.cut.begin(), face.cut.end()}))
        {
            std::array<std::uint32_t, 3> corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = static_cast<std::uint32_t>(t[k]) + face.cut_offset;
            if (looks_down) std::swap(corners[1], corners[2]);
            face.triangles.push_back(corners);
        }
    }
}

std::vector<std::array<std::size_t, 3>> bottom_triangles(const PolyhedronOp& prism)
{
    std::vector<std::array<std::size_t, 3>> cut;
    if (prism.faces.empty() || prism.faces[0].triangles.empty())
    {
        std::vector<std::size_t> bottom(prism.vertices.size() / 2);
        std::iota(bottom.begin(), bottom.end(), std::size_t{0});
        return cut_polygon(prism.vertices, bottom);
    }
    // The face looks down.
    for (const auto& t : prism.faces[0].triangles) cut.push_back({t[0], t[2], t[1]});
    return cut;
}

std::vector<std::array<std::size_t, 3>> face_triangles(const PolyhedronOp& polyhedron,
                                                       const PolyhedronFace& face)
{
    std::vector<std::array<std::size_t, 3>> out;
    for (const auto& t : face.triangles) out.push_back({t[0], t[1], t[2]});
    if (!face.triangles.empty()) return out;
    if (face.cut.empty())
    {
        for (std::size_t i = 2; i < face.vertices.size(); ++i)
            out.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
        return out;
    }
    for (auto t : cut_polygon(polyhedron.vertices, {face.cut.begin(), face.cut.end()}))
    {
        if (polyhedron.solid == SolidKind::Prism) std::swap(t[1], t[2]);
        out.push_back({t[0] + face.cut_offset, t[1] + face.cut_offset, t[2] + face.cut_offset});
    }
    return out;
}

void transform_polyhedron(PolyhedronOp& polyhedron, const Transform& transform)
{
    for (Vec3& v : polyhedron.vertices) v = transform(v);
}

bool keeps_boxes(const Transform& t)
{
    for (const Vec3& row : t.linear)
    {
        int entries = 0;
        for (int axis = 0; axis < 3; ++axis) entries += std::fabs(row[axis]) > 1e-12 * norm(row);
        if (entries > 1) return false;
    }
    return dot(t.linear[0], cross(t.linear[1], t.linear[2])) > 0;
}

PolyhedronOp turned_box(const Vec3& corner0, const Vec3& corner1, const Transform& t)
{
    PolyhedronOp polyhedron;
    polyhedron.solid = SolidKind::Faces;
    for (unsigned corner = 0; corner < 8; ++corner)
    {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = ((corner >> axis) & 1U) != 0 ? std::max(corner0[axis], corner1[axis])
                                                   : std::min(corner0[axis], corner1[axis]);
        polyhedron.vertices.push_back(t(p));
    }
    // Corners by bits: 1 is the far one along x, 2 along y, 4 along z.
    constexpr std::array<std::array<std::uint32_t, 3>, 6> sides{
        {{0, 3, 1}, {4, 5, 7}, {0, 1, 5}, {3, 2, 6}, {1, 3, 7}, {2, 0, 4}}};
    for (const auto& side : sides)
        polyhedron.faces.push_back({{side[0], side[1], side[2]}, true, {}, 0, {}});
    return polyhedron;
}

} // namespace fppg
