#include "shapes/off_lattice_parts.h"

#include "shapes/polygon_cut.h"
#include "shapes/polyhedra.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{
namespace
{

/// Corners of a quad this near to the plane of a 2D case lie in it, dp.
constexpr double in_plane_dp = 0.01;

bool leaves_plane(const std::array<Vec3, 4>& corners, const LatticeGrid& grid)
{
    return grid.is_2d &&
           std::any_of(corners.begin(), corners.end(),
                       [&](const Vec3& corner)
                       { return std::fabs(corner.y - grid.origin.y) > in_plane_dp * grid.dp; });
}

/// The triangles of a quad that the plane of a 2D case cuts: those of less area together, in a flat
/// quad as polygons are cut.
std::array<std::array<Vec3, 3>, 2> halves_of(const std::array<Vec3, 4>& c)
{
    const auto area = [](const Vec3& p, const Vec3& q, const Vec3& r)
    { return norm(cross(q - p, r - p)); };
    const double first = area(c[0], c[1], c[2]) + area(c[0], c[2], c[3]);
    const double second = area(c[1], c[2], c[3]) + area(c[1], c[3], c[0]);
    bool is_first = first < second;
    if (std::fabs(first - second) <= 1e-9 * (first + second))
        is_first = cut_polygon({c.begin(), c.end()}, {0, 1, 2, 3}).front()[1] % 2 == 1;
    if (is_first) return {{{c[0], c[1], c[2]}, {c[0], c[2], c[3]}}};
    return {{{c[3], c[0], c[1]}, {c[1], c[2], c[3]}}};
}

/// Order of the points of a line, where rounding of y decides between those of one x.
bool is_before(const Vec3& a, const Vec3& b)
{
    return std::pair(a.x, a.y) < std::pair(b.x, b.y);
}

/// Where a triangle meets the plane at y: nothing, a point or the ends of a line, of rising x.
/// Their y is that of rounding, which clips see; sides are walked as (0, 1), (1, 2), (0, 2) (60
/// lines of GenCase v5.4.354 to the last bit).
std::vector<Vec3> section_of(const std::array<Vec3, 3>& t, double y, double dp)
{
    std::array<int, 3> side{};
    for (std::size_t k = 0; k < 3; ++k)
        if (std::fabs(t[k].y - y) > in_plane_dp * dp) side[k] = t[k].y < y ? -1 : 1;
    std::vector<Vec3> out;
    if (side == std::array<int, 3>{}) return out;
    for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 2}})
    {
        const Vec3& p = t[static_cast<std::size_t>(i)];
        const Vec3& q = t[static_cast<std::size_t>(j)];
        if (side[static_cast<std::size_t>(i)] * side[static_cast<std::size_t>(j)] < 0)
            out.push_back(p + (q - p) * ((y - p.y) / (q.y - p.y)));
    }
    for (std::size_t k = 0; k < 3; ++k)
        if (side[k] == 0) out.push_back(t[k]);
    std::stable_sort(out.begin(), out.end(), is_before);
    return out;
}

/// The pieces of a quad that leaves the plane of a 2D case.
void add_section(const std::array<Vec3, 4>& c, const LatticeGrid& grid,
                 std::vector<std::vector<Vec3>>& out)
{
    std::vector<std::vector<Vec3>> lines;
    std::vector<std::vector<Vec3>> points;
    const std::array<std::array<Vec3, 3>, 2> halves = halves_of(c);
    for (const std::array<Vec3, 3>& half : halves)
    {
        std::vector<Vec3> section = section_of(half, grid.origin.y, grid.dp);
        if (section.size() > 1)
            lines.insert(lines.begin(), std::move(section));
        else if (!section.empty())
            points.push_back(std::move(section));
    }
    if (lines.empty()) lines = std::move(points);
    if (lines.size() == 2 && lines[0].size() == 2)
        for (std::size_t i = 0; i < 2; ++i)
        {
            if (norm(lines[i][1] - lines[1 - i][0]) > 1e-9 * grid.dp) continue;
            out.push_back({lines[i][0], lines[1 - i][1]});
            return;
        }
    // The second line comes first; but of two of one x from the cut 1-3 the one of lower y.
    const bool is_turned = halves[0][0] == c[3];
    if (is_turned && lines.size() == 2 && lines[0].size() == 2 &&
        std::fabs(lines[0][0].x - lines[1][0].x) <= 1e-9 * grid.dp &&
        !is_before(lines[1][0], lines[0][0]))
        std::swap(lines[0], lines[1]);
    for (std::vector<Vec3>& line : lines) out.push_back(std::move(line));
}

