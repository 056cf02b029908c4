#include "particles/initials.h"

#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "helpers/case_text.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace fppg
{
namespace
{

using test::box_command;
using test::CaseText;

/// Water from 0 to 0.5 (mkfluid 0), dp = 0.1, and a floating block 0.2 wide from x = 0.8 on.
struct Started
{
    CaseDef def;
    CaseConstants constants;
    CaseParticles particles;

    /// The particle that stood at a place before.
    InitialState water(double x, double y, double z, double rhop = 1000) const
    {
        InitialState state{{x, y, z}, {}, rhop};
        for (const ParticleBlock& block : particles.blocks)
            if (block.type == ParticleType::Fluid) apply_initials(block.initials, state);
        return state;
    }
};

Started start(const std::string& initials, const std::string& gravity = "",
              const std::string& more = "")
{
    CaseText text;
    if (!gravity.empty()) text.gravity = gravity;
    text.mainlist = R"(<setdrawmode mode="full" /><setmkfluid mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="0.5" y="0.5" z="0.5")") +
                    R"(<setmkbound mk="0" />)" +
                    box_command(R"(x="0.8" y="0" z="0")", R"(x="0.2" y="0.4" z="0.2")");
    text.after_geometry = "<initials>" + initials + "</initials>" +
                          R"(<floatings><floating mkbound="0" rhopbody="500" /></floatings>)" +
                          more;
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    Started out;
    out.def = read_case(folder / "Case_Def.xml", {});
    LatticeReport report;
    RunField field = draw_scene(make_scene(out.def), 1, {}, report);
    std::vector<std::string> warnings;
    out.particles = make_particles(out.def, field, 1, out.constants, warnings);
    return out;
}

void expect_vector(const Vec3& found, const Vec3& wanted, double tolerance = 1e-12)
{
    EXPECT_LE(norm(found - wanted), tolerance)
        << found.x << ' ' << found.y << ' ' << found.z << ", expected " << wanted.x << ' '
        << wanted.y << ' ' << wanted.z;
}

TEST(InitialVelocity, IsTheLastOneGivenWhereItApplies)
{
    const Started s = start(
        R"(<velocity mkfluid="0" x="1" y="2" z="3" /><velocity mkfluid="#4-4" x="4" y="0" z="0"><onlypos><posmin x="0.3" /></onlypos></velocity><velocity mkfluid="0" x="9" y="9" z="9" active="#1==0" /><velocity mkfluid="5" x="9" y="9" z="9" />)");
    expect_vector(s.water(0.2, 0, 0).velocity, {1, 2, 3});
    expect_vector(s.water(0.3, 0, 0).velocity, {4, 0, 0});
}

TEST(InitialVelocity, FollowsADirectionOfAnyLength)
{
    const Started s = start(
        R"(<velocity mkfluid="0"><direction x="3" y="0" z="4" /><velocity v="2" /></velocity>)");
    expect_vector(s.water(0, 0, 0).velocity, {1.2, 0, 1.6});
    const Started none = start(
        R"(<velocity mkfluid="0"><direction x="0" y="0" z="0" /><velocity v="2" /></velocity>)");
    expect_vector(none.water(0, 0, 0).velocity, {0, 0, 0});
}

TEST(InitialVelocity, IsALineOrAParabolaOfTheHeight)
{
    const Started line = start(
        R"(<velocity mkfluid="0"><direction x="1" y="0" z="0" /><velocity2 v="1" v2="3" z="0.2" z2="0.6" /></velocity>)");
    expect_vector(line.water(0, 0, 0.2).velocity, {1, 0, 0});
    expect_vector(line.water(0, 0, 0).velocity, {0, 0, 0});
    // Values of GenCase v5.0.229 at z = 0, 0.3 and 0.4.
    const Started parabola = start(
        R"(<velocity mkfluid="0"><direction x="1" y="0" z="0" /><velocity3 v="1" v2="0.6" v3="3" z="0.2" z2="0.5" z3="0.6" /></velocity>)");
    expect_vector(parabola.water(0, 0, 0).velocity, {7.6, 0, 0}, 1e-6);
    expect_vector(parabola.water(0, 0, 0.3).velocity, {-0.4, 0, 0}, 1e-5);
    expect_vector(parabola.water(0, 0, 0.4).velocity, {-0.533333, 0, 0}, 1e-5);
}

TEST(InitialVelocity, OfASolitaryWaveIsHighestAtItsCrest)
{
    const Started s = start(R"(<velwave mkfluid="0" depth="0.4" hmaxwave="0.2" x0="0.3" />)");
    expect_vector(s.water(0.3, 0, 0).velocity, {std::sqrt(9.81 / 0.4) * 0.2, 0, 0});
    const double k = std::sqrt(3 * 0.2 / (4 * 0.4 * 0.4 * 0.4));
    const double sech = 1 / std::cosh(k * 0.3);
    expect_vector(s.water(0, 0.2, 0.4).velocity, {std::sqrt(9.81 / 0.4) * 0.2 * sech * sech, 0, 0});
    const Started back =
        start(R"(<velwave mkfluid="0" depth="0.4" hmaxwave="0.2" x0="0.3" negative="true" />)");
    expect_vector(back.water(0.3, 0, 0).velocity, {-std::sqrt(9.81 / 0.4) * 0.2, 0, 0});
}

TEST(InitialDensity, IsUniformOrChangesAlongALineAndStopsAtItsEnds)
{
    EXPECT_EQ(start(R"(<densityuniform mkfluid="0" rhop="1100" />)").water(0, 0, 0).rhop, 1100);
    const Started s = start(
        R"(<densitygradient mkfluid="0"><pos1 x="0" y="0" z="0.1" rhop="1100" /><pos2 x="0" y="0" z="0.3" rhop="1200" /></densitygradient>)");
    EXPECT_NEAR(s.water(0.3, 0, 0.2).rhop, 1150, 1e-9);
    EXPECT_NEAR(s.water(0.3, 0, 0.0).rhop, 1100, 1e-9);
    EXPECT_NEAR(s.water(0.3, 0, 0.5).rhop, 1200, 1e-9);
}

TEST(InitialDensity, OfADepthUsesWhatIsGivenAndTheCaseForTheRest)
{
    const Started s = start(
        R"(<densitydepth mkfluid="0"><posswl x="0" y="0" z="0.4" /><rhop0 value="1100" /><gamma value="6.7" /><b value="2.1e5" /></densitydepth>)");
    EXPECT_NEAR(s.water(0, 0, 0.1).rhop, 1100 * std::pow(1 + 1100 * 9.81 * 0.3 / 2.1e5, 1 / 6.7),
                1e-9);
    EXPECT_EQ(s.water(0, 0, 0.5).rhop, 1100);
    const Started own = start(R"(<densitydepth mkfluid="0" />)");
    EXPECT_NEAR(own.water(0, 0, 0.1).rhop,
                1000 * std::pow(1 + 1000 * 9.81 * 0.4 / own.constants.b, 1.0 / 7), 1e-9);
}

TEST(InitialDensity, FindsTheSurfaceAmongTheSelectedParticlesAtTheirPlaces)
{
    const Started s = start(
        R"(<move mkfluid="0" x="0" y="0" z="0.2" /><densitydepth mkfluid="0"><onlypos><posmax z="0.45" /></onlypos></densitydepth>)");
    // The highest selected particle has moved to z = 0.4.
    EXPECT_NEAR(s.water(0, 0, 0).rhop,
                1000 * std::pow(1 + 1000 * 9.81 * 0.2 / s.constants.b, 1.0 / 7), 1e-9);
    EXPECT_EQ(s.water(0, 0, 0.4, 1234).rhop, 1234);
}

/// A file with 3 x 1 x 3 nodes 0.2 apart from (0, 0, 0) on, and what it holds at the times 0 and 1.
std::string mesh_file(const std::string& type, const std::string& first, const std::string& second)
{
    return "Format;DataName;DataUnits;DataType;Data12;Npt1;Npt2;Npt3;PtRef.x [m];PtRef.y;PtRef.z;"
           "Vec1.x [m];Vec1.y;Vec1.z;Vec2.x;Vec2.y;Vec2.z;Vec3.x;Vec3.y;Vec3.z;DirDat.x;DirDat.y;"
           "DirDat.z\nJMeshTDatas-200817;Data; [x];" +
           type + ";false;3;1;3; 0.0E+00;0;0;0.2;0;0;0;0.2;0;0;0;0.2;1;0;0\r\ntime [s];v(0:0:0)\n" +
           first + "\n" + second + "\n";
}

Started start_with_mesh(const std::string& file, const std::string& initials)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "mesh.csv", file);
    std::string text = initials;
    text.replace(text.find("FILE"), 4, folder / "mesh.csv");
    return start(text);
}

