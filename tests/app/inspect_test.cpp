#include "app/inspect.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/inspect_command.h"
#include "app/subcommands.h"
#include "fppg/error.h"
#include "meshes/stl_files.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using test::box;
using test::TemporaryFile;

TemporaryFile file_of(const TriangleSoup& soup)
{
    std::vector<test::Corners> facets(soup.size());
    for (std::size_t i = 0; i < soup.vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            facets[i / 3][3 * (i % 3) + static_cast<std::size_t>(axis)] =
                static_cast<float>(soup.vertices[i][axis]);
    return TemporaryFile(test::binary_stl(facets));
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST(Inspect, MeasuresACube)
{
    const TemporaryFile file = file_of(box({0, 0, 0}, {1, 1, 1}));
    const Inspection found = inspect_mesh({.path = file.path(), .dp = 0.125});
    EXPECT_TRUE(found.report.is_watertight);
    EXPECT_DOUBLE_EQ(found.report.volume, 1);
    EXPECT_EQ(found.unit, "m");
    EXPECT_EQ(found.lines, 12u);
    EXPECT_EQ(found.singular_points, 8u);
    EXPECT_DOUBLE_EQ(found.surface_particles, 6 * 64);
    EXPECT_DOUBLE_EQ(found.volume_particles, 512);
    EXPECT_EQ(found.line_particles, 12 * 7);
    EXPECT_EQ(found.corner_particles, 8);
    EXPECT_EQ(found.thin_share, 0);
}

/// A file whose name has an ending.
class NamedFile
{
public:
    NamedFile(const std::string& ending, const std::string& text)
        : path_(std::filesystem::temp_directory_path() /
                fmt::format("fppg-inspect-{}.{}", static_cast<const void*>(this), ending))
    {
        std::ofstream(path_) << text;
    }
    ~NamedFile() { std::filesystem::remove(path_); }
    NamedFile(const NamedFile&) = delete;
    NamedFile& operator=(const NamedFile&) = delete;
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

const std::string tetrahedron_points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string tetrahedron_facets = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

TEST(Inspect, ReadsEveryMeshFormatOfACase)
{
    const NamedFile ply("ply",
                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
                        "float y\nproperty float z\nelement face 4\nproperty list uchar int "
                        "vertex_indices\nend_header\n" +
                            tetrahedron_points + tetrahedron_facets);
    const NamedFile vtk("vtk",
                        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 "
                        "float\n" +
                            tetrahedron_points + "POLYGONS 4 16\n" + tetrahedron_facets);
    for (const NamedFile* file : {&ply, &vtk})
    {
        const Inspection found = inspect_mesh({.path = file->path()});
        EXPECT_EQ(found.format, file == &ply ? "ply" : "vtk");
        EXPECT_TRUE(found.report.is_watertight);
        EXPECT_NEAR(found.report.volume, 1.0 / 6, 1e-12);
        EXPECT_EQ(found.lines, 6u);
        EXPECT_TRUE(has(to_text(found), "(" + found.format + ")"));
    }
    const NamedFile heights("csv", ";0;1;2\n0;1;1;1\n1;1;1;1\n");
    const Inspection sheet = inspect_mesh({.path = heights.path()});
    EXPECT_EQ(sheet.facets, 4u);
    EXPECT_FALSE(sheet.report.is_watertight);
}

TEST(Inspect, SaysWhatAFileWithoutASurfaceHolds)
{
    const NamedFile file("vtk",
                         "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 "
                         "float\n0 0 0\n1 0 0\nLINES 1 3\n2 0 1\n");
    try
    {
        inspect_mesh({.path = file.path()});
        FAIL() << "accepted";
    }
    catch (const GeometryError& error)
    {
        EXPECT_TRUE(has(error.what(), "has no surface, only 0 points and 1 lines")) << error.what();
    }
}

TEST(Inspect, CountsWhatFitPutsOnTheSurface)
{
    const TemporaryFile file = file_of(box({0, 0, 0}, {1, 1, 1}));
    const Inspection found = inspect_mesh({.path = file.path(), .dp = 0.125});
    ASSERT_TRUE(found.fitted_particles.has_value());
    const double all = static_cast<double>(*found.fitted_particles) + found.line_particles +
                       found.corner_particles;
    EXPECT_NEAR(all, found.surface_particles, 0.15 * found.surface_particles);
    EXPECT_TRUE(has(to_text(found),
                    fmt::format("{} particles on the surface besides", *found.fitted_particles)));
    EXPECT_TRUE(
        has(to_json(found), fmt::format("\"fitted_particles\": {}", *found.fitted_particles)));
    EXPECT_FALSE(has(to_text(found), "not watertight"));
    // Twelve thousand million particles are not placed for a look.
    const Inspection fine = inspect_mesh({.path = file.path(), .dp = 2e-5});
    EXPECT_FALSE(fine.fitted_particles.has_value());
    EXPECT_FALSE(has(to_json(fine), "fitted_particles"));
}

TEST(Inspect, SaysThatTheInsideOfAnOpenSheetIsAGuess)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    soup.vertices.resize(soup.vertices.size() - 3);
    const TemporaryFile file = file_of(soup);
    EXPECT_TRUE(has(to_text(inspect_mesh({.path = file.path(), .dp = 0.125})),
                    "not watertight: what -fit takes for its inside is a guess"));
    EXPECT_FALSE(has(to_text(inspect_mesh({.path = file.path()})), "-fit"));
}

TEST(Inspect, FindsHowThinAPlateIs)
{
    // Turned, so that no side looks along an axis.
    const double s = std::sqrt(0.5);
    const Transform turn{{Vec3{s, -s, 0}, Vec3{0.5, 0.5, -s}, Vec3{0.5, 0.5, s}}, {}};
    const TemporaryFile file = file_of(test::moved(box({0, 0, 0}, {1, 1, 0.03}), turn));
    const Inspection found = inspect_mesh({.path = file.path(), .dp = 0.05});
    EXPECT_NEAR(found.thinnest, 0.03, 1e-6);
    // Rays along an axis leave a slanted plate through its rim near it.
    EXPECT_NEAR(found.thin_share, 2 / 2.12, 0.05);
    EXPECT_EQ(inspect_mesh({.path = file.path(), .dp = 0.029}).thin_share, 0);
}

TEST(Inspect, CountsTheLayersThatAWallHasRoomFor)
{
    const TemporaryFile file = file_of(box({0, 0, 0}, {1, 1, 0.1}));
    const auto share = [&](double thickness_dp, std::size_t layers) {
        return inspect_mesh({.path = file.path(), .dp = 0.1 / thickness_dp})
            .share_with_layers(layers);
    };
    EXPECT_NEAR(share(4, 4), 1, 1e-9);
    EXPECT_LT(share(3, 4), 0.2); // those of the narrow sides
    EXPECT_NEAR(share(3, 3), 1, 1e-9);
    EXPECT_LT(share(1.4, 2), 0.2); // the two of both sides are one
    EXPECT_NEAR(share(1.4, 1), 1, 1e-9);
    EXPECT_LT(share(0.9, 1), 0.2);
    EXPECT_TRUE(has(to_text(inspect_mesh({.path = file.path(), .dp = 0.1 / 3})),
                    "room for 3 at the thinnest place; 3 (coefh 1) behind 100 % of the area"));
    EXPECT_TRUE(has(
        to_text(inspect_mesh({.path = file.path(), .dp = 0.1 / 1.4})),
        "room for 1 at the thinnest place, so walls are thickened to 2 dp, for 2; 3 (coefh 1)"));
}

TEST(Inspect, GuessesMillimetresFromTheSizeAndFromDp)
{
    const TemporaryFile large = file_of(box({0, 0, 0}, {300, 1, 1}));
    EXPECT_EQ(inspect_mesh({.path = large.path()}).unit, "mm");
    const TemporaryFile small = file_of(box({0, 0, 0}, {4, 1, 1}));
    EXPECT_EQ(inspect_mesh({.path = small.path()}).unit, "m");
    EXPECT_EQ(inspect_mesh({.path = small.path(), .dp = 0.0005}).unit, "mm");
}

TEST(Inspect, NamesUnitsInEveryLine)
{
    const TemporaryFile file = file_of(box({0, 0, 0}, {200, 100, 50}));
    const std::string text = to_text(inspect_mesh({.path = file.path(), .dp = 10, .unit = "mm"}));
    for (const char* line :
         {"Unit              mm\n", "Size              200 x 100 x 50 mm\n",
          "Volume            1e+06 mm^3 (0.001 m^3)\n", "Area              70000 mm^2 (0.07 m^2)\n",
          "(0, 0, 0) mm to (200, 100, 50) mm\n", "With dp           10 mm (0.01 m)\n",
          "longest 200 mm\n"})
        EXPECT_TRUE(has(text, line)) << line << text;
}

TEST(Inspect, QuestionsADpThatMakesTenThousandMillionParticles)
{
    const TemporaryFile file = file_of(box({0, 0, 0}, {200, 100, 50}));
    const std::string text = to_text(inspect_mesh({.path = file.path(), .dp = 0.01}));
    EXPECT_TRUE(has(text,
                    "Question          dp 0.01 mm makes 1000000000000 particles in the volume, "
                    "so none was placed: is dp in the unit of the file (mm)? From dp = 0.22 "
                    "mm on"))
        << text;
    EXPECT_FALSE(has(text, "on corners"));
}

TEST(Inspect, PrintsRoundingAsZero)
{
    const TemporaryFile file = file_of(box({1e-17, -3e-18, 0}, {1, 1, 1}));
    const std::string text = to_text(inspect_mesh({.path = file.path()}));
    EXPECT_TRUE(has(text, "(0, 0, 0) m to (1, 1, 1) m")) << text;
}

TEST(Inspect, NamesTheFirstOpenEdges)
{
    TriangleSoup soup = box({0, 0, 0}, {1, 1, 1});
    soup.vertices.resize(soup.vertices.size() - 6);
    const TemporaryFile file = file_of(soup);
    const Inspection found = inspect_mesh({.path = file.path()});
    EXPECT_EQ(found.open_edges.size(), 4u);
    const std::string text = to_text(found);
    EXPECT_TRUE(has(text, "Watertight        no"));
    EXPECT_TRUE(has(text, "(0, 1, 0)"));
    EXPECT_TRUE(has(to_json(found), "\"open_edges\": 4"));
    EXPECT_FALSE(has(to_json(found), "\"dp\""));
}

TEST(Inspect, NamesTheFileInItsErrors)
{
    TriangleSoup soup;
    test::add_facet(soup, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    const TemporaryFile file = file_of(soup);
    try
    {
        inspect_mesh({.path = file.path()});
        FAIL() << "a facet without area is no mesh";
    }
    catch (const GeometryError& error)
    {
        EXPECT_TRUE(has(error.what(), file.path()));
    }
    EXPECT_THROW(inspect_mesh({.path = "no such file.stl"}), IoError);
}

TEST(Subcommands, LeaveGenCasesFormAlone)
{
    EXPECT_EQ(find_subcommand("inspect"), &run_inspect);
    EXPECT_EQ(find_subcommand("CaseDambreak_Def"), nullptr);
    EXPECT_EQ(find_subcommand("-dp:0.1"), nullptr);
}

TEST(Subcommands, RefuseWhatIsNotKnown)
{
    EXPECT_THROW(run_inspect({}), UsageError);
    EXPECT_THROW(run_inspect({"a.stl", "--dq", "1"}), UsageError);
    EXPECT_THROW(run_inspect({"a.stl", "--dp", "-1"}), UsageError);
}

TEST(Inspect, ReportsOrRefusesEveryDirtyFile)
{
    const char* shared = std::getenv("FPPG_SHARED");
    if (shared == nullptr) GTEST_SKIP() << "FPPG_SHARED, the folder with models/, is not set";
    std::size_t files = 0, refused = 0, watertight = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(shared) / "models" / "dirty"))
    {
        const std::string path = entry.path().string();
        ++files;
        try
        {
            const Inspection found = inspect_mesh({.path = path, .dp = 0.1});
            watertight += static_cast<std::size_t>(found.report.is_watertight);
            EXPECT_TRUE(found.report.is_watertight || !found.report.warnings.empty()) << path;
            EXPECT_TRUE(!found.report.is_watertight || found.report.volume > 0) << path;
        }
        catch (const Error& error)
        {
            ++refused;
            EXPECT_TRUE(has(error.what(), path)) << error.what();
        }
    }
    EXPECT_EQ(files, 54u);
    RecordProperty("refused", static_cast<int>(refused));
    RecordProperty("watertight", static_cast<int>(watertight));
}

} // namespace fppg
