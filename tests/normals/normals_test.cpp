#include "fppg/normals.h"

#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/scene.h"

#include "helpers/case_text.h"
#include "particles/initials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

namespace fppg
{
namespace
{

using test::box_command;
using test::CaseText;

/// Particles of a case with their normals; dp = 0.1, h = 0.1 sqrt(3) in 3-D, 0.1 sqrt(2) in 2-D.
struct Made
{
    CaseDef def;
    CaseParticles particles;
    std::vector<std::array<float, 3>> normals;
    NormalsReport report;

    /// The normal of the boundary particle at a place, in dp.
    Vec3 at(double x, double y, double z) const
    {
        for (const ParticleBlock& block : particles.blocks)
        {
            std::uint64_t id = block.begin;
            for (const ParticleRun& run : block.runs)
                for (std::uint32_t k = 0; k < run.count; ++k, ++id)
                {
                    const Vec3 p =
                        particles.grid.origin + Vec3{run.x * 0.1, run.y * 0.1, (run.z + k) * 0.1};
                    if (norm(p - Vec3{x, y, z}) > 1e-6) continue;
                    const auto& n = normals.at(id);
                    return Vec3{n[0], n[1], n[2]} / 0.1;
                }
        }
        throw std::runtime_error("no particle there");
    }
};

Made make(const CaseText& text, const std::vector<ShapePolygons>& geometry = {}, int threads = 1)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    CaseOptions options;
    options.case_name = "Case";
    Made made;
    made.def = read_case(folder / "Case_Def.xml", options);
    LatticeReport lattice;
    RunField field = draw_scene(make_scene(made.def), threads, {}, lattice);
    CaseConstants constants;
    std::vector<std::string> warnings;
    made.particles = make_particles(made.def, field, threads, constants, warnings);
    made.normals = compute_normals(made.def, made.particles, field, geometry, threads, made.report);
    return made;
}

/// Boundary particles from 0 to 0.5 (mkbound 0), and as many from x = 0.8 on (mkbound 1).
CaseText blocks(const std::string& normals)
{
    CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="0.5" y="0.5" z="0.5")") +
                    R"(<setmkbound mk="1" />)" +
                    box_command(R"(x="0.8" y="0" z="0")", R"(x="0.5" y="0.5" z="0.5")");
    text.after_geometry = "<normals>" + normals + "</normals>";
    return text;
}

/// The same in one layer, y = 0: a floor of three rows, z from 0 to 0.2, and what stands on it.
CaseText floor_2d(const std::string& more, const std::string& normals)
{
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.5" y="0" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0" z="1.5" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                    box_command(R"(x="0" y="-1" z="0")", R"(x="0.6" y="2" z="0.2")") + more;
    text.after_geometry = "<normals>" + normals + "</normals>";
    return text;
}

void expect_vector(const Vec3& found, const Vec3& wanted, double tolerance = 1e-5)
{
    EXPECT_LE(norm(found - wanted), tolerance)
        << found.x << ' ' << found.y << ' ' << found.z << ", expected " << wanted.x << ' '
        << wanted.y << ' ' << wanted.z;
}

ShapePolygons polygon(const std::vector<Vec3>& corners)
{
    ShapePolygons shape;
    shape.vertices = corners;
    shape.polygons.emplace_back();
    for (std::uint32_t i = 0; i < corners.size(); ++i) shape.polygons[0].push_back(i);
    return shape;
}

/// A face that looks upwards, 0.55 high, and one that looks towards +x at x = 0.55.
ShapePolygons top()
{
    return polygon({{-1, -1, 0.55}, {2, -1, 0.55}, {2, 2, 0.55}, {-1, 2, 0.55}});
}
ShapePolygons right_side()
{
    return polygon({{0.55, -1, -1}, {0.55, 2, -1}, {0.55, 2, 2}, {0.55, -1, 2}});
}

constexpr const char* geometry_of_2h =
    R"(<norgeometry><geometryfile file="shape.vtk" /></norgeometry>)";