TEST(InitialMesh, GivesDensitiesBetweenItsNodesAndTimes)
{
    // 1000 + 10 i + 100 k, 7 more in the middle; 1000 more at the second time.
    const std::string file = mesh_file("float", "0;1000;1010;1020;1100;1117;1120;1200;1210;1220",
                                       "1;2000;2010;2020;2100;2117;2120;2200;2210;2220");
    const Started s =
        start_with_mesh(file, R"(<densitymesh mkfluid="0"><meshdata file="FILE" /></densitymesh>)");
    EXPECT_NEAR(s.water(0.1, 0, 0.1).rhop, 1056.75, 1e-9); // value of GenCase v5.4.354
    EXPECT_NEAR(s.water(0.2, 0.3, 0.2).rhop, 1117, 1e-9);
    EXPECT_NEAR(s.water(0.5, 0, 0.5).rhop, 1220, 1e-9);
    EXPECT_NEAR(s.water(-0.1, 0, -0.1).rhop, 1000, 1e-9);
    const Started later = start_with_mesh(
        file,
        R"(<densitymesh mkfluid="0"><meshdata file="FILE" setx="0.1" initialtime="0.25" /></densitymesh>)");
    EXPECT_NEAR(later.water(0.2, 0, 0.1).rhop, 1306.75, 1e-9);
}

