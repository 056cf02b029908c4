// Every region lists its nodes as intervals found by estimates; here each is held to its predicate
// asked node by node.

#include "helpers/dense_grid.h"
#include "shapes/kinds.h"
#include "shapes/plane_shapes.h"
#include "shapes/planes.h"
#include "shapes/polygon_cut.h"
#include "shapes/solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fppg
{
namespace
{

using test::any_grid;
using test::any_node;
using test::dense;
using test::DenseSet;
using test::Dice;
using test::difference;
using test::where;

constexpr int cases = 1500;

bool is_in_box(const Node& n, const std::vector<Node>& corners)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto less = [axis](const Node& a, const Node& b) { return a[axis] < b[axis]; };
        const auto [low, high] = std::minmax_element(corners.begin(), corners.end(), less);
        if (n[axis] < (*low)[axis] || n[axis] > (*high)[axis]) return false;
    }
    return true;
}

/// Rule P3, node by node.
bool triangle_has(const SnappedTriangle& t, const LatticeGrid& grid, double weight, double limits,
                  const Node& n)
{
    if (t.a == t.b && t.b == t.c) return n == t.a;
    if (!is_in_box(n, {t.a, t.b, t.c})) return false;
    const auto whole = [](const Node& p, const Node& q) {
        return std::array<std::int64_t, 3>{q.x - p.x, q.y - p.y, q.z - p.z};
    };
    const auto u = whole(t.a, t.b);
    const auto v = whole(t.a, t.c);
    if (u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2] && u[0] * v[1] == u[1] * v[0])
        return false;
    const Vec3 x = position(n, grid);
    const std::array<Vec3, 3> p{position(t.a, grid), position(t.b, grid), position(t.c, grid)};
    const Plane plane = plane_through(p[0], p[1], p[2]);
    if (!(std::fabs(plane.value(x) / norm(plane.normal)) < weight * grid.dp)) return false;
    const Vec3 up = cross(p[1] - p[0], p[2] - p[1]);
    for (std::size_t e = 0; e < 3; ++e)
    {
        const Vec3 from = p[e];
        const Vec3 to = p[(e + 1) % 3];
        // The third point of the plane across the edge stands over its first end, for (c, a) over
        // a.
        const Vec3 above = (e == 2 ? to : from) + up;
        const Vec3 outward = cross(to - from, above - from);
        const Vec3 shift = outward * (limits * grid.dp / norm(outward));
        if (!(plane_through(from + shift, to + shift, above + shift).value(x) < 0)) return false;
    }
    return true;
}

TEST(PointsRegion, IsTheNearestNodeOfEveryPointInside)
{
    Dice dice(1);
    for (int i = 0; i < cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        std::vector<Vec3> points;
        for (int k = 0; k < 5; ++k)
            points.push_back(position(any_node(dice, grid, 2), grid) + Vec3{0, 0, 0.4 * grid.dp});
        const DenseSet expected =
            where(grid,
                  [&](const Node& n)
                  {
                      return std::any_of(points.begin(), points.end(),
                                         [&](const Vec3& p) { return snap(p, grid) == n; });
                  });
        ASSERT_EQ(difference(dense(grid, points_region(points, grid)), expected), "")
            << "case " << i;
    }
}

TEST(LinesRegion, HasTheNodesOfTheIndexBoxNearTheLine)
{
    Dice dice(2);
    for (int i = 0; i < cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        const double width = dice.one_of({0.6, 0.5, 1.0, 0.3, 2.2});
        const Node from = any_node(dice, grid, 6);
        const Node to = dice.whole(0, 9) == 0 ? from : any_node(dice, grid, 6);
        const Vec3 a = position(from, grid);
        const Vec3 b = position(to, grid);
        const auto holds = [&](const Node& n)
        {
            if (from == to || !is_in_box(n, {from, to})) return false;
            const Vec3 p = position(n, grid);
            return 2 * (norm(cross(a - p, b - p)) / 2) / norm(b - a) < width * grid.dp;
        };
        ASSERT_EQ(
            difference(dense(grid, lines_region({{from, to}}, grid, width)), where(grid, holds)),
            "")
            << "case " << i;
    }
}

TEST(TrianglesRegion, HasTheNodesNearThePlaneAndNotFarBeyondTheEdges)
{
    Dice dice(3);
    for (int i = 0; i < 4 * cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        const double weight = dice.one_of({0.6, 0.5, 1.0, 0.25});
        const double limits = dice.one_of({0.6, 0.5, 1.0, 0.0});
        // Small triangles, needles and large ones; some upright, so that a column lies in the
        // plane.
        SnappedTriangle t{any_node(dice, grid, 8), any_node(dice, grid, 8),
                          any_node(dice, grid, 8)};
        if (i % 4 == 1) t.b = {t.a.x, t.a.y, t.b.z};
        if (i % 4 == 2)
            t.c = {t.a.x + dice.whole(-1, 1), t.a.y + dice.whole(-1, 1), t.a.z + dice.whole(-1, 1)};
        if (i % 40 == 3) t.c = t.b = t.a;
        const DenseSet expected =
            where(grid, [&](const Node& n) { return triangle_has(t, grid, weight, limits, n); });
        ASSERT_EQ(difference(dense(grid, triangles_region({t}, grid, weight, limits)), expected),
                  "")
            << "case " << i;
    }
}