TEST(NormalsOfGeometry, LeadToThePlaneInFrontAndNoFartherThanTheReach)
{
    // 2 h is 3.46 dp.
    const Made made = make(blocks(geometry_of_2h), {top()});
    expect_vector(made.at(0.2, 0.2, 0.5), {0, 0, 0.5});
    expect_vector(made.at(0.2, 0.2, 0.3), {0, 0, 2.5});
    expect_vector(made.at(0.2, 0.2, 0.2), {0, 0, 0});
}

TEST(NormalsOfGeometry, AreNoneInFrontOfAFace)
{
    ShapePolygons under = top();
    for (Vec3& v : under.vertices) v.z = -0.05;
    const Made made = make(blocks(geometry_of_2h), {under});
    expect_vector(made.at(0.2, 0.2, 0), {0, 0, 0});
}

TEST(NormalsOfGeometry, LeadToTheEdgeWhereTwoFacesAreEquallyNear)
{
    const Made made = make(blocks(geometry_of_2h), {top(), right_side()});
    expect_vector(made.at(0.5, 0.2, 0.5), {0.5, 0, 0.5});
    expect_vector(made.at(0.4, 0.2, 0.4), {1.5, 0, 1.5});
    expect_vector(made.at(0.4, 0.2, 0.5), {0, 0, 0.5});
}

TEST(NormalsOfGeometry, LeadToTheNearestPointOfAFaceThatDoesNotReachOver)
{
    const ShapePolygons roof =
        polygon({{0.25, -1, 0.55}, {2, -1, 0.55}, {2, 2, 0.55}, {0.25, 2, 0.55}});
    const Made made = make(blocks(geometry_of_2h), {roof});
    expect_vector(made.at(0.2, 0.2, 0.5), {0.5, 0, 0.5});
    expect_vector(made.at(0.1, 0.2, 0.5), {1.5, 0, 0.5});
}

TEST(NormalsOfGeometry, PreferAFaceInFrontToANearerEdge)
{
    const ShapePolygons strip =
        polygon({{0.25, -1, 0.52}, {0.28, -1, 0.52}, {0.28, 2, 0.52}, {0.25, 2, 0.52}});
    const Made made = make(blocks(geometry_of_2h), {strip, top()});
    expect_vector(made.at(0.2, 0.2, 0.3), {0, 0, 2.5});
}

TEST(NormalsOfGeometry, SeeTheInsideOfAFaceWhoseDirectionFavoursNoAxis)
{
    // Through (0.7, 0, 0), (0, 0.7, 0), (0, 0, 0.7), outwards (1, 1, 1).
    const Made made =
        make(blocks(geometry_of_2h), {polygon({{0.7, 0, 0}, {0, 0.7, 0}, {0, 0, 0.7}})});
    expect_vector(made.at(0.2, 0.2, 0.2), {1.0 / 3, 1.0 / 3, 1.0 / 3}, 1e-4);
}

TEST(NormalsOfGeometry, AreShortenedToTheGivenSizeAndCounted)
{
    const Made made =
        make(blocks(R"(<norgeometry><geometryfile file="shape.vtk" /><distanceh v="2" />)"
                    R"(<maxsizeh v="1" /></norgeometry>)"),
             {top()});
    expect_vector(made.at(0.2, 0.2, 0.3), {0, 0, std::sqrt(3.0)});
    expect_vector(made.at(0.2, 0.2, 0.5), {0, 0, 0.5});
    bool told = false;
    // Of three layers within reach the one of 2.5 dp is longer than 1.73 dp: 2 blocks of 36.
    for (const std::string& line : made.report.log)
        told = told || line.find("Resizes 72/432") != std::string::npos;
    EXPECT_TRUE(told);
}

TEST(NormalsOfGeometry, RunBeforeTheOtherCommandsWhereverTheyStand)
{
    const Made made = make(blocks(std::string(R"(<norset mkbound="1"><normal x="0" y="0" z="9" />)"
                                              "</norset>") +
                                  geometry_of_2h),
                           {top()});
    expect_vector(made.at(0.2, 0.2, 0.5), {0, 0, 0.5});
    expect_vector(made.at(0.8, 0.2, 0.5), {0, 0, 90});
}