TEST(InitialMesh, GivesSpeedsAlongADirectionOrVectors)
{
    const Started speeds = start_with_mesh(
        mesh_file("float", "0;0;1;2;10;11;12;20;21;22", ""),
        R"(<velmesh mkfluid="0"><direction x="1" y="1" z="0" /><meshdata file="FILE" magnitude="true" /></velmesh>)");
    expect_vector(speeds.water(0.1, 0, 0.1).velocity,
                  {5.5 * std::sqrt(0.5), 5.5 * std::sqrt(0.5), 0});
    const std::string vectors =
        mesh_file("float3", "0;3;4;0;3;4;0;0;0;0;1;2;2;1;2;2;0;0;0;1;2;2;1;2;2;0;0;0", "");
    const Started whole = start_with_mesh(
        vectors, R"(<velmesh mkfluid="0"><meshdata file="FILE" magnitude="false" /></velmesh>)");
    expect_vector(whole.water(0.1, 0, 0.1).velocity, {2, 3, 1});
    const Started part = start_with_mesh(
        vectors,
        R"(<velmesh mkfluid="0"><direction x="1" y="1" z="0" /><meshdata file="FILE" magnitude="false" reverse="true" /></velmesh>)");
    expect_vector(part.water(0, 0, 0).velocity, {-3.5, -3.5, 0});
}

