#include "shapes/shape_mesh.h"
#include "meshes/round_surface.h"

#include "core/transforms.h"
#include "fppg/error.h"
#include "meshes/test_shapes.h"
#include "shapes/polyhedra.h"
#include "shapes/round_facets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

constexpr double pi = std::numbers::pi;
constexpr double dp = 0.01;

LatticeGrid grid()
{
    LatticeGrid out;
    out.dp = dp;
    return out;
}

DrawOp op_of(const Command& what, DrawMode mode = DrawMode::Solid, bool normal_invert = false)
{
    DrawState state;
    state.mode = mode;
    state.normal_invert = normal_invert;
    DrawOp op;
    op.what = what;
    op.state = std::make_shared<const DrawState>(state);
    return op;
}

std::vector<ShapeMesh> meshes(const Command& what, DrawMode mode = DrawMode::Solid,
                              bool normal_invert = false)
{
    return shape_meshes(op_of(what, mode, normal_invert), nullptr, grid());
}

struct Taken
{
    SurfaceMesh mesh;
    MeshReport report;
    Features features;
};

Taken taken(const ShapeMesh& shape)
{
    Taken out;
    out.mesh = repair_mesh(shape.soup, {}, 1, out.report);
    out.features = find_features(out.mesh, {});
    return out;
}

/// A solid whose facets need neither turning nor mending.
void expect_solid(const std::vector<ShapeMesh>& shapes, double volume)
{
    ASSERT_EQ(shapes.size(), 1U);
    EXPECT_TRUE(shapes[0].is_solid);
    const Taken t = taken(shapes[0]);
    EXPECT_TRUE(t.report.is_watertight);
    EXPECT_EQ(t.report.open_edges, 0U);
    EXPECT_EQ(t.report.flipped_facets, 0U);
    EXPECT_NEAR(t.report.volume, volume, 1e-12 * volume);
}

constexpr std::array<bool, 6> all_sides{true, true, true, true, true, true};

PolyhedronOp solid_box()
{
    return make_box({0.1, 0.2, 0.3}, {1, 2, 3}, all_sides, true, {}, dp)[0];
}

std::vector<Vec3> star(int corners, double z)
{
    std::vector<Vec3> out;
    for (int i = 0; i < corners; ++i)
    {
        const double angle = 2 * pi * i / corners;
        const double r = i % 2 == 0 ? 1.0 : 0.4;
        out.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
    return out;
}

double area_of(const std::vector<Vec3>& polygon)
{
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const Vec3& a = polygon[i];
        const Vec3& b = polygon[(i + 1) % polygon.size()];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return sum;
}

/// An L of eight triangles and more, seen from outside counter-clockwise.
PolyhedronOp l_polyhedron()
{
    const std::vector<Vec3> outline{{0, 0, 0}, {2, 0, 0}, {2, 0, 1},
                                    {1, 0, 1}, {1, 0, 2}, {0, 0, 2}};
    PolyhedronOp polyhedron;
    polyhedron.solid = SolidKind::Faces;
    polyhedron.vertices = outline;
    for (const Vec3& p : outline) polyhedron.vertices.push_back(p + Vec3{0, 0.5, 0});
    const auto add = [&](std::vector<std::uint32_t> v) {
        polyhedron.faces.push_back({std::move(v), true, {}, 0, {}});
    };
    for (const auto& [a, b, c, d] :
         {std::array<std::uint32_t, 4>{0, 1, 2, 3}, std::array<std::uint32_t, 4>{0, 3, 4, 5}})
    {
        add({a, b, c});
        add({a, c, d});
        add({a + 6, c + 6, b + 6});
        add({a + 6, d + 6, c + 6});
    }
    for (std::uint32_t i = 0; i < 6; ++i)
    {
        const std::uint32_t j = (i + 1) % 6;
        add({j, i, i + 6});
        add({j, i + 6, j + 6});
    }
    return polyhedron;
}

TEST(ShapeMeshes, ASolidBoxHasTwelveLinesAndEightCorners)
{
    const auto shapes = meshes(solid_box());
    expect_solid(shapes, 6);
    const Taken t = taken(shapes[0]);
    EXPECT_EQ(t.report.facets_read, 12U);
    EXPECT_EQ(t.features.lines.size(), 12U);
    EXPECT_EQ(t.features.singular.size(), 8U);
    for (const Vec3& v : t.mesh.vertices)
        EXPECT_TRUE((v.x == 0.1 || v.x == 1.1) && (v.y == 0.2 || v.y == 2.2)) << v.x << " " << v.y;
}

TEST(ShapeMeshes, AMirroredOrTurnedFigureStillLooksOutward)
{
    for (const Vec3& scale : {Vec3{-1, 1, 1}, Vec3{1, 2, -0.5}, Vec3{-1, -1, -1}, Vec3{3, 1, 1}})
        for (const PolyhedronOp& polyhedron : {solid_box(), l_polyhedron()})
        {
            PolyhedronOp moved = polyhedron;
            transform_polyhedron(moved, rotation({1, 2, 3}, 0.7) * scaling(scale));
            const double volume = polyhedron.solid == SolidKind::Box ? 6 : 1.5;
            expect_solid(meshes(moved), volume * std::fabs(scale.x * scale.y * scale.z));
        }
}

TEST(ShapeMeshes, AMirroredOpenBoxStillLooksOutward)
{
    PolyhedronOp box =
        make_box({}, {1, 1, 1}, {true, true, true, true, true, false}, false, {}, dp)[0];
    transform_polyhedron(box, scaling({-1, 1, 1}));
    const auto shapes = meshes(box, DrawMode::Face);
    ASSERT_EQ(shapes.size(), 1U);
    EXPECT_EQ(shapes[0].soup.size(), 10U);
    const TriangleSoup& soup = shapes[0].soup;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* p = &soup.vertices[3 * f];
        const Vec3 middle = (p[0] + p[1] + p[2]) / 3;
        EXPECT_GT(dot(cross(p[1] - p[0], p[2] - p[0]), middle - Vec3{-0.5, 0.5, 0.5}), 0);
    }
}

