// drawtorus, a command of fppg's own, in all that can be asked of a shape.
#include "fppg/error.h"
#include "fppg/lattice.h"

#include "core/transforms.h"
#include "helpers/case_text.h"
#include "helpers/dense_grid.h"
#include "helpers/drawing.h"
#include "meshes/round_surface.h"
#include "scene/exact_body.h"
#include "scene/shape_cells.h"
#include "shapes/round_facets.h"
#include "shapes/solid_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

using test::Drawing;

constexpr double pi = std::numbers::pi;
constexpr double dp = Drawing::dp;

/// The distance of a point from the circle in the middle of a tube.
double from_circle(const Vec3& p, const Vec3& center, const Vec3& axis, double radius)
{
    const double height = dot(p - center, axis);
    return std::hypot(norm(p - center - axis * height) - radius, height);
}

double volume_of(double radius, double tube)
{
    return 2 * pi * pi * radius * tube * tube;
}

/// Nodes of an mk, covered ones not.
template <typename Visit>
void for_each_node(const RunField& field, const Visit& visit)
{
    for (std::size_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& r : field.slabs[x])
            for (std::uint32_t z = r.z_begin; z < r.z_end && !r.is_covered; ++z)
                visit(position({static_cast<std::int64_t>(x), r.y, z}, field.grid));
}

CaseDef case_with(const std::string& mainlist, const std::string& after = "",
                  const std::string& dp_text = "0.05")
{
    const test::TemporaryFolder folder;
    test::CaseText text;
    text.dp = dp_text;
    text.mainlist = "<setmkbound mk=\"0\" />" + mainlist;
    text.after_geometry = after;
    test::write_text(folder / "Case_Def.xml", text.text());
    return read_case(folder / "Case_Def.xml", {});
}

std::string torus_command(const std::string& attributes, const std::string& children)
{
    return "<drawtorus " + attributes + ">" + children + "</drawtorus>";
}

const std::string upright = R"(<point x="0.4" y="0.4" z="0.4" /><vector x="0" y="0" z="2" />)";

std::string error_of(const std::string& mainlist)
{
    try
    {
        case_with(mainlist);
    }
    catch (const CaseError& error)
    {
        return error.what();
    }
    return "";
}

TEST(Torus, HasTheNodesByTheirDistanceFromTheCircle)
{
    test::Dice dice(19);
    for (int i = 0; i < 400; ++i)
    {
        const LatticeGrid grid = test::any_grid(dice);
        DrawState state;
        state.mode = dice.one_of({DrawMode::Face, DrawMode::Solid, DrawMode::Full});
        state.constants.sphere = dice.one_of({0.6, 0.5, 1.0});
        const Vec3 center = position(test::any_node(dice, grid, 3), grid);
        const Vec3 axis = dice.coin()
                              ? Vec3{0, 0, 1}
                              : unit({dice.real(-1, 1), dice.real(-1, 1), dice.real(-1, 1)});
        const double radius = dice.real(1, 12) * grid.dp;
        const double tube = dice.real(0.1, 1) * radius;
        const Vec3 off{dice.real(-0.4, 0.4), dice.real(-0.4, 0.4), dice.real(-0.4, 0.4)};
        const SolidOp torus = make_torus(center + off * grid.dp, axis, radius, tube);
        const double shell = std::floor(tube / grid.dp + 0.5) * grid.dp;
        const auto holds = [&](const Node& n)
        {
            const double s = from_circle(position(n, grid), center, axis, radius);
            const bool is_in = s <= tube;
            const bool is_near = std::fabs(s - shell) < state.constants.sphere * grid.dp;
            return (is_in && state.mode != DrawMode::Face) ||
                   (is_near && state.mode != DrawMode::Solid);
        };
        ASSERT_EQ(test::difference(test::dense(grid, torus.shape->nodes(state, grid)),
                                   test::where(grid, holds)),
                  "")
            << "case " << i;
    }
}

TEST(Torus, FillsItsVolumeOnTheLattice)
{
    const CaseDef def =
        case_with(torus_command("radius=\"0.4\" tube=\"0.2\"", upright), "", "0.02");
    LatticeReport report;
    double nodes = 0;
    for_each_node(draw_scene(make_scene(def), 2, {}, report), [&](const Vec3&) { ++nodes; });
    EXPECT_NEAR(nodes * 8e-6 / volume_of(0.4, 0.2), 1, 0.02);
}