TEST(InitialMesh, IsRefusedWhereItsFileIsWrong)
{
    const auto message = [](const std::string& file, const std::string& magnitude)
    {
        try
        {
            start_with_mesh(file, R"(<velmesh mkfluid="0"><direction x="1" y="0" z="0" />)"
                                  R"(<meshdata file="FILE" magnitude=")" +
                                      magnitude + "\" /></velmesh>");
        }
        catch (const CaseError& error)
        {
            return std::string(error.what());
        }
        return std::string("nothing was thrown");
    };
    const std::string good = "0;0;1;2;10;11;12;20;21;22";
    EXPECT_NE(message(mesh_file("float", good, ""), "false").find("holds one number per node"),
              std::string::npos);
    EXPECT_NE(
        message(mesh_file("float", good + ";3", ""), "true").find("mesh.csv:4: the line has 11"),
        std::string::npos);
    EXPECT_NE(message(mesh_file("float", good, good), "true").find("mesh.csv:5: the line does not"),
              std::string::npos);
    EXPECT_NE(message(mesh_file("float", "", ""), "true").find("where values are expected"),
              std::string::npos);
    EXPECT_NE(message("x\ny\n", "true").find("is no mesh data"), std::string::npos);
    EXPECT_THROW(start(R"(<densitymesh mkfluid="0"><meshdata file="no_such.csv" /></densitymesh>)"),
                 IoError);
}

/// A binary file of the same kind (without 64-bit sizes).
class BinaryMesh
{
public:
    BinaryMesh() : bytes_("#FileJBD JMeshTDatas")
    {
        bytes_.resize(58, ' ');
        bytes_ += std::string("\n\0\0\0\0\0", 6);
    }

    struct Data
    {
        std::string name;
        std::vector<float> values;
        bool is_vector = false;
        int tag = 0;
    };

    /// The description of a mesh of 3 x 1 x 3 nodes.
    void describe(const std::vector<Data>& data, std::uint32_t version = 200817)
    {
        values_.clear();
        n_values_ = 0;
        value("FormatVer", 8, version);
        value("MeshPtRef", 23, std::array<double, 3>{0, 0, 0});
        value("MeshVdp1", 23, std::array<double, 3>{0.2, 0, 0});
        value("MeshVdp2", 23, std::array<double, 3>{0, 0.2, 0});
        value("MeshVdp3", 23, std::array<double, 3>{0, 0, 0.2});
        value("MeshNpt1", 8, 3U);
        value("MeshNpt2", 8, 1U);
        value("MeshNpt3", 8, 3U);
        value("Data_Count", 8, static_cast<std::uint32_t>(data.size()));
        for (std::size_t i = 0; i < data.size(); ++i)
        {
            ++n_values_;
            values_ += text("DataName_0" + std::to_string(i)) + raw(1) + text(data[i].name);
            value("DataTag_0" + std::to_string(i), 7, data[i].tag);
        }
        add_item({});
    }

    void add_time(double time, const std::vector<Data>& data)
    {
        values_.clear();
        n_values_ = 0;
        value("TimeStep", 12, time);
        add_item(data);
    }

    const std::string& bytes() const { return bytes_; }

private:
    template <typename T>
    static std::string raw(const T& v)
    {
        return {reinterpret_cast<const char*>(&v), sizeof v};
    }
    static std::string text(const std::string& s)
    {
        return raw(static_cast<std::uint32_t>(s.size())) + s;
    }
    template <typename T>
    void value(const std::string& name, int type, const T& v)
    {
        ++n_values_;
        values_ += text(name) + raw(type) + raw(v);
    }
    void add_item(const std::vector<Data>& data)
    {
        const std::string values = text("\nVALUES") + raw(n_values_) + values_;
        bytes_ += raw(0U) + text("\nITEM\n") + text("ITEM") + raw(0) + raw(0) + text("%.7E") +
                  text("%.15E") + raw(static_cast<std::uint32_t>(data.size())) + raw(0U) +
                  raw(static_cast<std::uint32_t>(values.size())) + values;
        for (const Data& d : data)
        {
            bytes_ += raw(0U) + text("\nARRAY") + text(d.name) + raw(0) +
                      raw(d.is_vector ? 22 : 11) +
                      raw(static_cast<std::uint32_t>(d.values.size() / (d.is_vector ? 3 : 1))) +
                      raw(static_cast<std::uint32_t>(4 * d.values.size()));
            for (const float v : d.values) bytes_ += raw(v);
        }
    }

