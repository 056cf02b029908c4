#include "fppg/case_def.h"
#include "fppg/domain_clip.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "helpers/case_text.h"

#include <gtest/gtest.h>

#include <map>

namespace fppg
{
namespace
{

/// How many nodes carry each mk.
using Counts = std::map<int, int>;

struct Drawn
{
    Counts nodes;
    LatticeReport report;
};

Drawn run(const test::CaseText& text, FitChoice fit = FitChoice::AsCase)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    CaseOptions options;
    options.fit = fit;
    const CaseDef def = read_case(folder / "Case_Def.xml", options);
    Drawn out;
    const RunField field = draw_scene(make_scene(def), 2, {}, out.report);
    for (const auto& slab : field.slabs)
        for (const Run& r : slab) out.nodes[r.mk] += static_cast<int>(r.z_end - r.z_begin);
    return out;
}

Counts nodes_of(const std::string& commands, const std::string& after_geometry = "")
{
    test::CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" + commands;
    text.after_geometry = after_geometry;
    return run(text).nodes;
}

std::string error_when_fitted(const std::string& commands, const std::string& after_geometry = "")
{
    test::CaseText text;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)" + commands;
    text.after_geometry = after_geometry;
    try
    {
        run(text, FitChoice::Raw);
    }
    catch (const Error& e)
    {
        return e.what();
    }
    return "no error";
}

// The numbers are those of GenCase v5.4.354.

// -- patterns
// --------------------------------------------------------------------------------------------

const std::string checker =
    R"(<patterns><pattern name="p" pattern="X--X"><size x="2" y="1" z="2" /></pattern></patterns>)";
const std::string all_nodes =
    test::box_command(R"(x="-0.5" y="-0.5" z="-0.5")", R"(x="1.9" y="1.9" z="1.9")");

TEST(Layers, MoveOutwardsWhicheverCornerOfABoxComesFirst)
{
    const auto box = [](const std::string& corners)
    {
        return nodes_of("<drawbox><boxfill>top | left</boxfill><layers vdp=\"-1,2\" />" + corners +
                        "</drawbox>");
    };
    EXPECT_EQ(box(R"(<point x="0.8" y="0.3" z="0.9" /><endpoint x="0.3" y="0.8" z="0.3" />)"),
              box(R"(<point x="0.3" y="0.3" z="0.3" /><endpoint x="0.8" y="0.8" z="0.9" />)"));
}

TEST(SetDpCtes, OfSpheresCountForEllipsoidsAndTheirOwnDoesNot)
{
    const std::string ellipsoid =
        R"(<drawellipsoid radius="0.9"><point x="0.5" y="0.5" z="0.5" /><point x="0.5" y="0.6" z="0.7" /></drawellipsoid>)";
    const Counts plain = nodes_of(ellipsoid);
    EXPECT_EQ(nodes_of("<setdpctes cteellipsoid=\"1.1\" />" + ellipsoid), plain);
    EXPECT_GT(nodes_of("<setdpctes ctesphere=\"1.1\" />" + ellipsoid).at(10), plain.at(10));
}

TEST(Patterns, LeaveTheOtherNodesAsTheyAre)
{
    EXPECT_EQ(nodes_of(all_nodes + R"(<setmkbound mk="3" /><setpattern name="p" />)" + all_nodes,
                       checker),
              (Counts{{10, 4000}, {13, 4000}}));
}

TEST(Patterns, GiveTheOtherNodesTheMkOfTheBackground)
{
    EXPECT_EQ(nodes_of(R"(<setpattern name="p" /><setmkbackfluid mk="4" />)" + all_nodes, checker),
              (Counts{{5, 4000}, {10, 4000}}));
}

TEST(Patterns, AreCutByClipsBeforeTheyAreFilled)
{
    EXPECT_EQ(nodes_of(R"(<setpattern name="p" /><setmkbackfluid mk="4" />
<clipplane><point x="0.05" y="0" z="0" /><vector x="1" y="0" z="0" /></clipplane>)" +
                           all_nodes,
                       checker),
              (Counts{{5, 1200}, {10, 1200}}));
}

TEST(Patterns, EraseInAFillWithoutBackground)
{
    EXPECT_EQ(nodes_of(all_nodes + R"(<setpattern name="p" />
<fillpoint x="0" y="0" z="0"><modefill>bound</modefill></fillpoint>)",
                       checker),
              (Counts{{10, 4000}}));
}