TEST(TrianglesRegion, FindsLongTrianglesInATallLattice)
{
    Dice dice(4);
    for (int i = 0; i < 40; ++i)
    {
        LatticeGrid grid = any_grid(dice);
        grid.n = {9, 60, 120};
        const SnappedTriangle t{any_node(dice, grid, 200), any_node(dice, grid, 200),
                                any_node(dice, grid, 200)};
        const DenseSet expected =
            where(grid, [&](const Node& n) { return triangle_has(t, grid, 0.6, 0.6, n); });
        ASSERT_EQ(difference(dense(grid, triangles_region({t}, grid, 0.6, 0.6)), expected), "")
            << "case " << i;
    }
}

TEST(TrianglesRegion, AsksEveryNodeOfAColumnThatIsExactlyAtTheLimit)
{
    // Upright triangles along (4, -3): columns stand 0.6 dp from the plane but for rounding.
    Dice dice(10);
    for (int i = 0; i < cases; ++i)
    {
        LatticeGrid grid = any_grid(dice);
        grid.n = {12, 12, 30};
        const Node a = any_node(dice, grid, 0);
        const std::int64_t k = dice.whole(1, 3);
        const SnappedTriangle t{a,
                                {a.x + 4 * k, a.y - 3 * k, a.z + dice.whole(-9, 9)},
                                {a.x + (dice.coin() ? 4 : 0), a.y, a.z + dice.whole(5, 30)}};
        SnappedTriangle upright = t;
        upright.c = {a.x, a.y, t.c.z};
        for (const SnappedTriangle& triangle : {t, upright})
        {
            const DenseSet expected = where(
                grid, [&](const Node& n) { return triangle_has(triangle, grid, 0.6, 0.6, n); });
            ASSERT_EQ(
                difference(dense(grid, triangles_region({triangle}, grid, 0.6, 0.6)), expected), "")
                << "case " << i;
        }
    }
}

struct Part
{
    std::vector<Plane> planes;
    std::vector<Node> corners;
};

bool is_inside(const Part& part, const LatticeGrid& grid, const Node& n)
{
    if (!is_in_box(n, part.corners)) return false;
    const Vec3 x = position(n, grid);
    return std::all_of(part.planes.begin(), part.planes.end(),
                       [&](const Plane& p) { return p.value(x) > 0; });
}