    std::string bytes_;
    std::string values_;
    std::uint32_t n_values_ = 0;
};

const BinaryMesh::Data densities{"rhop", {1000, 1010, 1020, 1100, 1117, 1120, 1200, 1210, 1220}};

Started start_with_binary(const BinaryMesh& mesh, const std::string& element)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "mesh.MBI4", mesh.bytes());
    std::string text = element;
    text.replace(text.find("FILE"), 4, folder / "mesh.MBI4");
    return start(text);
}

constexpr const char* density_mesh =
    R"(<densitymesh mkfluid="0"><meshdata file="FILE" initialtime="0.25" /></densitymesh>)";

TEST(InitialMesh, IsTheSameFromABinaryFile)
{
    BinaryMesh mesh;
    const BinaryMesh::Data other{"VelDir", std::vector<float>(9, 3)};
    mesh.describe({other, densities});
    mesh.add_time(0, {other, densities});
    BinaryMesh::Data later = densities;
    for (float& v : later.values) v += 1000;
    mesh.add_time(1, {other, later});
    const Started s = start_with_binary(mesh, density_mesh);
    EXPECT_NEAR(s.water(0.1, 0, 0.1).rhop, 1306.75, 1e-9);
    const Started speeds = start_with_binary(
        mesh,
        R"(<velmesh mkfluid="0"><direction x="0" y="0" z="2" /><meshdata file="FILE" magnitude="true" /></velmesh>)");
    expect_vector(speeds.water(0.1, 0, 0.1).velocity, {0, 0, 3});
}

TEST(InitialMesh, OfTwoDimensionsIsTheSameAllAlongTheThird)
{
    BinaryMesh mesh;
    const BinaryMesh::Data flat{"Rhop", {1000, 1010, 1020}, false, 12};
    mesh.describe({flat});
    mesh.add_time(0, {flat});
    const Started s = start_with_binary(mesh, density_mesh);
    EXPECT_NEAR(s.water(0.1, 0, 0.4).rhop, 1005, 1e-9);
}

TEST(InitialMesh, IsRefusedWhereABinaryFileIsWrong)
{
    const auto message = [](const BinaryMesh& mesh)
    {
        try
        {
            start_with_binary(mesh, density_mesh);
        }
        catch (const Error& error)
        {
            return std::string(error.what());
        }
        return std::string("nothing was thrown");
    };
    BinaryMesh unnamed;
    unnamed.describe({{"Foo", densities.values}});
    EXPECT_NE(message(unnamed).find("mesh.MBI4: the file has no data named Rhop, only Foo"),
              std::string::npos);
    BinaryMesh old;
    old.describe({densities}, 1);
    EXPECT_NE(message(old).find("format version 1, expected 200817"), std::string::npos);
    BinaryMesh empty;
    empty.describe({densities});
    EXPECT_NE(message(empty).find("holds no time"), std::string::npos);
    empty.add_time(0, {{"Rhop", {1000, 1000}}});
    EXPECT_NE(message(empty).find("has 2 numbers of Rhop at 0 s, expected 9"), std::string::npos);
    EXPECT_NE(message({}).find("announced"), std::string::npos);
}

TEST(InitialRandomMove, IsThatOfGenCase)
{
    // Displacements in dp by GenCase v5.4.354 for the seed 1 and dpxyz 1, the first two particles.
    const Started s = start(R"(<moverandom mkfluid="0" randomseed="1" dpxyz="1" />)");
    const ParticleBlock& water = s.particles.blocks.back();
    InitialState first{{0.1, 0.1, 0.1}, {}, 1000, 0};
    apply_initials(water.initials, first);
    expect_vector(first.position - Vec3{0.1, 0.1, 0.1},
                  {0.0439127794932574, -0.0301898516714573, 0.0278389235492796}, 1e-15);
    InitialState second{{0.1, 0.1, 0.2}, {}, 1000, 1};
    apply_initials(water.initials, second);
    EXPECT_NEAR(second.position.x - 0.1, 0.0300744566367939, 1e-15);
}