/// The pieces of a quad, as off_lattice_pieces() has them. Of one in the plane of a 2D case all
/// corners are put there, so that it is flat (GenCase v5.4.354: six bent ones, six without width).
void add_quad(std::array<Vec3, 4> c, const Transform& matrix, const LatticeGrid& grid,
              std::vector<std::vector<Vec3>>& out)
{
    if (leaves_plane(c, grid))
    {
        add_section(c, grid, out);
        return;
    }
    if (grid.is_2d)
        for (Vec3& corner : c) corner.y = grid.origin.y;
    const QuadKind kind = quad_kind(c, grid.dp);
    if (kind == QuadKind::TurnedTrapezoid)
        out.push_back({c[1], c[2], c[3], c[0]});
    else if (kind != QuadKind::Other)
        out.push_back({c[0], c[1], c[2], c[3]});
    else
    {
        out.push_back({matrix(c[0]), matrix(c[1]), matrix(c[2])});
        out.push_back({matrix(c[0]), matrix(c[2]), matrix(c[3])});
    }
}

/// The pieces of one face.
std::vector<std::vector<Vec3>> pieces_of(const PolyhedronOp& polyhedron, const PolyhedronFace& face,
                                         const Transform& matrix, const LatticeGrid& grid)
{
    std::vector<std::vector<Vec3>> out;
    const auto corner = [&](std::size_t k) { return polyhedron.vertices[face.vertices[k]]; };
    if (face.vertices.size() == 4 && face.triangles.empty() && face.cut.empty())
        add_quad({corner(0), corner(1), corner(2), corner(3)}, matrix, grid, out);
    else
        for (const auto& t : face_triangles(polyhedron, face))
            out.push_back(
                {polyhedron.vertices[t[0]], polyhedron.vertices[t[1]], polyhedron.vertices[t[2]]});
    return out;
}

} // namespace

std::vector<std::vector<Vec3>> off_lattice_pieces(const PolyhedronOp& polyhedron,
                                                  const Transform& matrix, const LatticeGrid& grid)
{
    std::vector<std::vector<Vec3>> out;
    for (const PolyhedronFace& face : polyhedron.faces)
    {
        if (!face.is_visible) continue;
        for (std::vector<Vec3>& piece : pieces_of(polyhedron, face, matrix, grid))
            out.push_back(std::move(piece));
    }
    return out;
}

std::vector<Vec3> box_section(const PolyhedronOp& box, const LatticeGrid& grid)
{
    const double y = grid.origin.y;
    std::array<int, 8> side{};
    for (std::size_t k = 0; k < 8; ++k)
    {
        const double away = box.vertices[k].y - y;
        if (std::fabs(away) > in_plane_dp * grid.dp) side[k] = away < 0 ? -1 : 1;
    }
    // A corner of the section is the edge of the box that it lies on, or twice a corner of the box.
    using Place = std::pair<std::uint32_t, std::uint32_t>;
    const auto position_of = [&](const Place& place)
    {
        const Vec3& p = box.vertices[place.first];
        const Vec3& q = box.vertices[place.second];
        if (place.first == place.second) return Vec3{p.x, y, p.z};
        const Vec3 at = p + (q - p) * ((y - p.y) / (q.y - p.y));
        return Vec3{at.x, y, at.z};
    };
    std::vector<std::pair<Place, Place>> lines;
    for (const PolyhedronFace& face : box.faces)
    {
        std::vector<Place> ends;
        for (std::size_t k = 0; k < 4; ++k)
        {
            const std::uint32_t i = face.vertices[k];
            const std::uint32_t j = face.vertices[(k + 1) % 4];
            if (side[i] == 0) ends.emplace_back(i, i);
            if (side[i] * side[j] < 0) ends.emplace_back(std::min(i, j), std::max(i, j));
        }
        if (ends.size() == 2) lines.emplace_back(ends[0], ends[1]);
    }
    if (lines.empty()) return {};
    auto first = lines.front().first;
    auto next = lines.front().second;
    if (position_of(next).x < position_of(first).x) std::swap(first, next);
    lines.erase(lines.begin());
    std::vector<Vec3> corners{position_of(first)};
    while (next != first)
    {
        corners.push_back(position_of(next));
        const auto line =
            std::find_if(lines.begin(), lines.end(),
                         [&](const auto& l) { return l.first == next || l.second == next; });
        if (line == lines.end()) break;
        next = line->first == next ? line->second : line->first;
        lines.erase(line);
    }
    if (corners.size() > 4) return {};
    return corners;
}