TEST(NormalsOfGeometry, AreTheSameForAnyNumberOfThreads)
{
    std::mt19937 dice(7);
    std::uniform_real_distribution<double> place(-0.2, 0.8);
    std::vector<ShapePolygons> soup;
    for (int i = 0; i < 60; ++i)
        soup.push_back(polygon({{place(dice), place(dice), place(dice)},
                                {place(dice), place(dice), place(dice)},
                                {place(dice), place(dice), place(dice)}}));
    const Made one = make(blocks(geometry_of_2h), soup, 1);
    EXPECT_EQ(one.normals, make(blocks(geometry_of_2h), soup, 2).normals);
    EXPECT_EQ(one.normals, make(blocks(geometry_of_2h), soup, 5).normals);
}

TEST(NormalsOfGeometry, DoNotDependOnHowARandomSoupIsSearched)
{
    // The plain form of rules N1 to N3 for a single triangle each.
    std::mt19937 dice(11);
    std::uniform_real_distribution<double> place(-0.2, 0.8);
    for (int i = 0; i < 5; ++i)
    {
        const Vec3 a{place(dice), place(dice), place(dice)};
        const Vec3 b{place(dice), place(dice), place(dice)};
        const Vec3 c{place(dice), place(dice), place(dice)};
        const Made made = make(blocks(geometry_of_2h), {polygon({a, b, c})});
        const Vec3 u = cross(b - a, c - a) / norm(cross(b - a, c - a));
        const double reach = 2 * made.def.h;
        for (const double x : {0.0, 0.2, 0.5})
            for (const double z : {0.0, 0.3, 0.5})
            {
                const Vec3 p{x, 0.1, z};
                const double d = dot(a - p, u);
                const Vec3 n = 0.1 * made.at(p.x, p.y, p.z);
                if (!(d > 1e-6) || d > reach)
                {
                    EXPECT_LE(norm(n), d > reach ? 0.0 : 1e-6);
                    continue;
                }
                if (norm(n) == 0) continue;
                // It ends on the triangle's plane, no nearer than the plane itself.
                EXPECT_NEAR(dot(a - (p + n), u), 0, 1e-6);
                EXPECT_GE(norm(n), d - 1e-6);
            }
    }
}

TEST(NormalsOfGeometry, AreShownByThePictureWithOneLineAFacet)
{
    const Made made =
        make(blocks(R"(<norgeometry><geometryfile file="shape.vtk" /><svshapes v="true" />)"
                    "</norgeometry>"),
             {polygon({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})});
    ASSERT_EQ(made.report.shapes.size(), 2U);
    // A fifth of the mean distance of the corners from the centre: 0.2 * 0.7071.
    expect_vector(made.report.shapes[0].vertices[1], {0.5, 0.5, 1 + 0.1 * std::sqrt(2.0)}, 1e-6);
    EXPECT_EQ(made.report.shapes[1].polygons[0].size(), 4U);
}

/// A ball of 0.3 about (0.4, 0.4, 0.4) on whose surface particles stand.
CaseText fitted_ball(const std::string& normals)
{
    CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" /><drawsphere radius="0.3">)"
                    R"(<point x="0.4" y="0.4" z="0.4" /></drawsphere>)";
    text.after_geometry =
        R"(<fppg><bodyfitted mkbound="0" /></fppg><normals>)" + normals + "</normals>";
    return text;
}

/// The faces of a ball as `side` (1: outwards, -1: inwards) looks, in rings of 24.
std::vector<ShapePolygons> ball_faces(int side)
{
    constexpr int rings = 12;
    const auto corner = [](int ring, int i)
    {
        const double polar = ring * std::numbers::pi / rings;
        const double around = i * std::numbers::pi / rings;
        return Vec3{0.4, 0.4, 0.4} + 0.3 * Vec3{std::sin(polar) * std::cos(around),
                                                std::sin(polar) * std::sin(around),
                                                std::cos(polar)};
    };
    std::vector<ShapePolygons> faces;
    for (int ring = 0; ring < rings; ++ring)
        for (int i = 0; i < 2 * rings; ++i)
        {
            std::vector<Vec3> loop{corner(ring, i), corner(ring + 1, i), corner(ring + 1, i + 1)};
            if (ring > 0 && ring < rings - 1) loop.push_back(corner(ring, i + 1));
            if (ring == rings - 1) loop[2] = corner(ring, i + 1);
            if (side < 0) std::reverse(loop.begin(), loop.end());
            faces.push_back(polygon(loop));
        }
    return faces;
}