TEST(Patterns, DoNotTouchRedrawnear)
{
    EXPECT_EQ(nodes_of(R"(<drawpoint x="0" y="0" z="0" /><setpattern name="p" />
<setmkbackfluid mk="4" /><setmkbound mk="5" />
<redrawnear targettp="void" bordertp="bound" bordermk="0" />)",
                       checker),
              (Counts{{10, 1}, {15, 26}}));
}

TEST(Patterns, OfHexDigitsWithScaleBorderAndGap)
{
    const std::string pattern =
        R"(<patterns><pattern name="p" pattern="9"><size x="2" y="1" z="2" />)"
        R"(<scale x="2" y="1" z="1" /><border x="3" y="0" z="0" /><gap x="3" y="0" z="0" />)"
        R"(</pattern></patterns>)";
    EXPECT_EQ(nodes_of(R"(<setpattern name="p" />)" + all_nodes, pattern), (Counts{{10, 2200}}));
}

TEST(Patterns, AreRefusedForBodyFittedShapes)
{
    EXPECT_NE(error_when_fitted(R"(<setpattern name="p" />
<drawsphere radius="0.3"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)",
                                checker)
                  .find("<drawsphere>: setpattern leaves nodes of the lattice out"),
              std::string::npos);
}

// -- beaches, extrusions, waves
// -------------------------------------------------------------------------

std::string beach(const std::string& y, const std::string& mask)
{
    std::string out = "<drawbeach" + mask + ">";
    for (const auto& [x, z] : {std::pair{"0", "0.6"}, {"0", "0"}, {"0.5", "0"}, {"0.9", "0.3"}})
        out += std::string("<point x=\"") + x + "\" y=\"" + y + "\" z=\"" + z + "\" />";
    return out + "</drawbeach>";
}

TEST(Beach, IsFilledWhenItsPointsRunTheRightWayRound)
{
    EXPECT_EQ(nodes_of(beach("-0.3", "")), (Counts{{10, 192}}));
    EXPECT_EQ(nodes_of(beach("0.3", "")), (Counts{{10, 146}}));
}

TEST(Beach, HidesTheFacesOfItsMask)
{
    EXPECT_EQ(nodes_of(beach("-0.3", R"( mask="1 | 2")")), (Counts{{10, 100}}));
}

std::string extrusion(const std::string& closed, const std::string& layers)
{
    return "<drawextrude closed=\"" + closed +
           R"("><point x="0" y="0" z="1" /><point x="0" y="0" z="0" />)"
           R"(<point x="1" y="0" z="0" /><extrude x="0" y="0.2" z="0" /><layers vdp=")" +
           layers + R"(" /></drawextrude>)";
}

TEST(Extrusion, HasLayersBesideItsPolyline)
{
    EXPECT_EQ(nodes_of(extrusion("false", "-1")), (Counts{{10, 69}}));
    EXPECT_EQ(nodes_of(extrusion("false", "0,1*")), (Counts{{10, 120}}));
    EXPECT_EQ(nodes_of(extrusion("true", "1")), (Counts{{10, 63}}));
}

// The numbers from here to the wave are those of GenCase v5.4.354.
TEST(Extrusion, HasLayersBesideASlantedPolyline)
{
    EXPECT_EQ(
        nodes_of(
            R"(<drawextrude closed="false"><point x="0" y="0" z="0" /><point x="0.5" y="0" z="0.1" />)"
            R"(<point x="0.6" y="0" z="0.9" /><extrude x="-0.4" y="0.6" z="0.2" /><layers vdp="2" /></drawextrude>)"),
        (Counts{{10, 120}}));
}

TEST(LineTo, BeginsInTheCornerOfTheDomainOrWhereTheLastLineEnds)
{
    EXPECT_EQ(nodes_of(R"(<drawlineto x="0" y="0" z="0.5" />)"), (Counts{{10, 16}}));
    EXPECT_EQ(
        nodes_of(R"(<drawline><point x="0" y="0" z="0" /><point x="0.5" y="0" z="0" /></drawline>)"
                 R"(<move x="0" y="0" z="0.2" /><drawlineto x="0.5" y="0.3" z="0" />)"),
        (Counts{{10, 10}}));
    EXPECT_EQ(nodes_of(R"(<setlinebegin x="1" y="0" z="0" /><resetdraw /><setmkbound mk="0" />)"
                       R"(<drawlineto x="-0.5" y="0.3" z="-0.5" />)"),
              (Counts{{10, 9}}));
}