TEST(Torus, HasParticlesOnTheExactSurfaceAndItsVolume)
{
    for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{1, 2, -2} / 3})
    {
        Drawing drawing;
        const Vec3 center{0.03, -0.02, 0.01};
        drawing.draw(make_torus(center, axis, 1.0, 0.55));
        const RunField field = drawing.run(2);
        const WallParticles& wall = field.walls.particles;
        ASSERT_GT(wall.size(), 1500U);
        for (const Vec3& p : wall.positions)
            EXPECT_NEAR(from_circle(p, center, axis, 1.0), 0.55, 1e-9 * dp);
        double nodes = 0.5 * static_cast<double>(wall.size());
        for_each_node(field,
                      [&](const Vec3& p)
                      {
                          ++nodes;
                          EXPECT_LE(from_circle(p, center, axis, 1.0), 0.55 - 0.49 * dp);
                      });
        EXPECT_NEAR(nodes * dp * dp * dp / volume_of(1.0, 0.55), 1, 0.02);
    }
}

TEST(Torus, InTwoDimensionsIsItsSection)
{
    for (const bool is_upright : {true, false})
    {
        Drawing drawing(true);
        // Two circles, or a ring.
        const Vec3 axis = is_upright ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
        drawing.draw(make_torus({0.03, 0, 0.01}, axis, 1.1, 0.5));
        const RunField field = drawing.run();
        const WallParticles& wall = field.walls.particles;
        const double length = is_upright ? 2 * 2 * pi * 0.5 : 2 * pi * (1.6 + 0.6);
        EXPECT_NEAR(static_cast<double>(wall.size()) * dp / length, 1, 0.03);
        for (const Vec3& p : wall.positions)
        {
            EXPECT_EQ(p.y, 0);
            EXPECT_NEAR(from_circle(p, {0.03, 0, 0.01}, axis, 1.1), 0.5, 1e-9 * dp);
        }
        double nodes = 0.5 * static_cast<double>(wall.size());
        for_each_node(field, [&](const Vec3&) { ++nodes; });
        const double area = is_upright ? 2 * pi * 0.25 : pi * (1.6 * 1.6 - 0.6 * 0.6);
        EXPECT_NEAR(nodes * dp * dp / area, 1, 0.02);
    }
}

