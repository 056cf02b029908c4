#include "offset/dual_cells.h"

#include "offset/quadric.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace fppg
{
namespace
{

/// A place where the surface crosses an edge of the grid.
struct EdgeCrossing
{
    Vec3 position;
    Vec3 normal; ///< unit, of the surface
    Vec3 foot;   ///< of its depth
};

/// Two tangents of one smooth depth agree to this, in edges of the grid.
constexpr double same_tangent = 0.03;
/// Cosine of the least turn of a crease, 12 degrees.
constexpr double least_turn = 0.978;
/// A vertex on a crease may stand so far outside of its cell, in cells.
constexpr double outside_cell = 0.02;
/// The depth of a vertex on a crease is right to this, in cells.
constexpr double crease_error = 0.05;

std::array<int, 3> corner_of_edge(int edge, int end)
{
    const int axis = edge / 4;
    std::array<int, 3> at{0, 0, 0};
    at[static_cast<std::size_t>(axis)] = end;
    at[static_cast<std::size_t>((axis + 1) % 3)] = edge >> 1 & 1;
    at[static_cast<std::size_t>((axis + 2) % 3)] = edge & 1;
    return at;
}

/// Where the depth along an edge passes the given one. Depth along a line is concave where the foot
/// jumps from one face to another: then the first tangent that falls below the depth counts. Behind
/// an edge that runs into the wall it is convex: then it is the last one.
EdgeCrossing cross_edge(const DepthNode& a, const Vec3& at_a, const DepthNode& b, const Vec3& at_b,
                        double depth)
{
    const bool is_a_deeper = a.depth > depth;
    const DepthNode& deep = is_a_deeper ? a : b;
    const DepthNode& high = is_a_deeper ? b : a;
    const Vec3& from = is_a_deeper ? at_a : at_b;
    const Vec3 along = (is_a_deeper ? at_b : at_a) - from;
    const double length = norm(along);
    const double rate_deep = dot(deep.direction, along);
    const double rate_high = dot(high.direction, along);
    double t = (deep.depth - depth) / (deep.depth - high.depth);
    Vec3 direction = (1 - t) * deep.direction + t * high.direction;
    Vec3 foot = (1 - t) * deep.foot + t * high.foot;
    const double excess_high = deep.depth + rate_deep - high.depth;
    const double excess_deep = high.depth - rate_high - deep.depth;
    if (excess_high > same_tangent * length || excess_deep > same_tangent * length)
    {
        const double t_deep = rate_deep < 0 ? (depth - deep.depth) / rate_deep : 2;
        const double t_high = rate_high < 0 ? 1 + (depth - high.depth) / rate_high : 2;
        const bool is_of_deep = t_deep < t_high;
        const double first = std::min(t_deep, t_high);
        if (first >= 0 && first <= 1)
        {
            t = first;
            direction = is_of_deep ? deep.direction : high.direction;
            foot = is_of_deep ? deep.foot : high.foot;
        }
    }
    else if (excess_high < -same_tangent * length || excess_deep < -same_tangent * length)
    {
        const double t_deep = rate_deep < 0 ? (depth - deep.depth) / rate_deep : 2;
        const double t_high = rate_high < 0 ? 1 + (depth - high.depth) / rate_high : 2;
        const bool is_of_deep = t_deep > t_high;
        const double last = std::max(t_deep, t_high);
        if (last >= 0 && last <= 1)
        {
            t = last;
            direction = is_of_deep ? deep.direction : high.direction;
            foot = is_of_deep ? deep.foot : high.foot;
        }
    }
    const double size = norm(direction);
    return {from + t * along, size > 0 ? -direction / size : -high.direction, foot};
}

/// The edges of a cell that the surface crosses, joined to sheets.
class CellSheets
{
public:
    explicit CellSheets(const std::array<bool, 8>& is_deep) : is_deep_(is_deep)
    {
        for (int e = 0; e < edges_of_cell; ++e) group_[index(e)] = crosses(e) ? e : -1;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) join_on_face(axis, side);
    }

    /// Names the sheets by 0, 1, ... in the order of their first edges.
    int name(std::array<std::int8_t, edges_of_cell>& names)
    {
        int count = 0;
        std::array<int, edges_of_cell> of_root{};
        of_root.fill(-1);
        for (int e = 0; e < edges_of_cell; ++e)
        {
            names[index(e)] = -1;
            if (group_[index(e)] < 0) continue;
            int& name = of_root[index(root(e))];
            if (name < 0) name = count++;
            names[index(e)] = static_cast<std::int8_t>(name);
        }
        return count;
    }

private:
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    static int corner(const std::array<int, 3>& at) { return 4 * at[0] + 2 * at[1] + at[2]; }
    bool is_deep(int edge, int end) const
    {
        return is_deep_[index(corner(corner_of_edge(edge, end)))];
    }
    bool crosses(int edge) const { return is_deep(edge, 0) != is_deep(edge, 1); }

    int root(int e) const
    {
        while (group_[index(e)] != e) e = group_[index(e)];
        return e;
    }
    void join(int a, int b)
    {
        const int one = root(a);
        const int other = root(b);
        group_[index(std::max(one, other))] = std::min(one, other);
    }

    /// Of four crossings on a face, those at the same deep corner belong together: both cells of
    /// the face see them alike.
    void join_on_face(int axis, int side)
    {
        std::array<int, 4> found{};
        int count = 0;
        for (int e = 0; e < edges_of_cell; ++e)
        {
            if (e / 4 == axis || group_[index(e)] < 0) continue;
            if (corner_of_edge(e, 0)[index(axis)] == side) found[index(count++)] = e;
        }
        if (count == 2) join(found[0], found[1]);
        if (count < 4) return;
        const auto deep_corner = [&](int e)
        { return corner(corner_of_edge(e, is_deep(e, 0) ? 0 : 1)); };
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                if (deep_corner(found[index(i)]) == deep_corner(found[index(j)]))
                    join(found[index(i)], found[index(j)]);
    }

    const std::array<bool, 8>& is_deep_;
    std::array<int, edges_of_cell> group_{};
};

/// Whether the tangents at two places belong to two faces that meet in a crease.
bool are_of_two_faces(const EdgeCrossing& a, const EdgeCrossing& b, double cell)
{
    return dot(a.normal, b.normal) < least_turn &&
           norm(a.foot - b.foot) > foot_jump * norm(a.position - b.position) + 0.02 * cell;
}

bool has_crease(std::span<const EdgeCrossing> tangents, double cell)
{
    // Where all turn from the first by less than half of that, no two turn by more.
    constexpr double half_turn = 0.9946;
    static_assert(2 * half_turn * half_turn - 1 > least_turn);
    if (std::all_of(tangents.begin(), tangents.end(),
                    [&](const EdgeCrossing& c)
                    { return dot(c.normal, tangents.front().normal) > half_turn; }))
        return false;
    for (std::size_t i = 0; i < tangents.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (are_of_two_faces(tangents[i], tangents[j], cell)) return true;
    return false;
}

/// The point in a cell nearest to all tangents, if it is as deep as they say.
std::optional<Vec3> crease_point(std::span<const EdgeCrossing> tangents, const Vec3& middle,
                                 const Vec3& low, double depth, const DualSource& from)
{
    const double cell = from.grid.cell;
    if (!has_crease(tangents, cell)) return std::nullopt;
    Quadric quadric;
    for (const EdgeCrossing& c : tangents)
        quadric.add_plane(c.normal, dot(c.normal, c.position - middle));
    const Vec3 point = middle + quadric.least_point();
    for (int axis = 0; axis < 3; ++axis)
        if (point[axis] < low[axis] - outside_cell * cell ||
            point[axis] > low[axis] + (1 + outside_cell) * cell)
            return std::nullopt;
    const double off = from.wall.at(point).depth - depth;
    return std::fabs(off) < crease_error * cell ? std::optional(point) : std::nullopt;
}

/// Tangents of the surface as the corners of a cell see it.
void add_corners(const std::array<const DepthNode*, 8>& corners, const Vec3& low, double cell,
                 double depth, std::vector<EdgeCrossing>& tangents)
{
    for (std::size_t c = 0; c < 8; ++c)
    {
        const DepthNode& node = *corners[c];
        if (std::fabs(node.depth - depth) > cell) continue;
        const Vec3 at =
            low + cell * Vec3{static_cast<double>(c >> 2), static_cast<double>(c >> 1 & 1),
                              static_cast<double>(c & 1)};
        tangents.push_back(
            {at + (depth - node.depth) * node.direction, -node.direction, node.foot});
    }
}

DualVertex vertex_of(std::vector<EdgeCrossing>& tangents,
                     const std::array<const DepthNode*, 8>& corners, const Vec3& low, double depth,
                     const DualSource& from)
{
    Vec3 middle;
    for (const EdgeCrossing& c : tangents) middle = middle + c.position;
    middle = middle / static_cast<double>(tangents.size());
    const std::size_t crossings = tangents.size();
    add_corners(corners, low, from.grid.cell, depth, tangents);
    std::optional<Vec3> point = crease_point(tangents, middle, low, depth, from);
    if (!point) point = crease_point({tangents.data(), crossings}, middle, low, depth, from);
    return point ? DualVertex{*point, true} : DualVertex{middle, false};
}

/// Whether all corners of a cell are known, some of them deep and some not.
bool is_crossed(const DualBrick& brick, const std::array<int, 3>& cell)
{
    constexpr int along_y = brick_nodes, along_x = brick_nodes * brick_nodes;
    constexpr std::array<int, 8> corners{
        0, 1, along_y, along_y + 1, along_x, along_x + 1, along_x + along_y, along_x + along_y + 1};
    const int first = (cell[0] * brick_nodes + cell[1]) * brick_nodes + cell[2];
    const NodeSide* low = &brick.sides[static_cast<std::size_t>(first)];
    unsigned seen = 0;
    for (const int c : corners) seen |= 1U << static_cast<unsigned>(low[c]);
    return seen == (1U << static_cast<unsigned>(NodeSide::Deep) |
                    1U << static_cast<unsigned>(NodeSide::Shallow));
}

} // namespace

DualBrick make_dual_brick(const DualSource& from, const DepthBrick& brick, double depth)
{
    const DepthGrid& grid = from.grid;
    DualBrick out;
    out.index.fill(-1);
    for (const DepthNode& node : brick.nodes)
        out.sides.push_back(!node.is_known       ? NodeSide::Unknown
                            : node.depth > depth ? NodeSide::Deep
                                                 : NodeSide::Shallow);
    std::array<std::vector<EdgeCrossing>, 4> of_sheet;
    for (int cell = 0; cell < brick_cells * brick_cells * brick_cells; ++cell)
    {
        const std::array<int, 3> at{cell / (brick_cells * brick_cells),
                                    cell / brick_cells % brick_cells, cell % brick_cells};
        if (!is_crossed(out, at)) continue;
        std::array<bool, 8> is_deep{};
        std::array<const DepthNode*, 8> corners{};
        for (int c = 0; c < 8; ++c)
        {
            const DepthNode& node =
                brick.node(at[0] + (c >> 2), at[1] + (c >> 1 & 1), at[2] + (c & 1));
            corners[static_cast<std::size_t>(c)] = &node;
            is_deep[static_cast<std::size_t>(c)] = node.depth > depth;
        }
        DualCell dual;
        dual.first = static_cast<std::uint32_t>(out.vertices.size());
        const int sheets = CellSheets(is_deep).name(dual.vertex);
        for (auto& crossings : of_sheet) crossings.clear();
        for (int e = 0; e < edges_of_cell; ++e)
        {
            if (dual.vertex[static_cast<std::size_t>(e)] < 0) continue;
            const auto sheet = static_cast<std::uint8_t>(dual.vertex[static_cast<std::size_t>(e)]);
            const auto a = corner_of_edge(e, 0);
            const auto b = corner_of_edge(e, 1);
            const auto place = [&](const std::array<int, 3>& corner)
            {
                return grid.node(brick.first[0] + at[0] + corner[0],
                                 brick.first[1] + at[1] + corner[1],
                                 brick.first[2] + at[2] + corner[2]);
            };
            of_sheet[sheet].push_back(
                cross_edge(brick.node(at[0] + a[0], at[1] + a[1], at[2] + a[2]), place(a),
                           brick.node(at[0] + b[0], at[1] + b[1], at[2] + b[2]), place(b), depth));
        }
        const Vec3 low =
            grid.node(brick.first[0] + at[0], brick.first[1] + at[1], brick.first[2] + at[2]);
        for (int s = 0; s < sheets; ++s)
            out.vertices.push_back(
                vertex_of(of_sheet[static_cast<std::size_t>(s)], corners, low, depth, from));
        out.index[static_cast<std::size_t>(cell)] = static_cast<std::int16_t>(out.cells.size());
        out.cells.push_back(dual);
    }
    return out;
}

} // namespace fppg
