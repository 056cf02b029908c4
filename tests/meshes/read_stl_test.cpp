#include "fppg/shapes.h"

#include <sys/stat.h>

#include <cstdlib>
#include <map>

#include <gtest/gtest.h>

#include "fppg/error.h"
#include "meshes/stl_files.h"

namespace fppg
{

namespace
{

using test::ascii_stl;
using test::binary_stl;
using test::Corners;
using test::some_facets;
using test::TemporaryFile;

MeshFile read(const std::string& content, int threads = 1)
{
    return read_stl(TemporaryFile(content).path(), threads);
}

void expect_facets(const MeshFile& mesh, const std::vector<Corners>& facets)
{
    ASSERT_EQ(mesh.soup.size(), facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (std::size_t k = 0; k < 9; ++k)
            ASSERT_EQ(mesh.soup.vertices[3 * i + k / 3][static_cast<int>(k % 3)],
                      static_cast<double>(facets[i][k]))
                << "facet " << i << ", number " << k;
}

/// The message with which a file is refused.
std::string refusal(const std::string& content)
{
    try
    {
        read(content);
    }
    catch (const GeometryError& error)
    {
        return error.what();
    }
    return "accepted";
}

void expect_refused(const std::string& content, const std::string& part_of_message)
{
    EXPECT_NE(refusal(content).find(part_of_message), std::string::npos) << refusal(content);
}

void expect_warned(const MeshFile& mesh, const std::string& part_of_message)
{
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find(part_of_message), std::string::npos) << mesh.warnings[0];
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST(ReadStl, GivesTheFloatsOfABinaryFile)
{
    const auto facets = some_facets(100);
    const MeshFile mesh = read(binary_stl(facets));
    expect_facets(mesh, facets);
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST(ReadStl, GivesTheSameFloatsFromAscii)
{
    const auto facets = some_facets(100);
    const MeshFile mesh = read(ascii_stl(facets));
    expect_facets(mesh, facets);
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST(ReadStl, DoesNotDependOnTheNumberOfThreads)
{
    const auto facets = some_facets(40000);
    for (const std::string& content : {binary_stl(facets), ascii_stl(facets)})
        for (const int threads : {1, 8}) expect_facets(read(content, threads), facets);
}

TEST(ReadStl, TakesBinaryBySizeWhateverTheHeaderSays)
{
    const auto facets = some_facets(30);
    for (const char* header :
         {"solid part", "SOLID part", "solid x\nfacet normal 0 0 1\nouter loop"})
        expect_facets(read(binary_stl(facets, 30, header)), facets);
}

TEST(ReadStl, TakesATruncatedBinaryFileWithASolidHeaderForBinary)
{
    const std::string content = binary_stl(some_facets(30), 30, "solid part");
    expect_refused(content.substr(0, content.size() - 20), "29 whole facets");
}

TEST(ReadStl, ReadsEveryKindOfLineEndAndSpace)
{
    const auto facets = some_facets(5);
    const std::string plain = ascii_stl(facets);
    for (const char* end : {"\r", "\r\n", " \t\n\n", "\n\t"})
        expect_facets(read(replaced(plain, "\n", end)), facets);
    expect_facets(read(replaced(replaced(plain, "\n", " "), "  ", " ")), facets);
    expect_facets(read("\xEF\xBB\xBF" + plain), facets);
    expect_facets(read(plain + std::string(3, '\0') + "\x1A"), facets);
}

TEST(ReadStl, ReadsUpperCaseAndAnyExponent)
{
    const MeshFile mesh = read(
        "SOLID P\nFACET NORMAL NAN 0 0\nOUTER LOOP\nVERTEX +1.5E+00 -2e-1 .5\n"
        "VERTEX 1e0 2. 3E01\nVERTEX 1e-60 0 -0\nENDLOOP\nENDFACET\nENDSOLID");
    expect_facets(mesh, {{1.5f, -0.2f, 0.5f, 1, 2, 30, 0, 0, 0}});
}

TEST(ReadStl, JoinsSeveralSolids)
{
    auto facets = some_facets(4);
    const std::string twice = ascii_stl(facets) + ascii_stl(facets, "second solid");
    facets.insert(facets.end(), facets.begin(), facets.begin() + 4);
    expect_facets(read(twice), facets);
    expect_facets(read(replaced(twice, "\n", " ")), facets);
}

TEST(ReadStl, TakesANameOfAnyWords)
{
    const auto facets = some_facets(3);
    for (const char* name : {"", "a facet of life", "solid", "1 2 3"})
        expect_facets(read(ascii_stl(facets, name)), facets);
}

TEST(ReadStl, WarnsOfAMissingEndsolid)
{
    const auto facets = some_facets(3);
    const std::string text = ascii_stl(facets);
    const MeshFile mesh = read(text.substr(0, text.find("endsolid")));
    expect_facets(mesh, facets);
    expect_warned(mesh, "endsolid");
}

TEST(ReadStl, RefusesADecimalCommaAndNamesTheLine)
{
    const std::string text = ascii_stl({{1.5f, 0, 0, 1, 0, 0, 0, 1, 0}});
    expect_refused(replaced(text, "1.5", "1,5"), ":4: ");
    expect_refused(replaced(text, "1.5", "1,5"), "not a comma, found '1,5'");
}

TEST(ReadStl, RefusesAFortranExponent)
{
    expect_refused(replaced(ascii_stl({{1.5f, 0, 0, 1, 0, 0, 0, 1, 0}}), "1.5", "1.5D+00"),
                   "letter E, not D");
}

TEST(ReadStl, RefusesAWordForANumber)
{
    expect_refused(replaced(ascii_stl({{1.5f, 0, 0, 1, 0, 0, 0, 1, 0}}), "1.5", "one"),
                   "expected a number, found 'one'");
}

TEST(ReadStl, RefusesFacetsThatAreNoTriangles)
{
    const std::string text = ascii_stl({{1, 0, 0, 2, 0, 0, 3, 1, 0}});
    expect_refused(replaced(text, "endloop", "vertex 0 0 0\nendloop"),
                   ":7: the facet has more than 3");
    expect_refused(replaced(text, "      vertex 3 1 0\n", ""), ":6: the facet has 2 corners");
}

TEST(ReadStl, RefusesAnAsciiFileCutInAFacet)
{
    const std::string text = ascii_stl(some_facets(10));
    const std::size_t corner = text.rfind("vertex");
    expect_refused(text.substr(0, corner), "the file ends inside a facet");
    expect_refused(text.substr(0, corner + 3), "'ver', with which the file ends");
}

TEST(ReadStl, NamesTheLineOfAnErrorInALargeFile)
{
    const std::string text = ascii_stl(some_facets(30000));
    const std::size_t lines = 2 + 7 * 30000;
    expect_refused(replaced(text, "endsolid part", "end"), fmt::format(":{}: expected", lines));
}

TEST(ReadStl, NamesTheSizesOfATruncatedBinaryFile)
{
    const std::string content = binary_stl(some_facets(10));
    expect_refused(content.substr(0, 84 + 50 * 7 + 23),
                   "10 facets need 584 bytes, the file has 457");
    expect_refused(content.substr(0, 60), "no STL");
}

TEST(ReadStl, RefusesAWrongCountWithoutAllocatingForIt)
{
    expect_refused(binary_stl(some_facets(10), 4294967295u), "4294967295 facets need 214748364834");
    expect_refused(binary_stl(some_facets(10), 12), "room for 10 whole facets");
    expect_refused(binary_stl(some_facets(10), 8), "the count is wrong");
}

TEST(ReadStl, WarnsOfTrailingBytes)
{
    const auto facets = some_facets(10);
    const MeshFile odd = read(binary_stl(facets) + std::string(37, 'x'));
    expect_facets(odd, facets);
    expect_warned(odd, "37 bytes after the last of 10 facets");
    expect_warned(read(binary_stl(facets) + std::string(100, '\0')), "100 bytes");
}

TEST(ReadStl, RefusesFilesWithoutFacets)
{
    expect_refused("", "is empty");
    expect_refused("solid a\nendsolid a\n", "without any facet");
    expect_refused(binary_stl({}), "without any facet");
    expect_refused("this is not a mesh\n", "no STL");
    expect_refused(std::string(500, 'a'), "no STL");
}

TEST(ReadStl, LeavesOutFacetsThatAreNotFiniteAndCountsThem)
{
    auto facets = some_facets(5);
    facets[1][0] = not_a_number;
    facets[3][8] = std::numeric_limits<float>::infinity();
    for (const std::string& content : {binary_stl(facets), ascii_stl(facets)})
    {
        const MeshFile mesh = read(content);
        expect_facets(mesh, {facets[0], facets[2], facets[4]});
        expect_warned(mesh, "2 of 5 facets have a coordinate that is not finite");
    }
}

TEST(ReadStl, RefusesAFileOfNothingButNaN)
{
    Corners corners;
    corners.fill(not_a_number);
    expect_refused(binary_stl({corners, corners}), "each of its 2 facets");
}

TEST(ReadStl, LeavesAFacetWithAHugeCoordinateOutWithAWarning)
{
    const Corners good{0, 0, 0, 1, 0, 0, 0, 1, 0}, huge{0, 0, 0, 1e30f, 0, 0, 0, 1, 0};
    const MeshFile mesh = read(binary_stl({good, huge}));
    expect_facets(mesh, {good});
    expect_warned(mesh, "1 of 2 facets has a coordinate beyond");
    expect_warned(mesh, "is left out; the first is facet 2");
}

TEST(ReadStl, KeepsAMeshThatIsHugeAsAWhole)
{
    const Corners huge{0, 0, 0, 1e30f, 0, 0, 0, 1, 0};
    const MeshFile mesh = read(binary_stl({huge}));
    expect_facets(mesh, {huge});
    expect_warned(mesh, "1 of 1 facets has a coordinate beyond");
}

TEST(ReadStl, WarnsOfAMeshThatFloatsCannotResolve)
{
    expect_warned(read(binary_stl({{1e6f, 0, 0, 1e6f + 1, 0, 0, 1e6f, 1, 0}})), "coarse");
}

TEST(ReadStl, RefusesAPipeWithoutWaitingForIt)
{
    const std::string path = TemporaryFile("").path() + ".pipe";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    EXPECT_THROW(read_stl(path), IoError);
    std::filesystem::remove(path);
}

TEST(ReadStl, NamesAFileThatCannotBeOpened)
{
    EXPECT_THROW(read_stl("no such file.stl"), IoError);
    EXPECT_THROW(read_stl("."), IoError);
}

TEST(ReadStl, ReadsOrRefusesEveryDirtyFile)
{
    const char* const shared = std::getenv("FPPG_SHARED");
    if (shared == nullptr) GTEST_SKIP() << "FPPG_SHARED is not set; it names the folder of models";
    const std::map<std::string, std::size_t> odd_counts{// Files that are refused have 0.
                                                        {"ascii_comma_decimal", 0},
                                                        {"ascii_fortran_exponent", 0},
                                                        {"ascii_quad_facet", 0},
                                                        {"ascii_truncated", 0},
                                                        {"count_4294967295", 0},
                                                        {"count_too_large", 0},
                                                        {"count_too_small", 0},
                                                        {"empty_file", 0},
                                                        {"text_not_stl", 0},
                                                        {"truncated_in_header", 0},
                                                        {"truncated_mid_facet", 0},
                                                        {"zero_facets_ascii", 0},
                                                        {"zero_facets_binary", 0},
                                                        {"ascii_two_solids", 160},
                                                        {"coincident_face_cubes", 24},
                                                        {"degenerate_facets", 1405},
                                                        {"duplicate_facets", 1530},
                                                        {"fin_zero_thickness", 14},
                                                        {"hole_large_cap", 1148},
                                                        {"holes_small", 1272},
                                                        {"huge_coordinate_1e30", 1280},
                                                        {"inf_coordinates", 1278},
                                                        {"nan_coordinates", 1278},
                                                        {"needle_facets", 13},
                                                        {"nested_cavity", 2560},
                                                        {"open_sheet", 2},
                                                        {"t_junctions", 60},
                                                        {"touching_edge_cubes", 24},
                                                        {"touching_vertex_cubes", 24},
                                                        {"nested_shell_same_orientation", 2560},
                                                        {"self_intersecting_sphere_cube", 1292},
                                                        {"self_intersecting_two_spheres", 2560}};
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(shared) + "/models/dirty"))
    {
        const std::string name = entry.path().stem().string();
        const std::size_t usual = name.starts_with("ascii_") ? 80 : 1280;
        const auto odd = odd_counts.find(name);
        std::size_t count = 0;
        try
        {
            count = read_stl(entry.path().string(), 2).soup.size();
        }
        catch (const GeometryError& error)
        {
            EXPECT_TRUE(std::string(error.what()).starts_with(entry.path().string()))
                << error.what();
        }
        EXPECT_EQ(count, odd == odd_counts.end() ? usual : odd->second) << name;
        ++files;
    }
    EXPECT_EQ(files, 54u);
}

} // namespace fppg