TEST(Torus, HasAClosedSmoothMeshWithinTheChordError)
{
    for (const double tube_dp : {0.4, 2.0, 9.0})
        for (const double ratio : {1.2, 3.0, 40.0})
        {
            const double tube = tube_dp * dp;
            const double radius = ratio * tube;
            const ShapeMesh shape =
                make_torus({1, -2, 0.5}, Vec3{2, -1, 2} / 3, radius, tube).shape->surface(dp);
            MeshReport report;
            const SurfaceMesh mesh = repair_mesh(shape.soup, {}, 1, report);
            EXPECT_TRUE(report.is_watertight);
            EXPECT_EQ(report.degenerate_facets, 0U);
            EXPECT_EQ(report.shells, 1U);
            EXPECT_TRUE(find_features(mesh, {}).edges.empty());
            const double area = 4 * pi * pi * radius * tube;
            EXPECT_NEAR(report.volume, volume_of(radius, tube), area * chord_error_dp * dp);
            for (const auto& f : mesh.facets)
            {
                const Vec3 middle =
                    (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
                EXPECT_LE(std::fabs(shape.round->level_at(middle).value),
                          1.01 * chord_error_dp * dp);
            }
        }
}

TEST(Torus, HasTheMomentsOfItsBodyAndItsBounds)
{
    const Vec3 center{0.4, 0.3, -0.2};
    const Vec3 axis = Vec3{1, -2, 2} / 3;
    const SolidOp torus = make_torus(center, axis, 0.7, 0.3);
    const ExactBody exact = torus.shape->moments();
    EXPECT_NEAR(exact.volume, volume_of(0.7, 0.3), 1e-12);
    const TriangleSoup soup = torus.shape->surface(0.02).soup;
    const ExactBody mesh = body_of_facets(soup);
    EXPECT_NEAR(mesh.volume / exact.volume, 1, 1e-3);
    EXPECT_NEAR(norm(mesh.center - exact.center), 0, 1e-6);
    for (std::size_t i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(mesh.inertia[i][j], exact.inertia[i][j], 1e-3 * exact.inertia[0].x);
    Box3 box;
    for (const Vec3& v : soup.vertices) box.add(v);
    EXPECT_NEAR(norm(box.min - torus.shape->bounds().min), 0, 1e-3);
    EXPECT_NEAR(norm(box.max - torus.shape->bounds().max), 0, 1e-3);
}

TEST(Torus, GivesAFloatingBodyItsExactMassAndCentre)
{
    const CaseDef def = case_with(torus_command("radius=\"0.4\" tube=\"0.2\"", upright));
    const Scene scene = make_scene(def);
    std::string why_not;
    const auto body = exact_body(scene, def.mk_bound_first, true, why_not);
    ASSERT_TRUE(body) << why_not;
    EXPECT_NEAR(body->volume, volume_of(0.4, 0.2), 1e-12);
    EXPECT_EQ(body->center, (Vec3{0.4, 0.4, 0.4}));
    EXPECT_EQ(body->shape, "<drawtorus> of line 7");
}

TEST(Torus, IsMovedAndTurnedByTheMatrixAndKeepsItsRadii)
{
    const CaseDef def = case_with(
        R"(<move x="0.1" y="0" z="0" /><scale x="2" y="2" z="2" /><rotate ang="90" x="1" y="0" z="0" />)" +
        torus_command("radius=\"0.2\" tube=\"0.1\"",
                      R"(<point x="0.2" y="0" z="0" /><point x="0.2" y="0" z="1" />)"));
    const Box3 box = bounds_of(std::get<Shape>(def.ops.at(0).what), 0.05);
    EXPECT_NEAR(norm(box.min - Vec3{0.2, -0.1, -0.3}), 0, 1e-12);
    EXPECT_NEAR(norm(box.max - Vec3{0.8, 0.1, 0.3}), 0, 1e-12);
}

TEST(Torus, IsShownInShapeFiles)
{
    const CaseDef def = case_with(torus_command("radius=\"0.4\" tube=\"0.13\"", upright));
    const Scene scene = make_scene(def);
    ASSERT_TRUE(has_shape_cells(def.ops.at(0).what));
    for (const bool is_snapped : {false, true})
    {
        const std::vector<ShapeCell> cells = shape_cells(scene, def.ops.at(0), is_snapped);
        ASSERT_EQ(cells.size(), 24U * 24U);
        for (const ShapeCell& cell : cells)
        {
            ASSERT_EQ(cell.size(), 4U);
            const Vec3 out = cross(cell[1] - cell[0], cell[2] - cell[0]);
            const Vec3 to_axis = Vec3{0.4, 0.4, 0.4} - cell[0];
            const Vec3 rim = unit({-to_axis.x, -to_axis.y, 0}) * 0.4;
            EXPECT_GT(dot(out, cell[0] - (Vec3{0.4, 0.4, 0.4} + rim)), 0);
            for (const Vec3& corner : cell)
                EXPECT_NEAR(from_circle(corner, {0.4, 0.4, 0.4}, {0, 0, 1}, 0.4),
                            is_snapped ? 0.15 : 0.13, 1e-12);
        }
    }
}

TEST(Torus, IsRefusedWithFileLineAndElement)
{
    const auto has = [](const std::string& error, const std::string& text)
    { return error.find("Case_Def.xml:7: <drawtorus>: " + text) != std::string::npos; };
    const auto with = [](const std::string& attributes)
    { return error_of(torus_command(attributes, upright)); };
    EXPECT_TRUE(has(with("radius=\"0\" tube=\"0.1\""), "radius is 0, expected above 0"));
    EXPECT_TRUE(has(with("radius=\"0.2\" tube=\"0.2\""),
                    "tube is 0.2, expected above 0 and below the radius of 0.2"))
        << with("radius=\"0.2\" tube=\"0.2\"");
    EXPECT_TRUE(has(with("radius=\"0.2\" tube=\"-1\""), "tube is -1, expected above 0"));
    EXPECT_TRUE(has(with("radius=\"0.2\""), "attribute 'tube' is missing"));
    const std::string sizes = "radius=\"0.2\" tube=\"0.1\"";
    EXPECT_TRUE(has(error_of(torus_command(sizes, R"(<point x="0" y="0" z="0" />)")),
                    "expected its centre as <point> and its axis"));
    EXPECT_TRUE(has(error_of(torus_command(sizes, upright + R"(<point x="0" y="0" z="0" />)")),
                    "expected its centre as <point> and its axis"));
    EXPECT_TRUE(has(error_of(torus_command(sizes, R"(<point x="0" y="0" z="0" />)" + upright +
                                                      R"(<point x="1" y="0" z="0" />)")),
                    "has 3 points, expected 1 to 2"));
    EXPECT_TRUE(has(
        error_of(torus_command(sizes, R"(<point x="1" y="0" z="0" /><point x="1" y="0" z="0" />)")),
        "its axis has no direction"));
    EXPECT_TRUE(has(error_of("<setdrawmode mode=\"wire\" />" + torus_command(sizes, upright)),
                    "draw mode wire is not possible for a torus"));
    EXPECT_NE(error_of(torus_command(sizes, upright + "<layers vdp=\"1\" />"))
                  .find("<layers>: <drawtorus> has no such element"),
              std::string::npos);
}

TEST(Torus, WarnsOnTheLatticeThatGenCaseDoesNotKnowIt)
{
    const std::string torus = torus_command("radius=\"0.4\" tube=\"0.1\"", upright);
    const CaseDef def = case_with(torus + torus);
    ASSERT_EQ(def.warnings.size(), 1U);
    EXPECT_NE(def.warnings[0].find("Case_Def.xml:7: <drawtorus>: is a command of fppg's own; "
                                   "GenCase does not know it"),
              std::string::npos)
        << def.warnings[0];
}

} // namespace
} // namespace fppg
