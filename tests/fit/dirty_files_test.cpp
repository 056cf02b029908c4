#include "fit/wall_of_soup.h"
#include "fppg/error.h"
#include "fppg/shapes.h"

#include <cstdlib>
#include <filesystem>
#include <ostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fppg
{
namespace
{

using namespace test;

/// What must come of a broken file: a refusal with this text behind the file's name; or the volume
/// of the clean shape within 1 %, or no inside, with a warning that holds the text (empty: the file
/// needs no mending and there is no warning).
struct DirtyFile
{
    const char* name;
    const char* text;
    double volume; ///< 0: refused; -1: no inside
};

/// The name of a test must not hold addresses.
void PrintTo(const DirtyFile& file, std::ostream* out)
{
    *out << file.name;
}

constexpr double ball = 4.152744;       ///< sphere of 1280 facets
constexpr double small_ball = 3.658712; ///< sphere of 80 facets
constexpr double refused = 0, no_inside = -1;

const DirtyFile dirty_files[] = {
    {"ascii_comma_decimal", ":4: expected a number with a decimal point", refused},
    {"ascii_cr_only", "", small_ball},
    {"ascii_crlf", "", small_ball},
    {"ascii_exponents", "", small_ball},
    {"ascii_fortran_exponent", ":4: expected a number with the exponent letter E", refused},
    {"ascii_nan", "1 of 81 facets has a coordinate that is not finite", small_ball},
    {"ascii_no_endsolid", "not closed by 'endsolid'", small_ball},
    {"ascii_one_line", "", small_ball},
    {"ascii_plain", "", small_ball},
    {"ascii_quad_facet", ":7: the facet has more than 3 corners", refused},
    {"ascii_tabs_blank_lines", "", small_ball},
    {"ascii_truncated", ":375: the file ends inside a facet", refused},
    {"ascii_two_solids", "80 facets are copies", small_ball},
    {"ascii_upper_case", "", small_ball},
    {"ascii_utf8_bom", "", small_ball},
    {"attribute_colours", "", ball},
    {"coincident_face_cubes", "4 facets are walls between two bodies", 2},
    {"count_4294967295", "4294967295 facets need 214748364834 bytes", refused},
    {"count_too_large", "1380 facets need 69084 bytes", refused},
    {"count_too_small", "1180 facets need 59084 bytes", refused},
    {"cracks_jitter_1e-5", "The facets do not meet: ", ball},
    {"degenerate_facets", "125 facets are without area", ball},
    {"duplicate_facets", "250 facets are copies", ball},
    {"empty_file", "is empty", refused},
    {"far_from_origin_1e6", "its shape is coarse", ball},
    {"fin_zero_thickness", "2 of 14 facets bound no volume", 8},
    {"hole_large_cap", "bounds no volume: 36 edges are open", no_inside},
    {"holes_small", "24 edges have one facet only", ball},
    {"huge_coordinate_1e30", "1 of 1281 facets has a coordinate beyond", ball},
    {"inf_coordinates", "2 of 1280 facets have a coordinate that is not finite", ball},
    {"inverted_all", "1280 facets look inwards", ball},
    {"inverted_some", "409 facets look inwards", ball},
    {"nan_coordinates", "2 of 1280 facets have a coordinate that is not finite", ball},
    {"needle_facets", "1 facet is without area", 8},
    {"nested_cavity", "", 0.875 * ball},
    {"nested_shell_same_orientation", "count once", ball},
    {"open_sheet", "bounds no volume: 4 edges are open", no_inside},
    {"scale_mm_1000x", "", 1e9 * ball},
    {"scale_tiny_1e-6", "", 1e-18 * ball},
    {"self_intersecting_sphere_cube", "count once", 5.4045},
    {"self_intersecting_two_spheres", "count once", 7.0716},
    {"solid_facet_header_binary", "", ball},
    {"solid_header_binary", "", ball},
    {"t_junctions", "16 vertices lie inside an edge", 8},
    {"text_not_stl", "is no STL file", refused},
    {"touching_edge_cubes", "More than two facets meet at 1 edge", 2},
    {"touching_vertex_cubes", "", 2},
    {"trailing_bytes", "37 bytes after the last", ball},
    {"truncated_in_header", "is no STL file", refused},
    {"truncated_mid_facet", "1280 facets need 64084 bytes", refused},
    {"wrong_normals", "", ball},
    {"zero_facets_ascii", "without any facet", refused},
    {"zero_facets_binary", "without any facet", refused},
    {"zero_normals", "", ball},
};

class DirtyFiles : public testing::TestWithParam<DirtyFile>
{
};

/// One line of the table of dirty_files.md.
void say(const std::string& name, const std::string& outcome, const std::string& error)
{
    fmt::print("| {} | {} | {} |\n", name, outcome, error);
}

TEST_P(DirtyFiles, GiveTheirVolumeOrARefusalThatSaysWhy)
{
    const char* shared = std::getenv("FPPG_SHARED");
    if (shared == nullptr) GTEST_SKIP() << "FPPG_SHARED names no folder with models/dirty";
    const DirtyFile& file = GetParam();
    const std::string path = fmt::format("{}/models/dirty/{}.stl", shared, file.name);
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    try
    {
        const MeshFile read = read_stl(path);
        const FittedMesh fitted = fit_soup(read.soup);
        std::string warnings;
        for (const auto& list : {read.warnings, fitted.warnings})
            for (const std::string& warning : list) warnings += " " + warning;
        ASSERT_NE(file.volume, refused) << "not refused;" << warnings;
        EXPECT_NE(warnings.find(file.text), std::string::npos) << warnings;
        EXPECT_EQ(file.text[0] == '\0', warnings.empty()) << warnings;
        EXPECT_EQ(fitted.zone.has_inside, file.volume != no_inside);
        EXPECT_TRUE(file.volume == no_inside || std::abs(fitted.volume() / file.volume - 1) < 0.01)
            << fitted.volume();
        say(file.name, warnings.empty() ? "no warning needed" : warnings.substr(1),
            fitted.zone.has_inside
                ? fmt::format("{:+.2f} %", 100 * (fitted.volume() / file.volume - 1))
                : "no inside");
    }
    catch (const GeometryError& error)
    {
        const std::string message = error.what();
        EXPECT_EQ(file.volume, refused) << message;
        EXPECT_EQ(message.rfind(path, 0), 0u) << message;
        EXPECT_NE(message.find(file.text), std::string::npos) << message;
        say(file.name, "refused: " + message.substr(path.size()), "");
    }
}

INSTANTIATE_TEST_SUITE_P(Shared, DirtyFiles, testing::ValuesIn(dirty_files),
                         [](const auto& file)
                         {
                             std::string name = file.param.name;
                             for (char& c : name)
                                 if (c == '-') c = '_';
                             return name;
                         });

} // namespace
} // namespace fppg
