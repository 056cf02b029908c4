#include "fppg/scene.h"

#include "fppg/boolean.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"

#include "batch/estimate.h"
#include "batch/wall_geometry.h"
#include "helpers/case_text.h"
#include "meshes/mesh_library.h"
#include "scene/exact_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

namespace fppg
{
namespace
{

using test::CaseText;
using test::TemporaryFolder;

std::string box(double low, double side, double height, const std::string& name = "")
{
    const auto place = [](double xy, double z)
    {
        return "x=\"" + std::to_string(xy) + "\" y=\"" + std::to_string(xy) + "\" z=\"" +
               std::to_string(z) + "\"";
    };
    std::string command = test::box_command(place(low, low), place(side, height));
    if (!name.empty()) command.replace(0, 8, "<drawbox fppg:name=\"" + name + "\"");
    return command;
}

const std::string full_bound = R"(<setdrawmode mode="full" /><setmkbound mk="0" />)";

/// A case of these commands, written and read.
struct Written
{
    explicit Written(const std::string& commands, const std::string& after_geometry = "")
    {
        CaseText text;
        text.dp = "0.05";
        text.pointmin = R"(<pointmin x="-0.5" y="-0.5" z="-0.5" />)";
        text.pointmax = R"(<pointmax x="1.5" y="1.5" z="1.5" />)";
        text.mainlist = commands;
        text.after_geometry = after_geometry;
        test::write_text(path, text.text());
    }

    CaseDef read() const { return read_case(path, {}); }
    /// Volume that the boundaries of the case enclose, as compare --definition sees them.
    double drawn_volume() const { return body_of_facets(wall_geometry(path, {}, 2)).volume; }

    std::uint64_t estimated() const
    {
        EstimateOptions options;
        options.case_options.fit = FitChoice::On;
        options.threads = 2;
        return estimate_case(path, options).np;
    }
    /// Particles of a run, not relaxed.
    std::uint64_t made() const
    {
        CaseOptions options;
        options.fit = FitChoice::On;
        const CaseDef def = read_case(path, options);
        LatticeReport report;
        RunField field = draw_scene(make_scene(def), 2, {}, report);
        CaseConstants constants;
        std::vector<std::string> warnings;
        return make_particles(def, field, 2, constants, warnings).np;
    }

    TemporaryFolder folder;
    std::string path = folder / "Case_Def.xml";
};

const std::string reset =
    full_bound + box(0, 1, 1) + "<resetdraw />" + full_bound + box(0.2, 0.5, 0.5);
const std::string parts = full_bound + box(0, 1, 1, "a") + box(0.2, 0.5, 1, "b");
const std::string difference =
    R"(<fppg><bodyfitted mkbound="0" /><boolean op="difference"><part ref="a" /><part ref="b" /></boolean></fppg>)";

TEST(Scene, LeavesWhatStandsBehindTheLastReset)
{
    const Written written(reset);
    const CaseDef def = written.read();
    const Scene scene = make_scene(def);
    ASSERT_EQ(scene.remaining().size(), 1U);
    EXPECT_NE(scene.remaining()[0].shape(), nullptr);
    EXPECT_EQ(scene.steps.size(), 3U);
}

TEST(Scene, PutsABooleanBehindItsLastPart)
{
    const Written written(parts + box(0.9, 0.3, 0.3), difference);
    const CaseDef def = written.read();
    const Scene scene = make_scene(def);
    ASSERT_EQ(scene.steps.size(), 4U);
    EXPECT_TRUE(scene.steps[0].is_part && scene.steps[1].is_part);
    ASSERT_NE(scene.steps[2].combination, nullptr);
    EXPECT_EQ(scene.steps[2].combination->parts.size(), 2U);
    EXPECT_EQ(scene.steps[2].combination->stays, (std::vector<char>{1, 0}));
    EXPECT_NE(scene.steps[3].shape(), nullptr);
}

TEST(Scene, ReadsAMeshFileOnce)
{
    const Written written(full_bound + R"(<drawfilestl file="a.stl" />)");
    std::ofstream(written.folder / "a.stl")
        << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
           "endloop\nendfacet\nendsolid a\n";
    const CaseDef def = written.read();
    const Scene scene = make_scene(def);
    const SourceRef source{1, "drawfilestl"};
    const LibraryMesh& first = scene.meshes->read(source, "a.stl", {}, 1);
    EXPECT_EQ(&scene.meshes->read(source, "a.stl", {}, 1), &first);
}

TEST(EstimateOfAScene, LeavesOutWhatAResetForgets)
{
    const Written after_reset(reset);
    const Written alone(full_bound + box(0.2, 0.5, 0.5));
    EXPECT_EQ(after_reset.estimated(), alone.estimated());
    const auto made = static_cast<double>(after_reset.made());
    EXPECT_NEAR(static_cast<double>(after_reset.estimated()), made, 0.05 * made);
}

TEST(EstimateOfAScene, CountsTheSurfaceOfABooleansResult)
{
    const Written written(parts, difference);
    const auto made = static_cast<double>(written.made());
    EXPECT_NEAR(static_cast<double>(written.estimated()), made, 0.05 * made);
}

TEST(WallGeometry, LeavesOutWhatAResetForgets)
{
    EXPECT_NEAR(Written(reset).drawn_volume(), 0.125, 1e-9);
}

TEST(WallGeometry, IsTheSurfaceOfABooleansResult)
{
    EXPECT_NEAR(Written(parts, difference).drawn_volume(), 1 - 0.5 * 0.5 * 0.8, 1e-9);
}

TEST(WallGeometry, TakesThePartsOfSetmknextautoAsOneBody)
{
    const Written written(R"(<setdrawmode mode="full" /><setmkbound mk="0" />)"
                          R"(<setmknextauto auto="true" />)" +
                          box(0.2, 0.5, 0.5));
    EXPECT_NEAR(written.drawn_volume(), 0.125, 1e-9);
}

} // namespace
} // namespace fppg
