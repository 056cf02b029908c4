// Cases with body-fitted walls, run as users run them; FPPG_PROGRAM is the program's path.

#include "fppg/element.h"
#include "fppg/fit.h"
#include "fppg/particles.h"
#include "fppg/read_particles.h"

#include "casedef/xml_document.h"
#include "files/vtk_reader.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>
#include <tuple>

namespace
{

namespace fs = std::filesystem;
using fppg::Element;
using fppg::ParticleCloud;
using fppg::ParticleType;
using fppg::Vec3;
using fppg::VtkFile;
using namespace fppg::test;

constexpr std::uint16_t bound_mk = 10; ///< of mkbound 0

/// Writes the case and runs it into out/Case with all files.
RunResult run_case(const TemporaryFolder& folder, const CaseText& text, const Arguments& more = {})
{
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "out/Case", "-save:all"};
    words.insert(words.end(), more.begin(), more.end());
    return run(folder, words);
}

ParticleCloud particles(const TemporaryFolder& folder, const std::string& name = "out/Case")
{
    return fppg::read_particles(folder / name, false, 1);
}

std::vector<Vec3> positions_of(const ParticleCloud& cloud, std::uint16_t mk)
{
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        if (cloud.mk[i] == mk) out.push_back(cloud.positions[i]);
    return out;
}

/// Whether a position is a node of the lattice through the origin with the spacing dp.
bool is_node(const Vec3& p, double dp)
{
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(p[axis] / dp - std::round(p[axis] / dp)) > 1e-7) return false;
    return true;
}

double number(const Element& e, const char* name)
{
    const std::string* value = e.find_attribute(name);
    return value != nullptr ? std::stod(*value) : std::nan("");
}

const Element& child(const Element& e, const char* name)
{
    const Element* found = e.find_child(name);
    if (found == nullptr) throw std::runtime_error(std::string("no element ") + name);
    return *found;
}

std::vector<Element> blocks(const TemporaryFolder& folder)
{
    const Element root = fppg::read_xml(folder / "out/Case.xml");
    std::vector<Element> out;
    for (const Element& e : child(child(root, "execution"), "particles").children)
        if (e.find_attribute("begin") != nullptr) out.push_back(e);
    return out;
}

const std::string full = R"(<setdrawmode mode="full" />)";

std::string mkbound(int mk)
{
    return fmt::format(R"(<setmkbound mk="{}" />)", mk);
}

std::string sphere_command(double radius, const Vec3& at)
{
    return fmt::format(R"(<drawsphere radius="{}"><point x="{}" y="{}" z="{}" /></drawsphere>)",
                       radius, at.x, at.y, at.z);
}

constexpr double sphere_radius = 0.23;
const Vec3 sphere_center{0.51, 0.5, 0.45};

/// A tank with water and a solid sphere of mkbound 1 under it.
CaseText sphere_in_tank()
{
    CaseText out = tank();
    out.dp = "0.05";
    out.mainlist += mkbound(1) + sphere_command(sphere_radius, sphere_center);
    return out;
}

std::string fit_block(const std::string& attributes, const std::string& inside = "")
{
    return "<fppg><bodyfitted " + attributes + ">" + inside + "</bodyfitted></fppg>";
}

// -- a sphere in a tank
// ------------------------------------------------------------------------------

class FittedSphere : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        of_sphere = new TemporaryFolder;
        run_of_sphere = run_case(*of_sphere, sphere_in_tank(), {"-fit"});
    }
    static void TearDownTestSuite() { delete of_sphere; }

    static TemporaryFolder* of_sphere;
    static RunResult run_of_sphere;
};

TemporaryFolder* FittedSphere::of_sphere = nullptr;
RunResult FittedSphere::run_of_sphere;

TEST_F(FittedSphere, HasItsParticlesOffTheLatticeOnItsTrueSurface)
{
    ASSERT_EQ(run_of_sphere.code, 0) << run_of_sphere.output;
    const VtkFile picture(read_text(*of_sphere / "out/Case_All.vtk"));
    const auto& kind = picture.arrays.at("Kind");
    const ParticleCloud cloud = particles(*of_sphere);
    ASSERT_EQ(kind.size(), cloud.positions.size());
    std::size_t on_surface = 0;
    for (std::size_t i = 0; i < kind.size(); ++i)
    {
        if (cloud.mk[i] != bound_mk + 1) continue;
        const double away = norm(cloud.positions[i] - sphere_center);
        if (kind[i] == static_cast<int>(fppg::FitKind::Surface))
        {
            ++on_surface;
            EXPECT_NEAR(away, sphere_radius, 1e-9);
        }
        else
            EXPECT_LT(away, sphere_radius - 0.49 * 0.05);
    }
    const double area = 4 * std::numbers::pi * sphere_radius * sphere_radius;
    EXPECT_NEAR(static_cast<double>(on_surface) / (area / (0.05 * 0.05)), 1, 0.15);
}