namespace
{

/// The parts of a solid box in a 2D case.
std::vector<OffLatticePart> section_parts(const PolyhedronOp& box, DrawMode mode,
                                          const Transform& matrix, const LatticeGrid& grid)
{
    const std::vector<Vec3> corners = box_section(box, grid);
    const std::size_t n = corners.size();
    std::vector<OffLatticePart> parts;
    if (n == 2)
        parts.push_back({{corners}});
    else if (n > 2 && mode == DrawMode::Wire)
        for (std::size_t i = 0; i < n; ++i) parts.push_back({{{corners[i], corners[(i + 1) % n]}}});
    else if (n == 4)
    {
        parts.emplace_back();
        add_quad({corners[0], corners[1], corners[2], corners[3]}, matrix, grid, parts[0].pieces);
    }
    else if (n == 3)
        parts.push_back({{corners}});
    else
        parts.emplace_back();
    for (OffLatticePart& part : parts) part.is_section = true;
    parts.back().ends_quad = true;
    return parts;
}

} // namespace

std::vector<OffLatticePart> off_lattice_parts(const PolyhedronOp& polyhedron, DrawMode mode,
                                              const Transform& matrix, const LatticeGrid& grid)
{
    if (polyhedron.solid == SolidKind::Box) return section_parts(polyhedron, mode, matrix, grid);
    std::vector<OffLatticePart> parts;
    const auto add_face = [&](const PolyhedronFace& face)
    {
        std::vector<std::vector<Vec3>> pieces = pieces_of(polyhedron, face, matrix, grid);
        const bool is_quad =
            face.vertices.size() == 4 && face.triangles.empty() && face.cut.empty();
        OffLatticePart quad;
        quad.ends_quad = true;
        for (std::vector<Vec3>& piece : pieces)
        {
            const bool is_section = piece.size() < 3;
            if (is_quad && piece.size() != 2)
            {
                quad.is_section = is_section;
                quad.pieces.push_back(std::move(piece));
            }
            else
                parts.push_back({{std::move(piece)}, {}, is_section});
        }
        if (is_quad) parts.push_back(std::move(quad));
    };
    std::size_t insides = 0;
    const auto add_insides = [&]
    {
        if (polyhedron.solid != SolidKind::Prism)
        {
            parts.push_back({{}, insides++});
            return;
        }
        const auto n = static_cast<std::uint32_t>(polyhedron.vertices.size() / 2);
        for_each_part_and_side(
            bottom_triangles(polyhedron),
            [&](std::size_t) {
                parts.push_back({{}, insides++});
            },
            [&](std::size_t, std::size_t from, std::size_t to)
            {
                const auto i = static_cast<std::uint32_t>(from);
                const auto j = static_cast<std::uint32_t>(to);
                add_face({{j, i, n + i, n + j}, true, {}, 0, {}});
                ++insides;
            });
    };
    const bool fills = mode != DrawMode::Face && polyhedron.solid != SolidKind::None;
    const bool fills_last = fills && polyhedron.solid == SolidKind::Faces;
    if (fills && !fills_last) add_insides();
    if (!fills || mode == DrawMode::Full)
        for (const PolyhedronFace& face : polyhedron.faces)
            if (face.is_visible) add_face(face);
    if (fills_last) add_insides();
    return parts;
}

std::uint32_t count_off_lattice_parts(const PolyhedronOp& polyhedron, DrawMode mode,
                                      const LatticeGrid& grid)
{
    const bool is_box = polyhedron.solid == SolidKind::Box;
    if (is_box && !grid.is_2d) return 1;
    if (!is_box && mode == DrawMode::Wire) return count_parts(polyhedron, mode);
    return static_cast<std::uint32_t>(off_lattice_parts(polyhedron, mode, {}, grid).size());
}

} // namespace fppg