TEST(InitialRandomMove, TakesOneNumberAnAxisThatMoves)
{
    const Started s = start(
        R"(<moverandom mkfluid="0" randomseed="7" dpxyz="0.5" dpx="0" dpz="1" /><moverandom mkfluid="0" randomseed="7" dpx="1" />)");
    const ParticleBlock& water = s.particles.blocks.back();
    InitialState third{{}, {}, 1000, 2};
    apply_initials(water.initials, third);
    // The generator's numbers for the seed 7: 0.26258378, 0.02489923, 0.75076273, 0.60054892,
    // 0.25489406, 0.95012949.
    expect_vector(third.position, {0.025076273, 0.05 * (0.25489406 - 0.5), 0.045012949}, 1e-9);
}

TEST(InitialRandomMove, IsRefusedForBoundariesAndBelowZero)
{
    EXPECT_THROW(start(R"(<moverandom mkbound="0" randomseed="1" dpx="1" />)"), CaseError);
    EXPECT_THROW(start(R"(<moverandom mkfluid="0" randomseed="1" dpx="-1" />)"), CaseError);
    EXPECT_THROW(start(R"(<moverandom mkfluid="0" dpx="1" />)"), CaseError);
    EXPECT_THROW(start(R"(<moverandom mkfluid="0" randomseed="1" dpxyz="30" />)"), CaseError);
}

TEST(InitialMove, ShiftsPlacesBeforeWhatFollows)
{
    const Started s = start(
        R"(<move mkfluid="0" x="0.2" y="0" z="0.01" /><velocity mkfluid="0" x="1" y="0" z="0"><onlypos><posmin x="0.65" /></onlypos></velocity>)");
    expect_vector(s.water(0.5, 0, 0).position, {0.7, 0, 0.01});
    expect_vector(s.water(0.5, 0, 0).velocity, {1, 0, 0});
    expect_vector(s.water(0.4, 0, 0).velocity, {0, 0, 0});
    EXPECT_NEAR(s.particles.pos_max.z, 0.51, 1e-12);
}

TEST(InitialRotation, IsClockwiseSeenFromTheTipAndTurnsVelocities)
{
    const Started s = start(
        R"(<velocity mkfluid="0" x="1" y="0" z="0" /><rotateaxis mkfluid="0" angle="90" anglesunits="degrees"><axisp1 x="0.5" y="0.5" z="0" /><axisp2 x="0.5" y="0.5" z="1" /></rotateaxis>)");
    expect_vector(s.water(0.5, 0.3, 0.2).position, {0.3, 0.5, 0.2});
    expect_vector(s.water(0.5, 0.3, 0.2).velocity, {0, -1, 0});
    const Started radians = start(
        R"(<rotateaxis mkfluid="0" angle="0.25" anglesunits="radians"><axisp1 x="0" y="0.2" z="0" /><axisp2 x="0" y="1" z="0" /></rotateaxis>)");
    expect_vector(radians.water(0.5, 0.3, 0).position,
                  {0.5 * std::cos(0.25), 0.3, 0.5 * std::sin(0.25)});
}

TEST(InitialRotation, TakesAFloatingBodyAlong)
{
    const Started still = start("");
    const Started turned = start(
        R"(<rotateaxis mkbound="0" angle="-90" anglesunits="degrees"><axisp1 x="0.9" y="0.2" z="0" /><axisp2 x="0.9" y="0.2" z="1" /></rotateaxis>)");
    ASSERT_EQ(turned.particles.floatings.size(), 1U);
    const FloatingBody& before = still.particles.floatings[0];
    const FloatingBody& after = turned.particles.floatings[0];
    expect_vector(before.center, {0.9, 0.2, 0.1});
    expect_vector(after.center, {0.9, 0.2, 0.1});
    EXPECT_NEAR(after.inertia[0].x, before.inertia[1].y, 1e-9);
    EXPECT_NEAR(after.inertia[1].y, before.inertia[0].x, 1e-9);
    EXPECT_NE(before.inertia[0].x, before.inertia[1].y);
}