TEST(SolidRegion, OfFacesIsWhatLiesBehindAllOfThem)
{
    Dice dice(5);
    for (int i = 0; i < cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        PolyhedronOp tetrahedron;
        tetrahedron.solid = SolidKind::Faces;
        std::vector<Node> nodes;
        for (int k = 0; k < 4; ++k)
        {
            nodes.push_back(any_node(dice, grid, 5));
            tetrahedron.vertices.push_back(position(nodes.back(), grid));
        }
        Part part{{}, nodes};
        // Half of the cases are wound inwards and give nothing.
        for (const std::array<std::uint32_t, 3>& f :
             {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
        {
            PolyhedronFace face;
            face.vertices = {f[0], f[1], f[2]};
            tetrahedron.faces.push_back(face);
            part.planes.push_back(plane_through(position(nodes[f[0]], grid),
                                                position(nodes[f[2]], grid),
                                                position(nodes[f[1]], grid)));
        }
        const DenseSet expected =
            where(grid, [&](const Node& n) { return is_inside(part, grid, n); });
        ASSERT_EQ(difference(dense(grid, solid_region(tetrahedron, grid, 0.6, 0.6)), expected), "")
            << "case " << i;
    }
}

TEST(CutPolygon, GoesByTheCornersAsTheyAreDrawn)
{
    // On a lattice of 0.1 the second corner would be cut off first; GenCase v5.4.354 takes the
    // third.
    const std::vector<Vec3> corners{
        {0.718, 0, 0.602}, {0.647, 0, -0.1}, {-0.042, 0, -0.249}, {-0.397, 0, 0.36}};
    const std::array<std::size_t, 3> expected{1, 2, 3};
    EXPECT_EQ(cut_polygon(corners, {0, 1, 2, 3}).at(0), expected);
}

TEST(Snap, RoundsHalvesAwayFromTheOrigin)
{
    LatticeGrid grid;
    grid.dp = 0.1;
    EXPECT_EQ(snap({0.05, -0.05, -0.049}, grid), (Node{1, -1, 0}));
}

TEST(SolidRegion, OfAPrismIsItsPartsAndTheNodesBetweenThem)
{
    Dice dice(6);
    for (int i = 0; i < cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        const auto n = static_cast<std::size_t>(dice.whole(3, 5));
        PolyhedronOp prism;
        prism.solid = SolidKind::Prism;
        const Node up = any_node(dice, grid, 3);
        std::vector<Node> nodes;
        for (std::size_t k = 0; k < n; ++k) nodes.push_back(any_node(dice, grid, 4));
        if (dice.coin())
            for (Node& node : nodes) node.z = nodes[0].z;
        for (std::size_t k = 0; k < n; ++k)
            nodes.push_back(
                {nodes[k].x + up.x, nodes[k].y + up.y, nodes[k].z + up.z + dice.whole(0, 1)});
        for (std::size_t k = 0; k < 2 * n; ++k)
        {
            prism.vertices.push_back(position(nodes[k], grid));
            prism.solid_vertices.push_back(static_cast<std::uint32_t>(k));
        }
        std::vector<std::size_t> polygon(n);
        std::iota(polygon.begin(), polygon.end(), std::size_t{0});
        const auto triangles = cut_polygon(prism.vertices, polygon);
        const auto plane = [&](std::size_t a, std::size_t b, std::size_t c)
        {
            return plane_through(position(nodes[a], grid), position(nodes[b], grid),
                                 position(nodes[c], grid));
        };
        std::vector<Part> parts;
        for (const auto& [a, b, c] : triangles)
        {
            Part part{{plane(a, b, c), plane(n + a, n + c, n + b)}, nodes};
            for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, a}})
                part.planes.push_back(plane(q, p, n + p));
            parts.push_back(part);
        }
        const auto is_drawn_between = [&](const Node& x)
        {
            for (std::size_t t = 0; t < triangles.size(); ++t)
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t u = 0; u < triangles.size(); ++u)
                    {
                        const std::size_t p = triangles[t][k];
                        const std::size_t q = triangles[t][(k + 1) % 3];
                        const auto has = [&](std::size_t v) {
                            return std::find(triangles[u].begin(), triangles[u].end(), v) !=
                                   triangles[u].end();
                        };
                        if (u == t || !has(p) || !has(q)) continue;
                        const Vec3 place = position(x, grid);
                        if (!(parts[t].planes[0].value(place) > 0 &&
                              parts[t].planes[1].value(place) > 0))
                            continue;
                        if (triangle_has({nodes[q], nodes[n + q], nodes[n + p]}, grid, 0.6, 0.6,
                                         x) ||
                            triangle_has({nodes[q], nodes[n + p], nodes[p]}, grid, 0.6, 0.6, x))
                            return true;
                    }
            return false;
        };
        const DenseSet expected =
            where(grid,
                  [&](const Node& x)
                  {
                      return is_drawn_between(x) ||
                             std::any_of(parts.begin(), parts.end(),
                                         [&](const Part& p) { return is_inside(p, grid, x); });
                  });
        // A solid that has no part in the lattice is not looked at further; its faces then have
        // none either.
        ASSERT_EQ(difference(dense(grid, solid_region(prism, grid, 0.6, 0.6)), expected), "")
            << "case " << i;
    }
}

DrawState any_state(Dice& dice)
{
    DrawState state;
    state.mode = dice.one_of({DrawMode::Face, DrawMode::Solid, DrawMode::Full});
    const double width = dice.one_of({0.6, 0.5, 1.0, 0.25, 3.1});
    state.constants.sphere = state.constants.ellipsoid = state.constants.cylinder_tube = width;
    state.constants.cylinder_cover = dice.one_of({0.6, 0.5, 1.5});
    return state;
}

double rounded(double radius, const LatticeGrid& grid)
{
    return std::floor(radius / grid.dp + 0.5) * grid.dp;
}

TEST(SphereRegion, HasTheNodesByTheirDistanceFromTheCentre)
{
    Dice dice(7);
    for (int i = 0; i < cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        const DrawState state = any_state(dice);
        const Vec3 center = position(any_node(dice, grid, 4), grid);
        SphereOp sphere{center,
                        dice.coin() ? static_cast<double>(dice.whole(0, 9)) * grid.dp
                                    : dice.real(0, 12) * grid.dp,
                        {}};
        if (i % 5 == 0) sphere.layers_dp = {0, -1, 2.5};
        const Vec3 c = position(snap(center, grid), grid);
        const auto holds = [&](const Node& n)
        {
            const Vec3 x = position(n, grid);
            const double dx = c.x - x.x;
            const double dy = c.y - x.y;
            const double dz = c.z - x.z;
            const double d = std::sqrt(dx * dx + dy * dy + dz * dz);
            const auto near_shell = [&](double radius)
            { return std::fabs(d - rounded(radius, grid)) < state.constants.sphere * grid.dp; };
            if (!sphere.layers_dp.empty())
                return std::any_of(sphere.layers_dp.begin(), sphere.layers_dp.end(),
                                   [&](double layer)
                                   { return near_shell(sphere.radius + layer * grid.dp); });
            return (state.mode != DrawMode::Solid && near_shell(sphere.radius)) ||
                   (state.mode != DrawMode::Face && d <= sphere.radius);
        };
        ASSERT_EQ(difference(dense(grid, kinds::nodes_of(sphere, state, grid)), where(grid, holds)),
                  "")
            << "case " << i;
    }
}