TEST_F(FittedSphere, KeepsEveryParticleOnTheSurfaceOnTheLatticeWithoutFit)
{
    const TemporaryFolder other;
    ASSERT_EQ(run_case(other, sphere_in_tank()).code, 0);
    for (const Vec3& p : particles(other).positions) EXPECT_TRUE(is_node(p, 0.05));
    std::size_t off = 0;
    for (const Vec3& p : positions_of(particles(*of_sphere), bound_mk + 1))
        off += !is_node(p, 0.05);
    EXPECT_GT(off, 200u);
}

TEST_F(FittedSphere, HasBlocksInCaseXmlThatFitTheParticles)
{
    const ParticleCloud cloud = particles(*of_sphere);
    double next = 0;
    for (const Element& block : blocks(*of_sphere))
    {
        EXPECT_EQ(number(block, "begin"), next);
        const double count = number(block, "count");
        const auto mk = static_cast<std::uint16_t>(number(block, "mk"));
        EXPECT_EQ(static_cast<double>(positions_of(cloud, mk).size()), count) << mk;
        next += count;
    }
    EXPECT_EQ(next, static_cast<double>(cloud.positions.size()));
    const Element root = fppg::read_xml(*of_sphere / "out/Case.xml");
    EXPECT_EQ(number(child(child(root, "execution"), "particles"), "np"), next);
}

TEST_F(FittedSphere, HasUnitNormalsThatPointOutwardsInThePicture)
{
    const VtkFile picture(read_text(*of_sphere / "out/Case_All.vtk"));
    const auto& normal = picture.arrays.at("Normal");
    const auto& kind = picture.arrays.at("Kind");
    const auto& mk = picture.arrays.at("Mk");
    const auto& distance = picture.arrays.at("Distance");
    for (std::size_t i = 0; i < kind.size(); ++i)
    {
        if (mk[i] != bound_mk + 1 || kind[i] != static_cast<int>(fppg::FitKind::Surface)) continue;
        const Vec3 p{picture.points[3 * i], picture.points[3 * i + 1], picture.points[3 * i + 2]};
        const Vec3 n{normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]};
        EXPECT_NEAR(norm(n), 1, 1e-6);
        EXPECT_GT(dot(n, p - sphere_center), 0.999 * sphere_radius);
        EXPECT_NEAR(distance[i], 0, 1e-6);
    }
}

TEST_F(FittedSphere, WritesTheHistoryOfItsRelaxationUnlessRaw)
{
    const std::string history = read_text(*of_sphere / "out/Case_Relax.csv");
    EXPECT_TRUE(history.starts_with("what,iteration,particles,"));
    EXPECT_GT(std::count(history.begin(), history.end(), '\n'), 10);
    const TemporaryFolder other;
    ASSERT_EQ(run_case(other, sphere_in_tank(), {"-fit:raw"}).code, 0);
    EXPECT_FALSE(fs::exists(other / "out/Case_Relax.csv"));
    EXPECT_TRUE(fs::exists(other / "out/Case_Features.vtk"));
    for (const Vec3& p : positions_of(particles(other), bound_mk + 1))
    {
        if (is_node(p, 0.05)) continue;
        EXPECT_NEAR(norm(p - sphere_center), sphere_radius, 1e-9);
    }
}

// -- other shapes and settings
// -----------------------------------------------------------------------

TEST(FittedBox, HasItsTwelveEdgesInTheFeatureFile)
{
    const TemporaryFolder folder;
    CaseText text;
    text.mainlist = full + mkbound(0) +
                    box_command(R"(x="0.11" y="0.1" z="0.13")", R"(x="0.6" y="0.5" z="0.4")");
    ASSERT_EQ(run_case(folder, text, {"-fit"}).code, 0);
    const VtkFile features(read_text(folder / "out/Case_Features.vtk"));
    std::size_t lines = 0;
    const std::vector<int>& cells = features.cells.at("LINES");
    for (std::size_t i = 0; i < cells.size(); i += 1 + static_cast<std::size_t>(cells[i])) ++lines;
    EXPECT_EQ(lines, 12u);
    EXPECT_EQ(features.cells.at("VERTICES").size(), 2u * 8u);
}