TEST(ShapeMeshes, PrismsOfAnyOutlineAreWatertight)
{
    for (const int n : {3, 4, 7, 8, 12})
    {
        std::vector<Vec3> points = star(n, 0);
        // An odd star has two long corners side by side.
        const double area = area_of(points);
        for (const Vec3& p : star(n, 1.5)) points.push_back(p);
        PolyhedronOp prism = make_prism(points);
        transform_polyhedron(prism, translation({3, 1, 2}) * rotation({1, -1, 2}, 1.1));
        expect_solid(meshes(prism), area * 1.5);
        expect_solid(meshes(prism, DrawMode::Full), area * 1.5);
    }
}

TEST(ShapeMeshes, APyramidIsWatertight)
{
    std::vector<Vec3> points{{0.2, 0.1, 2}};
    for (const Vec3& p : star(10, 0)) points.push_back(p);
    expect_solid(meshes(make_pyramid(points)), area_of(star(10, 0)) * 2 / 3);
    expect_solid(meshes(make_pyramid({{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})),
                 1.0 / 3);
}

TEST(ShapeMeshes, ATwistedPrismIsWatertightThoughItsSidesAreNotPlane)
{
    std::vector<Vec3> points = star(7, 0);
    for (const Vec3& p : star(7, 1)) points.push_back(rotation({0, 0, 1}, 0.4)(p));
    const auto shapes = meshes(make_prism(points));
    const Taken t = taken(shapes[0]);
    EXPECT_TRUE(t.report.is_watertight);
    EXPECT_GT(t.report.volume, 0);
    EXPECT_EQ(t.report.flipped_facets, 0U);
}

TEST(ShapeMeshes, AnLOfTrianglesKeepsItsNotch)
{
    expect_solid(meshes(l_polyhedron()), 1.5);
    const Taken t = taken(meshes(l_polyhedron())[0]);
    EXPECT_EQ(t.features.lines.size(), 18U);
    EXPECT_EQ(t.features.singular.size(), 12U);
}

TEST(ShapeMeshes, FaceModeGivesVisibleFacesAndNoSolid)
{
    const PolyhedronOp open =
        make_box({}, {1, 1, 1}, {true, false, true, true, true, true}, false, {}, dp)[0];
    for (const DrawMode mode : {DrawMode::Face, DrawMode::Solid, DrawMode::Full})
    {
        const auto shapes = meshes(open, mode);
        ASSERT_EQ(shapes.size(), 1U);
        EXPECT_FALSE(shapes[0].is_solid);
        EXPECT_EQ(taken(shapes[0]).report.open_edges, 4U);
    }
    const auto closed = meshes(solid_box(), DrawMode::Face);
    EXPECT_FALSE(closed[0].is_solid);
    EXPECT_TRUE(taken(closed[0]).report.is_watertight);
    PolyhedronOp masked = solid_box();
    hide_faces(masked, {1, 4});
    EXPECT_EQ(meshes(masked)[0].soup.size(), 8U);
}

TEST(ShapeMeshes, APolygonIsCutInsideItsOutline)
{
    std::vector<Vec3> points = star(9, 0);
    for (Vec3& p : points) p = rotation({1, 1, 0}, 0.3)(p * (0.3 * dp));
    const auto shapes = meshes(make_polygon(points));
    EXPECT_EQ(shapes[0].soup.size(), 7U);
    const double scale = 0.3 * dp;
    EXPECT_NEAR(taken(shapes[0]).report.area, area_of(star(9, 0)) * scale * scale,
                1e-10 * scale * scale);
}

TEST(ShapeMeshes, NormalInvertTurnsSurfacesAndNotSolids)
{
    PolyhedronOp triangle;
    triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.faces.push_back({{0, 1, 2}, true, {}, 0, {}});
    const auto up = taken(meshes(triangle)[0]).mesh.normals[0];
    const auto down = taken(meshes(triangle, DrawMode::Solid, true)[0]).mesh.normals[0];
    EXPECT_EQ(up.z, 1);
    EXPECT_EQ(down.z, -1);
    expect_solid(meshes(solid_box(), DrawMode::Solid, true), 6);
}

TEST(ShapeMeshes, RoundShapesAreSolidUnlessInFaceMode)
{
    const double r = 5 * dp;
    const SphereOp sphere{{1, 1, 1}, r, {}};
    const CylinderOp cylinder{{0, 0, 0}, {0, 0.3, 0}, r, {true, true, true}, {}};
    const EllipsoidOp ellipsoid{{0, 0, 0}, {r, 0, 0}, 2 * r};
    for (const Command& what : {Command(sphere), Command(cylinder), Command(ellipsoid)})
        for (const DrawMode mode : {DrawMode::Face, DrawMode::Solid, DrawMode::Full})
        {
            const auto shapes = meshes(what, mode);
            ASSERT_EQ(shapes.size(), 1U);
            EXPECT_EQ(shapes[0].is_solid, mode != DrawMode::Face);
            EXPECT_NE(shapes[0].round, nullptr);
            EXPECT_TRUE(taken(shapes[0]).report.is_watertight);
        }
    EXPECT_FALSE(meshes(CylinderOp{{}, {0, 0, 1}, r, {true, false, true}, {}, true})[0].is_solid);
}

TEST(ShapeMeshes, LayersAreShellsAroundTheShape)
{
    const auto spheres = meshes(SphereOp{{1, 1, 1}, 0.1, {0, 1, -2.5}});
    ASSERT_EQ(spheres.size(), 3U);
    EXPECT_DOUBLE_EQ(spheres[1].round->size, 0.1 + dp);
    EXPECT_DOUBLE_EQ(spheres[2].round->size, 0.1 - 2.5 * dp);
    EXPECT_FALSE(spheres[0].is_solid);
    const auto pipes = meshes(CylinderOp{{0, 0, 0},
                                         {0, 0, 1},
                                         0.1,
                                         {true, false, true},
                                         {{{0, 0, -2 * dp}, {0, 0, 1}, 0.1 + 2 * dp}}});
    ASSERT_EQ(pipes.size(), 1U);
    const Box3 bounds = taken(pipes[0]).report.bounds;
    EXPECT_DOUBLE_EQ(bounds.min.z, -2 * dp);
    EXPECT_EQ(bounds.max.z, 1);
    EXPECT_NEAR(bounds.max.x, 0.1 + 2 * dp, chord_error_dp * dp);
    EXPECT_THROW(meshes(SphereOp{{}, 0.1, {-20}}), GeometryError);
}

TEST(ShapeMeshes, AFileIsMovedAndStaysOutward)
{
    MeshFileOp op;
    op.transform = translation({1, 2, 3}) * rotation({0, 1, 1}, 0.5) * scaling({1, 1, -2});
    op.autofill = true;
    MeshFile cube;
    cube.soup = test::box({0, 0, 0}, {1, 1, 1});
    expect_solid(shape_meshes(op_of(op), &cube, grid()), 2);
    op.autofill = false;
    const auto shell = shape_meshes(op_of(op, DrawMode::Face), &cube, grid());
    EXPECT_FALSE(shell[0].is_solid);
    EXPECT_EQ(shell[0].round, nullptr);
}

TEST(ShapeMeshes, WhatStaysOnTheLatticeGivesNone)
{
    EXPECT_TRUE(meshes(PointsOp{{{0, 0, 0}}}).empty());
    EXPECT_TRUE(meshes(LinesOp{{{Vec3{}, Vec3{1, 0, 0}}}}).empty());
    EXPECT_TRUE(meshes(FillOp{}).empty());
    EXPECT_TRUE(meshes(RedrawOp{}).empty());
    EXPECT_TRUE(meshes(ResetOp{}).empty());
    EXPECT_TRUE(meshes(solid_box(), DrawMode::Wire).empty());
    EXPECT_TRUE(meshes(CylinderOp{{}, {}, 0.1, {true, true, true}, {}}).empty());
    EXPECT_TRUE(meshes(EllipsoidOp{{}, {1, 0, 0}, 0.5}).empty());
}

TEST(ShapeMeshes, PartsOfASurfaceComeOneByOneAndPartsOfASolidAreRefused)
{
    PolyhedronOp box = make_box({}, {1, 1, 1}, all_sides, false, {}, dp)[0];
    box.part_count = count_parts(box, DrawMode::Face);
    ASSERT_EQ(box.part_count, 6U);
    double area = 0;
    for (box.part = 0; box.part < 6; ++box.part)
    {
        const auto shapes = meshes(box, DrawMode::Face);
        ASSERT_EQ(shapes.size(), 1U);
        EXPECT_EQ(shapes[0].soup.size(), 2U);
        area += taken(shapes[0]).report.area;
    }
    EXPECT_NEAR(area, 6, 1e-12);
    PolyhedronOp solid = solid_box();
    solid.part_count = count_parts(solid, DrawMode::Solid);
    EXPECT_THROW(meshes(solid), GeometryError);
}

} // namespace
} // namespace fppg