TEST(CylinderRegion, HasTheNodesByTheirPlaceAlongAndAcrossTheAxis)
{
    Dice dice(8);
    for (int i = 0; i < 2 * cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        const DrawState state = any_state(dice);
        const Node from = any_node(dice, grid, 3);
        Node to = any_node(dice, grid, 3);
        if (i % 3 == 0) to = {from.x, from.y, to.z}; // upright, along columns
        if (i % 7 == 0) to = {to.x, from.y, from.z};
        if (from == to) continue;
        CylinderOp cylinder{
            position(from, grid), position(to, grid), dice.real(0, 7) * grid.dp, {}, {}};
        if (dice.coin()) cylinder.radius = static_cast<double>(dice.whole(0, 6)) * grid.dp;
        cylinder.is_visible = {true, true, true};
        if (i % 4 == 0) cylinder.is_visible = {dice.coin(), dice.coin(), dice.coin()};
        const bool all_visible = cylinder.is_visible == std::array<bool, 3>{true, true, true};
        cylinder.is_masked = !all_visible;
        const Vec3 a = position(from, grid);
        const Vec3 b = position(to, grid);
        const Vec3 axis = b - a;
        const double length = norm(axis);
        const auto holds = [&](const Node& n)
        {
            const Vec3 x = position(n, grid);
            const double at_a = dot(axis, x) + -dot(axis, a);
            const double at_b = dot(axis, x) + -dot(axis, b);
            const double d = norm(cross(a - x, b - x)) / length;
            const bool is_between = at_a >= 0 && at_b <= 0;
            const double cover = state.constants.cylinder_cover * grid.dp;
            const bool is_tube = is_between && std::fabs(d - rounded(cylinder.radius, grid)) <
                                                   state.constants.cylinder_tube * grid.dp;
            const bool is_filled = d <= cylinder.radius;
            if (state.mode != DrawMode::Face && all_visible && is_between && is_filled) return true;
            if (state.mode == DrawMode::Solid && all_visible) return false;
            return (cylinder.is_visible[2] && is_tube) ||
                   (cylinder.is_visible[0] && std::fabs(at_a / length) < cover && is_filled) ||
                   (cylinder.is_visible[1] && std::fabs(at_b / length) < cover && is_filled);
        };
        ASSERT_EQ(
            difference(dense(grid, kinds::nodes_of(cylinder, state, grid)), where(grid, holds)), "")
            << "case " << i;
    }
}

TEST(EllipsoidRegion, HasTheNodesByTheSumOfTheDistancesToTheFoci)
{
    Dice dice(9);
    for (int i = 0; i < cases; ++i)
    {
        const LatticeGrid grid = any_grid(dice);
        const DrawState state = any_state(dice);
        const Node f0 = any_node(dice, grid, 3);
        const Node f1 = any_node(dice, grid, 3);
        const double radius = dice.coin() ? static_cast<double>(dice.whole(0, 25)) * grid.dp
                                          : dice.real(0, 30) * grid.dp;
        const auto holds = [&](const Node& n)
        {
            const auto distance = [&](const Node& f)
            {
                const double dx = static_cast<double>(n.x - f.x) * grid.stretch.x;
                const double dy = static_cast<double>(n.y - f.y) * grid.stretch.y;
                const double dz = static_cast<double>(n.z - f.z) * grid.stretch.z;
                return std::sqrt(dx * dx + dy * dy + dz * dz);
            };
            const double sum = distance(f0) + distance(f1);
            const double middle = std::floor(radius / grid.dp + 0.5);
            const double width = state.constants.sphere;
            if (state.mode == DrawMode::Solid) return sum <= radius / grid.dp;
            return sum < middle + width && (state.mode == DrawMode::Full || sum > middle - width);
        };
        const EllipsoidOp ellipsoid{position(f0, grid), position(f1, grid), radius};
        ASSERT_EQ(
            difference(dense(grid, kinds::nodes_of(ellipsoid, state, grid)), where(grid, holds)),
            "")
            << "case " << i;
    }
}

} // namespace
} // namespace fppg