TEST(FittedCase, IsTheSameAsWithoutItsBlockWhenFittingIsOff)
{
    const TemporaryFolder with;
    const TemporaryFolder without;
    CaseText text = sphere_in_tank();
    ASSERT_EQ(run_case(without, text).code, 0);
    const std::string block = fit_block(R"(mkbound="1")");
    text.after_geometry = block;
    ASSERT_EQ(run_case(with, text, {"-fit:off"}).code, 0);
    auto a = results(with.path() / "out");
    auto b = results(without.path() / "out");
    // The copy of the block in Case.xml is the one difference.
    std::string& xml = a.at("Case.xml");
    const std::size_t begin = xml.find("        <fppg>");
    const std::string end = "</fppg>\n";
    ASSERT_NE(begin, std::string::npos);
    xml.erase(begin, xml.find(end) + end.size() - begin);
    EXPECT_EQ(a.at("Case.xml"), b.at("Case.xml"));
    EXPECT_EQ(a == b, true);
}

TEST(FittedCase, IsFittedByItsBlockAsByTheOption)
{
    const TemporaryFolder option;
    const TemporaryFolder block;
    CaseText text = sphere_in_tank();
    ASSERT_EQ(run_case(option, text, {"-fit"}).code, 0);
    text.after_geometry = fit_block("");
    ASSERT_EQ(run_case(block, text).code, 0);
    EXPECT_EQ(read_text(option / "out/Case.bi4") == read_text(block / "out/Case.bi4"), true);
}

TEST(FittedCase, HasTheSameFilesWithOneTwoAndEightThreads)
{
    const TemporaryFolder folder;
    CaseText text = tank();
    text.dp = "0.04";
    text.mainlist = full + mkbound(1) + sphere_command(0.31, {0.47, 0.52, 0.41}) + mkbound(2) +
                    box_command(R"(x="0.52" y="0.3" z="0.35")", R"(x="0.43" y="0.4" z="0.37")") +
                    "<setmkvoid />" + sphere_command(0.2, {0.3, 0.3, 0.6}) + mkbound(0) +
                    box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")",
                                "bottom | left | right | front | back") +
                    R"(<setmkfluid mk="0" /><fillbox x="0.9" y="0.9" z="0.1">
<modefill>void</modefill><point x="0" y="0" z="0" /><size x="1" y="1" z="0.8" /></fillbox>)";
    text.after_geometry =
        R"(<fppg><bodyfitted mkbound="1-2"><relax iterations="15" /></bodyfitted>
<fluidband width="3" /></fppg>)";
    write_text(folder / "Case_Def.xml", text.text());
    for (const std::string threads : {"1", "2", "8"})
    {
        const RunResult result =
            run(folder, {"Case_Def", threads + "/Case", "-save:all", "-threads:" + threads});
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_TRUE(contains(result.output, "Relaxed volume")) << result.output;
    }
    const auto one = results(folder / "1");
    EXPECT_TRUE(one.contains("Case_Relax.csv") && one.contains("Case_Features.vtk") &&
                one.contains("Case_Fluid.vtk"));
    for (const char* threads : {"2", "8"})
    {
        const auto other = results(folder / threads);
        EXPECT_EQ(other.size(), one.size());
        for (const auto& [name, bytes] : one)
            EXPECT_EQ(other.at(name) == bytes, true) << name << " with " << threads << " threads";
    }
}

