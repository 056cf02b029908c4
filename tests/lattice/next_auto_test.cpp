#include "fppg/case_def.h"
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

/// Nodes per mkbound of a case that draws `commands` from mkbound 2 on under setmknextauto.
std::map<int, int> nodes_of_parts(const std::string& mode, const std::string& commands,
                                  const std::string& vtk = "")
{
    const test::TemporaryFolder folder;
    if (!vtk.empty()) test::write_text(folder / "a.vtk", vtk);
    test::CaseText text;
    text.mainlist = "<setdrawmode mode=\"" + mode + "\" /><setmkbound mk=\"2\" />";
    text.mainlist += "<setmknextauto auto=\"true\" />" + commands;
    test::write_text(folder / "Case_Def.xml", text.text());
    const CaseDef def = read_case(folder / "Case_Def.xml", {});
    LatticeReport report;
    const RunField field = draw_scene(make_scene(def), 2, {}, report);
    std::map<int, int> out;
    for (const auto& slab : field.slabs)
        for (const Run& run : slab)
            out[run.mk - def.mk_bound_first] += static_cast<int>(run.z_end - run.z_begin);
    return out;
}

const std::string solid_box =
    R"(<drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="0.4" y="0.4" z="0.4" /></drawbox>)";
const std::string point = R"(<drawpoint x="1.2" y="1.2" z="1.2" />)";

// The numbers are those of GenCase v5.4.354.
TEST(MkNextAuto, NumbersTheTwelvePartsOfASolidBox)
{
    EXPECT_EQ(nodes_of_parts("full", solid_box), (std::map<int, int>{{2, 9},
                                                                     {4, 9},
                                                                     {5, 9},
                                                                     {6, 3},
                                                                     {7, 6},
                                                                     {8, 3},
                                                                     {9, 6},
                                                                     {10, 15},
                                                                     {11, 20},
                                                                     {12, 20},
                                                                     {13, 25}}));
}

TEST(MkNextAuto, LeavesOneMkOutAfterABox)
{
    EXPECT_EQ(nodes_of_parts("full", solid_box + point).rbegin()->first, 15);
}

TEST(MkNextAuto, DrawsTheOutermostLayerOfABoxFirstAndLeavesNoMkOut)
{
    EXPECT_EQ(nodes_of_parts("face", R"(<drawbox><boxfill>back | top</boxfill>
<point x="0.1" y="0.1" z="0.2" /><size x="0.6" y="0.5" z="0.4" /><layers vdp="0,1" /></drawbox>)" +
                                         point),
              (std::map<int, int>{{2, 42}, {3, 42}, {4, 35}, {5, 35}, {6, 1}}));
}

TEST(MkNextAuto, CountsSegmentsOfLinesButNoPoints)
{
    const std::string lines =
        R"(<drawlines><point x="0" y="0" z="0" /><point x="0.5" y="0" z="0" /><point x="0.5" y="0.5" z="0" /></drawlines>)";
    EXPECT_EQ(nodes_of_parts("full", lines + point + point),
              (std::map<int, int>{{2, 5}, {3, 6}, {4, 1}}));
}

TEST(MkNextAuto, NumbersTheSidesOfAWire)
{
    const std::string triangle =
        R"(<drawtriangle><point x="0" y="0" z="0" /><point x="0.5" y="0" z="0" /><point x="0" y="0.5" z="0.4" /></drawtriangle>)";
    EXPECT_EQ(nodes_of_parts("wire", triangle + point),
              (std::map<int, int>{{2, 4}, {3, 7}, {4, 8}, {5, 1}}));
}

TEST(MkNextAuto, NumbersThePrismsThatASolidPrismIsCutInto)
{
    std::string prism = "<drawprism>";
    for (const char* z : {"0", "0.6"})
        for (const auto& [x, y] :
             {std::pair{"0", "0"}, {"0.6", "0.1"}, {"0.7", "0.5"}, {"0.1", "0.6"}})
            prism += std::string("<point x=\"") + x + "\" y=\"" + y + "\" z=\"" + z + "\" />";
    prism += "</drawprism>";
    EXPECT_EQ(nodes_of_parts("solid", prism + point),
              (std::map<int, int>{{2, 50}, {4, 75}, {5, 30}, {6, 1}}));
}

TEST(MkNextAuto, TakesAllLayersOfASphereAsOne)
{
    EXPECT_EQ(nodes_of_parts("full", R"(<drawsphere radius="0.3"><point x="0.2" y="0.2" z="0.2" />
<layers vdp="0,1" /></drawsphere>)" + point),
              (std::map<int, int>{{2, 380}, {3, 1}}));
}

TEST(MkNextAuto, DrawsTheInsideOfAFigureAfterItsFaces)
{
    const std::string polyhedron = R"(<drawfigure><points><point x="0" y="0" z="0" />
<point x="0.5" y="0" z="0" /><point x="0" y="0.5" z="0" /><point x="0" y="0" z="0.5" /></points>
<triangles><triangle x="0" y="1" z="3" /></triangles></drawfigure>)";
    const std::map<int, int> nodes = nodes_of_parts("full", polyhedron + point);
    EXPECT_EQ(nodes.at(2), 21);
    EXPECT_EQ(nodes.rbegin()->first, 4);
}

/// A line, a quad and a triangle.
const std::string three_shapes = R"(# vtk DataFile Version 3.0
x
ASCII
DATASET POLYDATA
POINTS 5 float
0 0 0  0.4 0 0  0.4 0.4 0  0 0.4 0  0 0 0.4
LINES 1 3
2 2 4
POLYGONS 2 9
4 0 1 2 3
3 0 1 4
)";

TEST(MkNextAuto, NumbersTheShapesOfAMeshFile)
{
    EXPECT_EQ(nodes_of_parts("full", R"(<drawfilevtk file="a.vtk" />)" + point, three_shapes),
              (std::map<int, int>{{3, 3}, {4, 20}, {5, 15}, {6, 1}}));
}

TEST(MkNextAuto, NumbersTheSidesOfAMeshFileInAWire)
{
    const std::map<int, int> nodes =
        nodes_of_parts("wire", R"(<drawfilevtk file="a.vtk" />)" + point, three_shapes);
    EXPECT_EQ(nodes.rbegin()->first, 11);
}

TEST(MkNextAuto, RefusesADrawThatLeavesNoMk)
{
    const std::string mk = R"(<setmkfluid mk="8" />)";
    EXPECT_NO_THROW(nodes_of_parts("full", mk + point));
    const std::string line =
        R"(<drawline><point x="0" y="0" z="0" /><point x="1" y="0" z="0" /></drawline>)";
    EXPECT_THROW(nodes_of_parts("full", mk + line), CaseError);
}

} // namespace
} // namespace fppg