TEST(Box, HasTheOutermostLayerAloneWhereItIsSolid)
{
    EXPECT_EQ(
        nodes_of(
            R"(<setdrawmode mode="face" /><drawbox><boxfill>solid</boxfill><layers vdp="2,0,-1" />)"
            R"(<point x="0" y="0" z="0" /><size x="0.5" y="0.5" z="0.5" /></drawbox>)"),
        (Counts{{10, 488}}));
}

TEST(Cylinder, KeepsItsRadiusInLayersWithoutItsTube)
{
    EXPECT_EQ(nodes_of(R"(<drawcylinder radius="0.3" mask="1 | 3"><point x="0" y="0" z="0" />)"
                       R"(<point x="0" y="0" z="0.5" /><layers vdp="-2,1" /></drawcylinder>)"),
              (Counts{{10, 54}}));
}

std::string sphere(const std::string& layers)
{
    return R"(<drawsphere radius="0.3"><point x="0.5" y="0.5" z="0.5" /><layers vdp=")" + layers +
           R"(" /></drawsphere>)";
}

TEST(Layers, MayLeavePlacesInTheirListEmpty)
{
    EXPECT_EQ(nodes_of(sphere("1,")), (Counts{{10, 266}}));
    EXPECT_EQ(nodes_of(sphere("")), (Counts{{10, 179}}));
}

TEST(Layers, OfASphereNeedARadius)
{
    EXPECT_THROW(nodes_of(sphere("1,-3")), CaseError);
    EXPECT_THROW(nodes_of(R"(<drawsphere radius="0"><point x="0" y="0" z="0" /></drawsphere>)"),
                 CaseError);
}

const std::string wave =
    R"(<drawwave depth="0.4" hmaxwave="0.2" x0="0.5" z0="0"><point x="-0.3" y="0.1" z="0.1" />)"
    R"(<size x="1.5" y="0.1" z="0.7" /></drawwave>)";

TEST(Wave, FillsItsBoxUpToTheSurface)
{
    EXPECT_EQ(nodes_of(wave), (Counts{{10, 150}}));
}

// The numbers are those of GenCase v5.4.354.
TEST(Wave, PutsItsFarCornerTwiceThroughTheMatrix)
{
    EXPECT_EQ(nodes_of(R"(<move x="0" y="0.2" z="0" />)" + wave), (Counts{{10, 300}}));
    EXPECT_EQ(nodes_of(R"(<scale x="1" y="2" z="1" />)" + wave), (Counts{{10, 375}}));
    EXPECT_EQ(
        nodes_of(R"(<move x="0.1" y="0" z="0" /><rotate ang="5" x="0" y="0" z="1" />)" + wave),
        (Counts{{10, 79}}));
}

TEST(Wave, IsRefusedOffTheLatticeAndForABodyFittedMk)
{
    EXPECT_THROW(nodes_of(R"(<setfrdrawmode auto="true" />)" + wave), CaseError);
    EXPECT_NE(error_when_fitted(wave).find("<drawwave>: it has no surface"), std::string::npos);
}

// -- surfaces cut at the domain
// -----------------------------------------------------------------------

TEST(ClipToBox, CutsATriangleIntoTheQuadInside)
{
    MeshFile mesh;
    mesh.soup.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    const MeshFile cut = clip_to_box(mesh, {}, {{-1, -1, -1}, {1, 3, 1}}, {MeshFormat::Ply});
    EXPECT_EQ(cut.quads, std::vector<std::uint32_t>{0});
    EXPECT_EQ(
        cut.soup.vertices,
        (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 2, 0}}));
    EXPECT_TRUE(clip_to_box(mesh, {}, {{3, 3, 3}, {4, 4, 4}}, {}).soup.vertices.empty());
}

// -- clips
// --------------------------------------------------------------------------------------------

TEST(Clipbox, IsTurnedByItsAngles)
{
    EXPECT_EQ(nodes_of(R"(<clipbox><point x="0.2" y="0.2" z="0.2" />
<size x="0.7" y="0.6" z="0.5" /><angles x="0" y="0" z="30" /></clipbox>)" +
                       all_nodes),
              (Counts{{10, 215}}));
}

} // namespace
} // namespace fppg