/// Every particle on the surface has a hundredth of dp along the radius; returns how many.
std::size_t expect_radial(const Made& made, int side, const Vec3& centre = {0.4, 0.4, 0.4})
{
    std::size_t count = 0;
    const OffLatticeParticles& off_lattice = made.particles.off_lattice;
    for (const ParticleBlock& block : made.particles.blocks)
    {
        std::uint64_t id = block.begin;
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k, ++id)
            {
                if (!run.is_off_lattice ||
                    off_lattice.kinds[run.off_lattice_begin() + k] == FitKind::Volume)
                    continue;
                const Vec3 p = motion_of(block)(off_lattice.positions[run.off_lattice_begin() + k]);
                const auto& n = made.normals.at(id);
                expect_vector(Vec3{n[0], n[1], n[2]} / 0.001, side * (p - centre) / 0.3, 1e-4);
                ++count;
            }
    }
    return count;
}

TEST(NormalsOnFittedWalls, AreThoseOfTheSurfaceTowardsTheSideThatTheFacesLookTo)
{
    for (const int side : {1, -1})
        EXPECT_GT(expect_radial(make(fitted_ball(geometry_of_2h), ball_faces(side)), side), 90U);
}

TEST(NormalsOnFittedWalls, LookOutwardsWhereNothingElseIsSaid)
{
    const Made made =
        make(fitted_ball(R"(<norset mkbound="1"><normal x="0" y="0" z="1" /></norset>)"));
    EXPECT_GT(expect_radial(made, 1), 90U);
    const Made far =
        make(fitted_ball(geometry_of_2h), {polygon({{9, 9, 9}, {9, 8, 9}, {8, 8, 9}})});
    EXPECT_GT(expect_radial(far, 1), 90U);
}

TEST(NormalsOnFittedWalls, AreTheOnesThatAreSet)
{
    const Made made =
        make(fitted_ball(R"(<norset mkbound="0"><normal x="0" y="0" z="0.05" /></norset>)"));
    for (const auto& n : made.normals) EXPECT_EQ(n, (std::array<float, 3>{0, 0, 0.05F}));
}

TEST(NormalsOnFittedWalls, TurnWithThem)
{
    CaseText text = fitted_ball(R"(<norset mkbound="1"><normal x="0" y="0" z="1" /></norset>)");
    text.after_geometry += R"(<initials><rotateaxis mkbound="0" angle="30" anglesunits="degrees">)"
                           R"(<axisp1 x="0.4" y="0.4" z="0.3" /><axisp2 x="0.4" y="0.4" z="1" />)"
                           R"(</rotateaxis></initials>)";
    EXPECT_GT(expect_radial(make(text), 1), 90U);
}

TEST(NormalsThatAreSet, AreWrittenAsTheyStandForTheSelectedParticles)
{
    const Made made = make(blocks(
        R"(<norset mkbound="1"><onlypos><posmin z="0.3" /></onlypos><normal x="1" y="2" z="3" /></norset>)"));
    expect_vector(made.at(0.8, 0, 0.4), {10, 20, 30});
    expect_vector(made.at(0.8, 0, 0.2), {0, 0, 0});
    expect_vector(made.at(0, 0, 0.4), {0, 0, 0});
}

TEST(NormalsOfAPlane, LeadToItFromBothSides)
{
    // maxdisth 1 is 1.73 dp.
    const Made made = make(blocks(R"(<norplane mkbound="0"><point x="0" y="0" z="0.25" />)"
                                  R"(<normal x="0" y="0" z="2" /><maxdisth v="1" /></norplane>)"));
    expect_vector(made.at(0.1, 0.1, 0.2), {0, 0, 0.5});
    expect_vector(made.at(0.1, 0.1, 0.1), {0, 0, 1.5});
    expect_vector(made.at(0.1, 0.1, 0.3), {0, 0, -0.5});
    expect_vector(made.at(0.1, 0.1, 0), {0, 0, 0});
    expect_vector(made.at(0.8, 0.1, 0.2), {0, 0, 0});
}