TEST(InitialMove, TakesAFittedBodyAlongWithTheLimits)
{
    const char* const fit = R"(<fppg><bodyfitted mkbound="0" place="surface" /></fppg>)";
    const Started still = start("", "", fit);
    const Started moved = start(R"(<move mkbound="0" x="0.03" y="0" z="0.31" />)", "", fit);
    ASSERT_GT(moved.particles.off_lattice.size(), 30U);
    EXPECT_TRUE(moved.particles.off_lattice.positions == still.particles.off_lattice.positions);
    expect_vector(moved.particles.pos_min, {0, 0, 0});
    expect_vector(still.particles.pos_max, {1, 0.5, 0.5});
    expect_vector(moved.particles.pos_max, {1.03, 0.5, 0.51});
    expect_vector(moved.particles.floatings.at(0).center,
                  still.particles.floatings.at(0).center + Vec3{0.03, 0, 0.31}, 1e-9);
}

TEST(InitialMove, RefusesAFittedBodyThatLeavesTheDomain)
{
    const char* const fit = R"(<fppg><bodyfitted mkbound="0" place="surface" /></fppg>)";
    EXPECT_NO_THROW(start(R"(<move mkbound="0" x="0.5" y="0" z="0" />)", "", fit));
    EXPECT_THROW(start(R"(<move mkbound="0" x="0.5001" y="0" z="0" />)", "", fit), CaseError);
}

struct Mistake
{
    const char* initials;
    const char* message;
};

class WrongInitials : public testing::TestWithParam<Mistake>
{
};

TEST_P(WrongInitials, AreRefusedWithTheElementAtFault)
{
    try
    {
        start(GetParam().initials);
        FAIL() << "nothing was thrown";
    }
    catch (const CaseError& error)
    {
        EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos)
            << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(
    Of, WrongInitials,
    testing::Values(
        Mistake{"<foo />", "<foo>: is not known in <initials>"},
        Mistake{R"(<velmesh mkfluid="0" />)", "<velmesh>: the element <meshdata> is missing"},
        Mistake{R"(<densitymesh mkfluid="0"><direction x="1" y="0" z="0" /></densitymesh>)",
                "<direction>: is not known in <densitymesh>"},
        Mistake{R"(<moverandom mkfluid="0" />)", "attribute 'randomseed' is missing"},
        Mistake{R"(<velocity x="1" y="0" z="0" />)", "attribute 'mkfluid' is missing"},
        Mistake{R"(<velocity mkbound="0" x="1" y="0" z="0" />)", "only fluid can have"},
        Mistake{R"(<velocity mkfluid="0" x="1" y="0" />)", "attribute 'z' is missing"},
        Mistake{R"(<velocity mkfluid="0-1" x="1" y="0" z="0" />)", "not a valid integer"},
        Mistake{R"(<velocity mkfluid="0"><direction x="1" y="0" z="0" /></velocity>)",
                "<velocity> (or <velocity2>, <velocity3>) is missing"},
        Mistake{R"(<move mkbound="0" mkfluid="0" x="1" y="0" z="0" />)", "expected one of them"},
        Mistake{R"(<move mkfluid="0" x="1" y="0" z="0"><onlypos /></move>)",
                "<onlypos>: is not known in <move>"},
        Mistake{R"(<move mkfluid="0" x="1.2" y="0" z="0" />)",
                "particles of mkfluid 0 are moved to x = 1.7, outside the domain"},
        Mistake{
            R"(<densitygradient mkfluid="0"><pos1 x="0" y="0" z="0" rhop="1" /><pos2 x="0" y="0" z="0" rhop="2" /></densitygradient>)",
            "<pos2>: is the same point"},
        Mistake{
            R"(<rotateaxis mkfluid="0" angle="1" anglesunits="turns"><axisp1 x="0" y="0" z="0" /><axisp2 x="0" y="0" z="1" /></rotateaxis>)",
            "anglesunits=\"turns\" is invalid"}));

} // namespace
} // namespace fppg