TEST(FittedCase, MayMoveAndFloat)
{
    const TemporaryFolder folder;
    CaseText text = sphere_in_tank();
    text.mainlist +=
        mkbound(2) + box_command(R"(x="0.1" y="0.62" z="0.61")", R"(x="0.23" y="0.21" z="0.24")");
    text.after_geometry =
        R"(<floatings><floating mkbound="2" rhopbody="500" /></floatings>
<motion><objreal ref="1"><begin mov="1" start="0" /><mvrect id="1" duration="2"><vel x="1" y="0" z="0" /></mvrect></objreal></motion>)" +
        fit_block(R"(mkbound="1-2")");
    const RunResult result = run_case(folder, text);
    ASSERT_EQ(result.code, 0) << result.output;
    const ParticleCloud cloud = particles(folder);
    std::map<std::string, Element> by_name;
    for (const Element& block : blocks(folder)) by_name[block.name] = block;
    ASSERT_EQ(by_name.size(), 4u);
    for (const auto& [name, mk, type] :
         {std::tuple{"moving", bound_mk + 1, ParticleType::Moving},
          std::tuple{"floating", bound_mk + 2, ParticleType::Floating}})
    {
        const Element& block = by_name.at(name);
        const auto begin = static_cast<std::size_t>(number(block, "begin"));
        const auto count = static_cast<std::size_t>(number(block, "count"));
        EXPECT_EQ(number(block, "mk"), mk);
        ASSERT_LE(begin + count, cloud.positions.size());
        EXPECT_EQ(positions_of(cloud, static_cast<std::uint16_t>(mk)).size(), count);
        std::size_t off = 0;
        for (std::size_t i = begin; i < begin + count; ++i)
        {
            EXPECT_EQ(cloud.type[i], static_cast<int>(type));
            off += !is_node(cloud.positions[i], 0.05);
        }
        EXPECT_GT(off, 50u) << name;
    }
    // Massbody = rhopbody * volume: the particles stand for all of it.
    const double expected = 500 * 0.23 * 0.21 * 0.24;
    EXPECT_NEAR(number(child(by_name.at("floating"), "massbody"), "value") / expected, 1, 0.005);
}

// -- Ctrl-C
// ------------------------------------------------------------------------------------------

/// A case whose relaxation takes minutes.
CaseText long_relaxation()
{
    CaseText text = sphere_in_tank();
    text.after_geometry = fit_block("", R"(<relax iterations="1000000" tolerance="1e-12" />)");
    return text;
}

/// Starts the program and waits until it relaxes.
Process relaxing(const TemporaryFolder& folder)
{
    write_text(folder / "Case_Def.xml", long_relaxation().text());
    Process process(FPPG_PROGRAM, {"Case_Def", "out/Case", "-save:all"}, folder.path().string());
    wait_until([&] { return contains(process.output_so_far(), "[Relax]"); });
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    return process;
}

TEST(FittedCaseStopped, WritesNothing)
{
    for (const int signal : {SIGINT, SIGTERM})
    {
        const TemporaryFolder folder;
        Process process = relaxing(folder);
        process.send(signal);
        const RunResult result = process.wait();
        EXPECT_EQ(result.code, 128 + signal) << result.output;
        EXPECT_TRUE(contains(result.output, "; no output file was changed")) << result.output;
        EXPECT_TRUE(contents(folder / "out").empty());
    }
}

// -- 2D
// ----------------------------------------------------------------------------------------------

CaseText flat_case(const std::string& mainlist)
{
    CaseText text;
    text.dp = "0.05";
    text.pointmin = R"(<pointmin x="-0.5" y="0.2" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0.2" z="1.5" />)";
    text.mainlist = full + mkbound(0) + mainlist;
    return text;
}

TEST(FittedCase2d, HasTheParticlesOfACircleEvenlyOnIt)
{
    const TemporaryFolder folder;
    const Vec3 center{0.51, 0.2, 0.48};
    const double radius = 0.33;
    const RunResult result = run_case(folder, flat_case(sphere_command(radius, center)), {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    std::vector<double> angles;
    for (const Vec3& p : particles(folder).positions)
    {
        EXPECT_EQ(p.y, 0.2);
        const double away = norm(p - center);
        EXPECT_LE(away, radius + 1e-9);
        if (away < radius - 1e-9) continue;
        angles.push_back(std::atan2(p.z - center.z, p.x - center.x));
    }
    std::sort(angles.begin(), angles.end());
    ASSERT_EQ(angles.size(), std::ceil(2 * std::numbers::pi * radius / 0.05));
    const double even = 2 * std::numbers::pi / static_cast<double>(angles.size());
    for (std::size_t i = 1; i < angles.size(); ++i)
        EXPECT_NEAR(angles[i] - angles[i - 1], even, 0.02 * even);
}

std::string side_box(const std::string& fill, const std::string& y, const std::string& size_y)
{
    return R"(<drawbox><boxfill>)" + fill + R"(</boxfill><point x="0.11" y=")" + y +
           R"(" z="0.13" /><size x="0.61" y=")" + size_y + R"(" z="0.53" /></drawbox>)";
}