TEST(NormalsOfAPlane, FindItBeyondTheOutermostParticleOfEachMk)
{
    const Made made =
        make(blocks(R"(<norplane mkbound="0,1"><point auto="true" />)"
                    R"(<limitdist vdp="1.2" /><normal x="1" y="0" z="0" /></norplane>)"));
    expect_vector(made.at(1.3, 0.1, 0.2), {1.2, 0, 0});
    expect_vector(made.at(1.2, 0.1, 0.2), {2.2, 0, 0});
    expect_vector(made.at(0.5, 0.1, 0.2), {1.2, 0, 0});
}

TEST(NormalsOfAPlane, KeepEarlierOnesOnlyWhenAskedTo)
{
    const std::string set = R"(<norset mkbound="0"><normal x="1" y="0" z="0" /></norset>)";
    const std::string plane = R"(<norplane mkbound="0"><point x="0" y="0" z="0.45" />)"
                              R"(<normal x="0" y="0" z="1" /><maxdisth v="1" />)";
    expect_vector(make(blocks(set + plane + "</norplane>")).at(0, 0, 0), {0, 0, 0});
    const Made kept = make(blocks(set + plane + R"(<clear v="false" /></norplane>)"));
    expect_vector(kept.at(0, 0, 0), {10, 0, 0});
    expect_vector(kept.at(0, 0, 0.4), {0, 0, 0.5});
}

TEST(NormalsOfAPlane, WithoutMkSelectNothingAndSaySo)
{
    const Made made = make(blocks(
        R"(<norplane><point x="0" y="0" z="0.45" /><normal x="0" y="0" z="1" /></norplane>)"));
    expect_vector(made.at(0, 0, 0.4), {0, 0, 0});
    ASSERT_EQ(made.def.warnings.size(), 1U);
    EXPECT_NE(made.def.warnings[0].find("<norplane>: without mkbound"), std::string::npos);
}

TEST(NormalsOfASphere, AreRadialOnTheChosenSide)
{
    const std::string ball = R"(<norsphere><center x="0.2" y="0.2" z="0.2" /><radius v="0.25" />)";
    const Made inside = make(blocks(ball + R"(<inside v="true" /></norsphere>)"));
    expect_vector(inside.at(0.4, 0.2, 0.2), {0.5, 0, 0});
    expect_vector(inside.at(0.2, 0.2, 0.1), {0, 0, -1.5});
    expect_vector(inside.at(0.5, 0.2, 0.2), {0, 0, 0});
    const Made outside =
        make(blocks(ball + R"(<inside v="false" /><maxdisth v="1" /></norsphere>)"));
    expect_vector(outside.at(0.5, 0.2, 0.2), {-0.5, 0, 0});
    expect_vector(outside.at(0.4, 0.2, 0.2), {0, 0, 0});
    expect_vector(outside.at(0.8, 0.2, 0.2), {0, 0, 0});
}

std::string tube(const std::string& inside, const std::string& more = "")
{
    return R"(<norcylinder><center1 x="0.2" y="0.2" z="0.05" /><center2 x="0.2" y="0.2" z="0.45" />)"
           R"(<radius v="0.25" /><inside v=")" +
           inside + "\" />" + more + "</norcylinder>";
}

TEST(NormalsOfACylinder, LeadFromInsideToTheSideOrTheNearerCover)
{
    const Made made = make(blocks(tube("true")));
    expect_vector(made.at(0.4, 0.2, 0.2), {0.5, 0, 0});
    expect_vector(made.at(0.3, 0.2, 0.1), {0, 0, -0.5});
    expect_vector(made.at(0.3, 0.2, 0.4), {0, 0, 0.5});
    expect_vector(made.at(0.4, 0.2, 0.4), {0.5, 0, 0.5}); // equally near: to the rim
    expect_vector(made.at(0.2, 0.2, 0.5), {0, 0, 0});
}

TEST(NormalsOfACylinder, LeaveOutACoverThatDoesNotCount)
{
    const Made made = make(blocks(tube("true", R"(<limit1 v="false" />)")));
    expect_vector(made.at(0.3, 0.2, 0.1), {1.5, 0, 0});
    expect_vector(made.at(0.3, 0.2, 0.4), {0, 0, 0.5});
}

TEST(NormalsOfACylinder, LeadFromOutsideToItsNearestPoint)
{
    const Made made = make(blocks(tube("false", R"(<maxdisth v="1" />)")));
    expect_vector(made.at(0.5, 0.2, 0.2), {-0.5, 0, 0});
    expect_vector(made.at(0.2, 0.2, 0.5), {0, 0, -0.5});
    expect_vector(made.at(0.5, 0.2, 0.5), {-0.5, 0, -0.5});
    expect_vector(made.at(0.8, 0.2, 0.2), {0, 0, 0});
    expect_vector(made.at(0.8, 0.2, 0.5), {-3.5, 0, -0.5}); // no limit beyond the rim
}

TEST(NormalsOfParts, LeadHalfADpBeyondTheOuterParticles)
{
    const Made made = make(floor_2d(R"(<setmkfluid mk="0" /><drawpoint x="0.3" y="0" z="0.6" />)",
                                    R"(<norparts mkbound="0"><maxdisth v="1.2" /></norparts>)"));
    // 1.2 h is 1.70 dp.
    expect_vector(made.at(0.3, 0, 0.2), {0, 0, 0.5});
    expect_vector(made.at(0.3, 0, 0.1), {0, 0, 1.5});
    expect_vector(made.at(0.3, 0, 0), {0, 0, 0});
}

TEST(NormalsOfParts, KeepToTheNodesBesideAFittedWall)
{
    CaseText text = floor_2d(R"(<setmkbound mk="1" />)"
                             R"(<drawsphere radius="0.15"><point x="0.1" y="0" z="0.6" />)"
                             "</drawsphere>",
                             R"(<norparts mkbound="0"><maxdisth v="1.2" /></norparts>)");
    text.after_geometry += R"(<fppg><bodyfitted mkbound="1" /></fppg>)";
    const Made made = make(text);
    ASSERT_GT(made.particles.off_lattice.size(), 5U);
    ASSERT_NEAR(made.particles.pos_min.x, -0.05, 0.01);
    for (const double x : {0.2, 0.3, 0.4, 0.5, 0.6})
    {
        expect_vector(made.at(x, 0, 0.2), {0, 0, 0.5});
        expect_vector(made.at(x, 0, 0.1), {0, 0, 1.5});
    }
}

TEST(NormalsOfParts, AreNoneWhereNothingStandsBeyondTheWall)
{
    const Made made = make(floor_2d("", R"(<norparts mkbound="0" />)"));
    expect_vector(made.at(0.3, 0, 0.2), {0, 0, 0});
}

TEST(NormalsOfParts, TurnInTheCornerOfAnL)
{
    const Made made =
        make(floor_2d(box_command(R"(x="0" y="-1" z="0")", R"(x="0.2" y="2" z="0.6")"),
                      R"(<norparts mkbound="0"><maxdisth v="2.5" /></norparts>)"));
    expect_vector(made.at(0.2, 0, 0.2), {0.5, 0, 0.5});
    expect_vector(made.at(0.1, 0, 0.1), {1.5, 0, 1.5});
    const double s = std::sqrt(0.5); // (2, 1) nodes away, sqrt(1.5^2 + 0.5^2) dp long
    expect_vector(made.at(0.1, 0, 0.2), {2 * s, 0, s});
}