TEST(FittedCase2d, FitsWhatLiesInThePlaneAsWhatCrossesIt)
{
    const std::string water =
        R"(<setmkfluid mk="0" /><fillbox x="0.4" y="0.2" z="0.3"><modefill>void</modefill><point x="0" y="0" z="0" /><size x="1" y="1" z="0.5" /></fillbox>)";
    // The front of a box without a width covers all of it; beside the plane it has its nodes too.
    for (const auto& [flat, deep] :
         {std::pair{side_box("solid", "0.2", "0"), side_box("solid", "-0.8", "2")},
          std::pair{side_box("all", "0.2", "0"), side_box("solid", "-0.8", "2")},
          std::pair{side_box("front", "0.21", "0.3"), side_box("solid", "-0.8", "2")},
          std::pair{side_box("bottom | left | right", "0.2", "0") + water,
                    side_box("bottom | left | right", "-0.8", "2") + water}})
        for (const std::string walls : {"<bodyfitted />", R"(<bodyfitted boundary="mdbc" />)"})
        {
            std::vector<std::vector<Vec3>> places;
            for (const std::string& shape : {flat, deep})
            {
                const TemporaryFolder folder;
                CaseText text = flat_case(shape);
                text.after_geometry = "<fppg>" + walls + "</fppg>";
                const RunResult result = run_case(folder, text);
                ASSERT_EQ(result.code, 0) << result.output;
                places.push_back(particles(folder).positions);
            }
            ASSERT_EQ(places[0].size(), places[1].size()) << flat << walls;
            EXPECT_GT(places[0].size(), 100u);
            for (const Vec3& p : places[0])
                EXPECT_TRUE(std::any_of(places[1].begin(), places[1].end(),
                                        [&](const Vec3& q) { return norm(p - q) < 1e-6; }))
                    << flat << walls << p.x << ' ' << p.z;
        }
}