TEST(NormalsOfParts, SumUpEquallyNearNodesButNoOpposites)
{
    const auto with_water = [](const std::string& points)
    {
        CaseText text = floor_2d("", R"(<norparts mkbound="0"><maxdisth v="9" /></norparts>)");
        text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" +
                        box_command(R"(x="-0.4" y="-1" z="-0.4")", R"(x="1.4" y="2" z="1.4")") +
                        R"(<setmkfluid mk="0" />)" + points;
        return make(text).at(0.3, 0, 0.3);
    };
    const auto point = [](const char* x, const char* z)
    { return std::string("<drawpoint x=\"") + x + "\" y=\"0\" z=\"" + z + "\" />"; };
    expect_vector(with_water(point("0.6", "0.3") + point("0", "0.3") + point("0.3", "0.6")),
                  {-2.5, 0, 2.5});
    // Equal distances to the surface, sqrt(12.5) / 2: the node farther away counts.
    expect_vector(with_water(point("0.7", "0.4") + point("0.6", "0.6")), {2.5, 0, 2.5});
    expect_vector(with_water(point("0.8", "0.3") + point("0.7", "0.6")),
                  {4 * std::sqrt(18.5) / 5, 0, 3 * std::sqrt(18.5) / 5});
}

struct Mistake
{
    const char* normals;
    const char* message;
};

class WrongNormals : public testing::TestWithParam<Mistake>
{
};

TEST_P(WrongNormals, AreRefusedWithTheElementAtFault)
{
    try
    {
        make(blocks(GetParam().normals));
        FAIL() << "nothing was thrown";
    }
    catch (const CaseError& error)
    {
        EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos)
            << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(
    Of, WrongNormals,
    testing::Values(
        Mistake{"<norfoo />", "<norfoo>: is not known in <normals>"},
        Mistake{"<norset />", "<norset>: the element <normal> is missing in it"},
        Mistake{R"(<norset><normal x="1" /></norset>)", "<normal>: attribute 'y' is missing"},
        Mistake{R"(<norset><clear v="true" /><normal x="1" y="0" z="0" /></norset>)",
                "<clear>: is not known in <norset>"},
        Mistake{"<norgeometry />", "<norgeometry>: the element <geometryfile> is missing"},
        Mistake{R"(<norgeometry mkbound="0"><geometryfile file="a.vtk" /></norgeometry>)",
                "<norgeometry>: attribute 'mkbound' is not possible"},
        Mistake{R"(<norgeometry><geometryfile file="a" /></norgeometry>)"
                R"(<norgeometry><geometryfile file="a" /></norgeometry>)",
                "<norgeometry>: is there twice"},
        Mistake{R"(<norplane><normal x="0" y="0" z="1" /></norplane>)",
                "<norplane>: the element <point> is missing"},
        Mistake{R"(<norsphere><center x="0" y="0" z="0" /><radius v="1" /></norsphere>)",
                "<norsphere>: the element <inside> is missing"},
        Mistake{
            R"(<norsphere><center x="0" y="0" z="0" /><radius v="-1" /><inside v="1" /></norsphere>)",
            "<radius>: v=\"-1\" is invalid"},
        Mistake{"<norparts />", "<norparts>: is possible in 2-D cases only"}));

/// GenCase's cases for mDBC draw walls half a step behind the surface that normals lead to; fitted
/// walls have theirs where they are drawn.
TEST(NorGeometry, InAnotherPlaceThanFittedWallsIsWarnedOf)
{
    CaseText text = blocks(
        R"(<norgeometry><geometryfile file="shape.vtk" /><distanceh v="2" /></norgeometry>)");
    text.after_geometry += R"(<fppg><bodyfitted boundary="mdbc" /></fppg>)";
    for (const double off : {0.0, 0.05})
    {
        const double z = 0.5 + off;
        ShapePolygons top = polygon({{0, 0, z}, {0.5, 0, z}, {0.5, 0.5, z}, {0, 0.5, z}});
        top.mk = 10;
        const Made made = make(text, {top});
        const bool is_warned =
            std::any_of(made.report.warnings.begin(), made.report.warnings.end(),
                        [](const std::string& w)
                        { return w.find("(mkbound 0: 0.5 dp)") != std::string::npos; });
        EXPECT_EQ(is_warned, off > 0);
    }
}

TEST(NormalsThatAreNotActive, AreNotRead)
{
    CaseText text = blocks("<norfoo />");
    text.after_geometry = R"(<normals active="false"><norfoo /></normals>)";
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    EXPECT_FALSE(read_case(folder / "Case_Def.xml", {}).normals.is_active);
}

} // namespace
} // namespace fppg