TEST(FittedCase2d, FitsAFlatTriangle)
{
    const TemporaryFolder folder;
    const RunResult result = run_case(
        folder,
        flat_case(
            R"(<drawtriangle><point x="0.1" y="0.2" z="0.1" /><point x="0.9" y="0.2" z="0.1" />
<point x="0.6" y="0.2" z="0.77" /></drawtriangle>)"),
        {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    const std::vector<Vec3> places = particles(folder).positions;
    for (const Vec3& corner : {Vec3{0.1, 0.2, 0.1}, Vec3{0.9, 0.2, 0.1}, Vec3{0.6, 0.2, 0.77}})
        EXPECT_TRUE(std::any_of(places.begin(), places.end(),
                                [&](const Vec3& p) { return norm(p - corner) < 1e-9; }));
    // Half of the outermost particles stands for the inside.
    const double outline = 0.8 + std::hypot(0.5, 0.67) + std::hypot(0.3, 0.67);
    EXPECT_NEAR(static_cast<double>(places.size()) * 0.05 * 0.05,
                0.5 * 0.8 * 0.67 + outline * 0.025, 0.03 * 0.268);
}

TEST(FittedCase2d, DrawsWhatEndsBesideThePlaneOnTheLatticeAndSaysSo)
{
    const std::string shape = side_box("solid", "0.205", "0.01");
    const TemporaryFolder folder;
    const RunResult result = run_case(folder, flat_case(shape), {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "lies within dp/2 of the plane y = 0.2 of this 2D case"))
        << result.output;
    const TemporaryFolder lattice;
    ASSERT_EQ(run_case(lattice, flat_case(shape)).code, 0);
    EXPECT_GT(particles(folder).positions.size(), 100u);
    EXPECT_EQ(read_text(folder / "out/Case.bi4") == read_text(lattice / "out/Case.bi4"), true);
}

TEST(FittedCase2d, HasTheSameParticlesHoweverFarABoxReachesBeyondThePlane)
{
    std::vector<std::size_t> counts;
    for (const auto& [low, size] :
         {std::pair{"-2", "4"}, std::pair{"0.1", "0.2"}, std::pair{"0.2", "0.6"}})
    {
        const TemporaryFolder folder;
        const RunResult result =
            run_case(folder,
                     flat_case(box_command(fmt::format(R"(x="0.11" y="{}" z="0.12")", low),
                                           fmt::format(R"(x="0.63" y="{}" z="0.53")", size))),
                     {"-fit"});
        ASSERT_EQ(result.code, 0) << result.output;
        counts.push_back(particles(folder).positions.size());
    }
    EXPECT_EQ(counts, std::vector<std::size_t>(3, counts[0]));
    EXPECT_NEAR(static_cast<double>(counts[0]) * 0.05 * 0.05 / ((0.63 + 0.05) * (0.53 + 0.05)), 1,
                0.05);
}

// -- meshes and plates
// ------------------------------------------------------------------------------

/// A box from (0.1, 0.1, 0.1) to (0.6, 0.6, 0.6) as an ASCII STL file, of 10 facets without its
/// lid.
std::string stl_box(bool has_lid)
{
    const auto corner = [](int i)
    {
        return fmt::format("vertex {} {} {}\n", (i & 1) != 0 ? 0.6 : 0.1, (i & 2) != 0 ? 0.6 : 0.1,
                           (i & 4) != 0 ? 0.6 : 0.1);
    };
    const int quads[6][4] = {{4, 5, 7, 6}, {0, 2, 3, 1}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::string out = "solid box\n";
    const auto add = [&](int a, int b, int c)
    {
        out += "facet normal 0 0 0\nouter loop\n" + corner(a) + corner(b) + corner(c) +
               "endloop\nendfacet\n";
    };
    for (std::size_t q = has_lid ? 0 : 1; q < 6; ++q)
    {
        add(quads[q][0], quads[q][1], quads[q][2]);
        add(quads[q][0], quads[q][2], quads[q][3]);
    }
    return out + "endsolid box\n";
}

CaseText mesh_case()
{
    CaseText text;
    text.dp = "0.05";
    text.mainlist = full + mkbound(0) + R"(<drawfilestl file="box.stl" autofill="true" />)";
    return text;
}

/// Distance of a point to the surface of the box.
double distance_to_box(const Vec3& p)
{
    const Vec3 d = p - Vec3{0.35, 0.35, 0.35};
    return std::abs(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) - 0.25);
}

TEST(FittedMesh, OfABrokenFileIsRefusedWithItsPlaceAndOlderResultsStay)
{
    const TemporaryFolder folder;
    write_text(folder / "box.stl", stl_box(true));
    ASSERT_EQ(run_case(folder, mesh_case(), {"-fit"}).code, 0);
    const auto before = contents(folder / "out");
    ASSERT_TRUE(before.contains("Case.bi4"));
    std::string broken = stl_box(true);
    broken.replace(broken.rfind("vertex"), 10, "vertex 0,6");
    for (const std::string& bytes : {broken, std::string("this is no mesh")})
    {
        write_text(folder / "box.stl", bytes);
        const RunResult result = run_case(folder, mesh_case(), {"-fit"});
        EXPECT_EQ(result.code, 3) << result.output;
        EXPECT_TRUE(contains(result.output, "*** Error: Case_Def.xml:7: <drawfilestl>: "))
            << result.output;
        EXPECT_TRUE(contains(result.output, "box.stl")) << result.output;
        EXPECT_EQ(contents(folder / "out") == before, true);
    }
}

TEST(FittedMesh, WithoutALidIsCoveredAndTheHoleIsTold)
{
    const TemporaryFolder folder;
    write_text(folder / "box.stl", stl_box(false));
    const RunResult result = run_case(folder, mesh_case(), {"-fit"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(contains(result.output, "*** WARNING: Case_Def.xml:7: <drawfilestl>: box.stl: "))
        << result.output;
    EXPECT_TRUE(contains(result.output, "The surface is open: 4 edges")) << result.output;
    std::size_t on_surface = 0;
    for (const Vec3& p : particles(folder).positions) on_surface += distance_to_box(p) < 1e-7;
    EXPECT_GT(on_surface, 450u);
}

TEST(FittedPlate, OfOneSheetHasHalfTheParticlesOfBoth)
{
    std::map<std::string, double> count;
    for (const std::string plates : {"one", "both"})
    {
        const TemporaryFolder folder;
        CaseText text;
        text.dp = "0.05";
        text.mainlist = full + mkbound(0) +
                        box_command(R"(x="0.11" y="0.1" z="0.13")", R"(x="0.9" y="0.8" z="0.02")");
        text.after_geometry = fit_block("plates=\"" + plates + "\"");
        const RunResult result = run_case(folder, text);
        ASSERT_EQ(result.code, 0) << result.output;
        for (const Vec3& p : particles(folder).positions)
        {
            EXPECT_GE(p.z, 0.13 - 1e-9);
            EXPECT_LE(p.z, 0.15 + 1e-9);
        }
        count[plates] = static_cast<double>(particles(folder).positions.size());
    }
    EXPECT_NEAR(count["one"] / count["both"], 0.5, 0.05);
    EXPECT_NEAR(count["one"] * 0.05 * 0.05 / (0.9 * 0.8), 1, 0.2);
}

} // namespace
