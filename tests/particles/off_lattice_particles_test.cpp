#include "fppg/case_def.h"
#include "fppg/particles.h"

#include "helpers/case_text.h"
#include "helpers/dense_grid.h"

#include "helpers/round_meshes.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

namespace fppg
{
namespace
{

using test::CaseText;
using test::Dice;

/// The cube from the origin to (1, 1, 1), two facets a side.
SurfaceMesh cube()
{
    TriangleSoup soup;
    const auto corner = [](int i) {
        return Vec3{double(i & 1), double(i >> 1 & 1), double(i >> 2)};
    };
    for (const std::array<int, 4>& q :
         {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
          std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
        for (const std::size_t i : {0, 1, 2, 0, 2, 3}) soup.vertices.push_back(corner(q[i]));
    MeshReport report;
    return repair_mesh(soup, {}, 1, report);
}

/// The facet that looks along `direction`, the first of them.
std::uint32_t facet_towards(const SurfaceMesh& mesh, const Vec3& direction)
{
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (dot(mesh.normals[f], direction) > 0.99) return f;
    return no_index;
}

struct Made
{
    CaseDef def;
    CaseConstants constants;
    CaseParticles particles;
};

/// A small case with mk 1 and 2 fluid, 10 and 13 fixed, 11 moving, 12 floating.
CaseText small_case()
{
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.37" y="-0.2" z="0.05" />)";
    text.pointmax = R"(<pointmax x="0.53" y="0.5" z="1.15" />)";
    text.after_geometry =
        R"(<floatings><floating mkbound="2" rhopbody="500" /></floatings>
<motion><objreal ref="1"><begin mov="1" start="0" /><wait id="1" duration="1" /></objreal></motion>)";
    return text;
}

CaseDef read(const CaseText& text)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    return read_case(folder / "Case_Def.xml", {});
}

Made make(const CaseDef& def, RunField field, int threads = 1)
{
    Made made;
    made.def = def;
    std::vector<std::string> warnings;
    made.particles = make_particles(def, field, threads, made.constants, warnings);
    return made;
}

Vec3 place_of(const LatticeGrid& grid, std::int64_t x, std::int64_t y, std::int64_t z)
{
    return grid.origin + Vec3{double(x) * grid.dp, double(y) * grid.dp, double(z) * grid.dp};
}

/// A particle as a file would show it.
struct Shown
{
    std::uint16_t mk = 0;
    ParticleType type = ParticleType::Fixed;
    Vec3 position;
    float rhop = 0; ///< of fluid
    bool is_off_lattice = false;
};

std::vector<Shown> all_of(const CaseParticles& particles)
{
    std::vector<Shown> out;
    std::size_t fluid = 0;
    for (const ParticleBlock& block : particles.blocks)
    {
        EXPECT_EQ(block.begin, out.size());
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k)
            {
                Shown p{block.mk, block.type, {}, 0, run.is_off_lattice};
                if (run.is_off_lattice)
                    p.position = particles.off_lattice.positions.at(run.off_lattice_begin() + k);
                else
                    p.position = place_of(particles.grid, run.x, run.y,
                                          block.run_descending ? run.z - k : run.z + k);
                if (block.type == ParticleType::Fluid)
                {
                    if (!particles.rhop.empty())
                        p.rhop = particles.rhop.at(fluid++);
                    else if (!run.is_off_lattice)
                        p.rhop = particles.rhop_of_depth.at(
                            run.depth + (block.run_descending ? k : run.count - 1 - k));
                    if (run.is_off_lattice)
                    {
                        const float rhop =
                            particles.off_lattice.rhop.at(run.off_lattice_begin() + k);
                        if (!particles.rhop.empty())
                        {
                            EXPECT_EQ(p.rhop, rhop);
                        }
                        p.rhop = rhop;
                    }
                }
                out.push_back(p);
            }
        EXPECT_EQ(block.begin + block.count, out.size());
    }
    EXPECT_EQ(out.size(), particles.np);
    return out;
}

/// Nodes in clumps of all mk.
test::DenseMks any_nodes(const LatticeGrid& grid, Dice& dice)
{
    test::DenseMks nodes(grid);
    std::uint16_t last = 0;
    test::for_each_node(
        grid,
        [&](const Node& n)
        {
            if (dice.whole(0, 2) == 0)
                last = dice.one_of({std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{1},
                                    std::uint16_t{2}, std::uint16_t{10}, std::uint16_t{11},
                                    std::uint16_t{12}, std::uint16_t{13}});
            nodes.at(n.x, n.y, n.z) = last;
        });
    return nodes;
}

/// A field of these nodes with a wall that has no particle yet.
RunField walled(const test::DenseMks& nodes)
{
    RunField field = test::runs_of(nodes);
    field.walls.bodies.emplace_back();
    field.walls.bodies[0].mesh = cube();
    return field;
}

void add_to_wall(FittedWalls& walls, const Vec3& p, std::uint16_t mk,
                 FitKind kind = FitKind::Surface, std::uint32_t facet = 0)
{
    walls.particles.positions.push_back(p);
    walls.particles.kinds.push_back(kind);
    walls.particles.bodies.push_back(static_cast<std::uint32_t>(walls.bodies.size() - 1));
    walls.particles.facets.push_back(facet);
    walls.particles.mk.push_back(mk);
}

void add_to_volume(FittedWalls& walls, const Vec3& p, std::uint16_t mk, float distance = 0)
{
    walls.volume.positions.push_back(p);
    walls.volume.mk.push_back(mk);
    walls.volume.distances.push_back(distance);
}

/// Nodes of which a part became particles of the volume at the very same places.
RunField with_nodes_taken_off_lattice(test::DenseMks nodes, Dice& dice)
{
    FittedWalls walls;
    test::for_each_node(nodes.grid,
                        [&](const Node& n)
                        {
                            std::uint16_t& mk = nodes.at(n.x, n.y, n.z);
                            if (mk == 0 || dice.whole(0, 3) > 0) return;
                            add_to_volume(walls, place_of(nodes.grid, n.x, n.y, n.z), mk);
                            mk |= test::covered;
                        });
    RunField field = walled(nodes);
    field.walls.volume = walls.volume;
    return field;
}

const char* const orders[] = {"xyz", "xyZ", "Xyz", "xYZ", "zyx", "zXy", "YZX"};

CaseText oriented(const std::string& order)
{
    CaseText text = small_case();
    text.mkconfig = R"(<mkconfig boundcount="240" fluidcount="9"><mkorientbound mk="0" orient=")" +
                    order + R"(" /><mkorientfluid mk="0" orient=")" + order + R"(" /></mkconfig>)";
    return text;
}

RC_GTEST_PROP(OffLatticeParticles, StandAmongTheNodesInTheOrderOfAllPositions, (std::uint32_t seed))
{
    Dice dice(seed);
    const std::string order = dice.one_of(orders);
    const CaseDef def = read(oriented(order));
    const test::DenseMks nodes = any_nodes(def.grid, dice);
    RunField field = walled(nodes);
    FittedWalls& walls = field.walls;
    for (int i = 0; i < 300; ++i)
    {
        // On nodes, between the nodes of a column, in a plane of nodes, anywhere.
        const auto coordinate = [&](int axis)
        {
            const double at =
                dice.coin() ? dice.real(-1, 12) : static_cast<double>(dice.whole(-1, 12));
            return def.grid.origin[axis] + at * def.grid.dp;
        };
        const Vec3 p{coordinate(0), coordinate(1), coordinate(2)};
        const std::uint16_t mk = dice.one_of(
            {std::uint16_t{1}, std::uint16_t{10}, std::uint16_t{11}, std::uint16_t{12}});
        if (dice.coin())
            add_to_wall(walls, p, mk);
        else
            add_to_volume(walls, p, mk);
    }
    const Made made = make(def, field);

    struct Key
    {
        int type;
        std::uint16_t mk;
        std::array<double, 3> place;
        bool is_off_lattice;
        auto tied() const { return std::tie(type, mk, place, is_off_lattice); }
    };
    const std::map<std::uint16_t, int> type_of{{10, 0}, {11, 1}, {12, 2}, {13, 0}, {1, 3}, {2, 3}};
    std::vector<Key> expected;
    const auto add = [&](std::uint16_t mk, const Vec3& p, bool is_off_lattice)
    {
        const bool is_oriented = mk == 1 || mk == 10;
        Key key{type_of.at(mk), mk, {p.x, p.y, p.z}, is_off_lattice};
        for (std::size_t i = 0; is_oriented && i < 3; ++i)
        {
            const double v = p[(order[i] | 0x20) - 'x'];
            key.place[i] = order[i] < 'a' ? -v : v;
        }
        expected.push_back(key);
    };
    test::for_each_node(def.grid,
                        [&](const Node& n)
                        {
                            if (const auto mk = nodes.at(n.x, n.y, n.z))
                                add(mk, place_of(def.grid, n.x, n.y, n.z), false);
                        });
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
        add(walls.particles.mk[i], walls.particles.positions[i], true);
    for (std::size_t i = 0; i < walls.volume.size(); ++i)
        add(walls.volume.mk[i], walls.volume.positions[i], true);
    std::sort(expected.begin(), expected.end(),
              [](const Key& a, const Key& b) { return a.tied() < b.tied(); });
    std::vector<Key> by_brute_force;
    by_brute_force.swap(expected);
    for (const Shown& p : all_of(made.particles)) add(p.mk, p.position, p.is_off_lattice);
    RC_ASSERT(expected.size() == by_brute_force.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        RC_ASSERT(expected[i].tied() == by_brute_force[i].tied());
}

RC_GTEST_PROP(OffLatticeParticles, AtThePlacesOfNodesGiveTheCaseOfTheNodes, (std::uint32_t seed))
{
    const char* const gravities[] = {R"(x="0" y="0" z="-9.81")", R"(x="0" y="0" z="9.81")",
                                     R"(x="0" y="0" z="0")",     R"(x="3" y="0" z="-9")",
                                     R"(x="-1" y="2" z="-9")",   R"(x="0" y="9.81" z="0")"};
    Dice dice(seed);
    CaseText text = oriented(dice.one_of(orders));
    text.gravity = std::string("<gravity ") + dice.one_of(gravities) + " />";
    text.rhopgradient = "<rhopgradient value=\"" + std::to_string(dice.whole(1, 3)) + "\" />";
    const CaseDef def = read(text);
    const test::DenseMks nodes = any_nodes(def.grid, dice);
    const Made plain = make(def, test::runs_of(nodes));
    const Made made = make(def, with_nodes_taken_off_lattice(nodes, dice));
    RC_ASSERT(!plain.particles.has_walls);
    RC_ASSERT(made.particles.has_walls);
    RC_ASSERT(made.particles.off_lattice.size() > 0U);

    const std::vector<Shown> expected = all_of(plain.particles);
    const std::vector<Shown> found = all_of(made.particles);
    RC_ASSERT(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
    {
        RC_ASSERT(found[i].mk == expected[i].mk);
        RC_ASSERT(found[i].type == expected[i].type);
        RC_ASSERT(found[i].position == expected[i].position);
        RC_ASSERT(std::abs(found[i].rhop - expected[i].rhop) < 1e-3F);
    }
    RC_ASSERT(std::abs(made.constants.hswl - plain.constants.hswl) < 1e-12);
    RC_ASSERT(made.particles.n_fixed == plain.particles.n_fixed);
    RC_ASSERT(made.particles.n_moving == plain.particles.n_moving);
    RC_ASSERT(made.particles.n_floating == plain.particles.n_floating);
    RC_ASSERT(made.particles.n_fluid == plain.particles.n_fluid);
    RC_ASSERT(made.particles.pos_min == plain.particles.pos_min);
    RC_ASSERT(made.particles.pos_max == plain.particles.pos_max);
    RC_ASSERT(made.particles.floatings.size() == plain.particles.floatings.size());
    for (std::size_t b = 0; b < plain.particles.floatings.size(); ++b)
    {
        const FloatingBody& f = made.particles.floatings[b];
        const FloatingBody& p = plain.particles.floatings[b];
        RC_ASSERT(f.mass_body == p.mass_body);
        RC_ASSERT(norm(f.center - p.center) < 1e-12);
        for (std::size_t r = 0; r < 3; ++r)
            RC_ASSERT(norm(f.inertia[r] - p.inertia[r]) < 1e-12 * (1 + norm(p.inertia[r])));
    }
}

// Order of GenCase v5.4.354: 1024 cells of the box that holds all particles of the mk.
TEST(OffLatticeParticles, OfSetfrdrawmodeAreSortedByCells)
{
    const CaseDef def = read(small_case());
    RunField field;
    field.grid = def.grid;
    field.slabs.resize(def.grid.n[0]);
    FittedWalls& walls = field.walls;
    walls.off_lattice_mks = {10};
    add_to_volume(walls, {0, 0.3, 0.5}, 10);
    add_to_volume(walls, {0.5124, 0.4, 0.1}, 10);
    add_to_volume(walls, {0.5129, 0.2, 0.1}, 10); // beyond by half a cell: still before the last
    add_to_volume(walls, {1.024, 0.3, 0.5}, 10);
    add_to_volume(walls, {0.7, 0.30003, 0.5}, 10);
    add_to_volume(walls, {0.70001, 0.3, 0.50001}, 10); // of one cell with the last one
    const CaseParticles made = make(def, field).particles;
    std::vector<double> x;
    for (const Vec3& p : made.off_lattice.positions) x.push_back(p.x);
    EXPECT_EQ(x, (std::vector<double>{0, 0.5129, 0.5124, 0.7, 0.70001, 1.024}));
    EXPECT_EQ(made.off_lattice_points.positions, made.off_lattice.positions);
}

TEST(OffLatticeParticles, MakeABlockOfAnMkWithoutNodes)
{
    const CaseDef def = read(small_case());
    test::DenseMks nodes(def.grid);
    for (std::int64_t z = 0; z < 5; ++z) nodes.at(3, 3, z) = 1;
    for (std::int64_t z = 0; z < 4; ++z) nodes.at(4, 3, z) = 11 | test::covered;
    RunField field = walled(nodes);
    for (int i = 0; i < 7; ++i) add_to_wall(field.walls, {0.01 * i, 0.1, 0.2}, 11);
    for (int i = 0; i < 3; ++i) add_to_wall(field.walls, {0.1, 0.1, 0.3 + 0.05 * i}, 12);
    const CaseParticles particles = make(def, field).particles;
    ASSERT_EQ(particles.blocks.size(), 3U);
    EXPECT_EQ(particles.n_moving, 7U);
    EXPECT_EQ(particles.blocks[0].ref_motion, 0);
    EXPECT_EQ(particles.n_floating, 3U);
    EXPECT_EQ(particles.n_fluid, 5U);
    EXPECT_EQ(particles.np, 15U);
    ASSERT_EQ(particles.floatings.size(), 1U);
    const FloatingBody& body = particles.floatings[0];
    EXPECT_NEAR(body.mass_body, 500 * 3 * 0.001, 1e-12);
    EXPECT_LT(norm(body.center - Vec3{0.1, 0.1, 0.35}), 1e-12);
    EXPECT_NEAR(body.inertia[0].x, body.mass_body / 3 * 2 * 0.05 * 0.05, 1e-12);
    EXPECT_NEAR(body.inertia[2].z, 0, 1e-15);
}

TEST(OffLatticeParticles, OfWallsMoveOutOfTheField)
{
    const CaseDef def = read(small_case());
    test::DenseMks nodes(def.grid);
    RunField field = walled(nodes);
    std::vector<Vec3> places;
    for (int i = 0; i < 50; ++i) places.push_back({0.01 * (i * 7 % 50), 0.002 * i, 0.2});
    for (const Vec3& p : places) add_to_wall(field.walls, p, 10);
    CaseConstants constants;
    std::vector<std::string> warnings;
    const CaseParticles particles = make_particles(def, field, 2, constants, warnings);
    EXPECT_EQ(field.walls.particles.size(), 0U);
    std::sort(places.begin(), places.end(),
              [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
    EXPECT_EQ(particles.off_lattice.positions, places);
    EXPECT_EQ(particles.off_lattice.rhop.size(), places.size());
}

TEST(OffLatticeParticles, OfAFloatingBodyCountForItsMassCentreAndInertia)
{
    Dice dice(9);
    const CaseDef def = read(small_case());
    RunField field = walled(any_nodes(def.grid, dice));
    for (int i = 0; i < 200; ++i)
        add_to_wall(field.walls, {dice.real(-0.4, 0.6), dice.real(-0.2, 0.5), dice.real(0, 1.2)},
                    12);
    const CaseParticles particles = make(def, field).particles;
    std::vector<Vec3> places;
    for (const Shown& p : all_of(particles))
        if (p.mk == 12) places.push_back(p.position);
    const auto n = static_cast<double>(places.size());
    Vec3 mean;
    for (const Vec3& p : places) mean = mean + p / n;
    const FloatingBody& body = particles.floatings.at(0);
    EXPECT_NEAR(body.mass_body, 500 * n * 0.001, 1e-9);
    EXPECT_LT(norm(body.center - mean), 1e-12);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
        {
            double sum = 0;
            for (const Vec3& p : places)
                sum += body.mass_body / n *
                       ((r == c ? dot(p - mean, p - mean) : 0) - (p - mean)[r] * (p - mean)[c]);
            EXPECT_NEAR(body.inertia[static_cast<std::size_t>(r)][c], sum, 1e-9) << r << c;
        }
}

/// Water of 8 nodes on a floor of the zone; one particle off the lattice of mk 1.
float density_at(const Vec3& steps, const CaseDef& def, CaseConstants& constants)
{
    test::DenseMks nodes(def.grid);
    for (std::int64_t x = 0; x < 5; ++x)
        for (std::int64_t y = 0; y < 5; ++y)
            for (std::int64_t z = 0; z < 10; ++z)
                nodes.at(x, y, z) = z < 2 ? 10 | test::covered : 1;
    RunField field = walled(nodes);
    add_to_volume(field.walls, def.grid.origin + def.grid.dp * steps, 1, 0.5F);
    const Made made = make(def, field);
    constants = made.constants;
    EXPECT_EQ(made.particles.off_lattice.distances.at(0), 0.5F);
    EXPECT_EQ(made.particles.off_lattice.kinds.at(0), FitKind::Volume);
    return made.particles.off_lattice.rhop.at(0);
}

TEST(OffLatticeParticles, HaveTheDensityOfTheirTrueDepthInTheirColumn)
{
    const CaseDef def = read(small_case());
    struct Place
    {
        Vec3 steps;
        double depth; // steps
    };
    for (const Place& place :
         {Place{{2.2, 2.4, 4.3}, 4.7}, Place{{2, 2, 9.4}, 0}, Place{{2.3, 1.8, 1.2}, 7.8},
          Place{{5.4, 3.1, 6.6}, 2.4}, Place{{7.9, 2, 5}, 4}, Place{{9.1, 2, 5}, 0}})
    {
        CaseConstants c;
        const float found = density_at(place.steps, def, c);
        const double rhop =
            c.rhop0 * std::pow(1 + c.rhop0 * 9.81 * place.depth * 0.1 / c.b, 1 / c.gamma);
        EXPECT_NEAR(found, rhop, 1e-3) << place.steps.x << " " << place.steps.z;
    }
}

TEST(OffLatticeParticles, CountForTheDepthOfWaterAsTheirNodes)
{
    const CaseDef def = read(small_case());
    CaseConstants c;
    density_at({2, 2, 1.25}, def, c);
    EXPECT_NEAR(c.hswl, 0.7, 1e-12);
    density_at({2, 2, 5}, def, c);
    EXPECT_NEAR(c.hswl, 0.7, 1e-12);
}

TEST(OffLatticeParticles, WidenTheLimits)
{
    const CaseDef def = read(small_case());
    test::DenseMks nodes(def.grid);
    nodes.at(3, 3, 3) = 10;
    RunField field = walled(nodes);
    add_to_wall(field.walls, {-0.33, 0.2, 0.9}, 10);
    add_to_wall(field.walls, {0.31, -0.1, 0.7}, 13);
    const CaseParticles particles = make(def, field).particles;
    const Vec3 node = place_of(def.grid, 3, 3, 3);
    EXPECT_TRUE(particles.pos_min == (Vec3{-0.33, -0.1, node.z}));
    EXPECT_TRUE(particles.pos_max == (Vec3{0.31, 0.2, 0.9}));
}

TEST(OffLatticeParticles, HaveTheNormalsOfFacetsEdgesAndCorners)
{
    const CaseDef def = read(small_case());
    RunField field = walled(test::DenseMks(def.grid));
    const SurfaceMesh& mesh = field.walls.bodies[0].mesh;
    const std::uint32_t top = facet_towards(mesh, {0, 0, 1});
    const std::uint32_t right = facet_towards(mesh, {1, 0, 0});
    const auto& corners = mesh.facets[right];
    std::uint32_t corner = corners[0]; // (1, 1, 1) or else the corner nearest to it
    for (const std::uint32_t v : corners)
        if (norm(mesh.vertices[v]) > norm(mesh.vertices[corner])) corner = v;
    add_to_wall(field.walls, {0.1, 0.2, 1 + 1e-9}, 10, FitKind::Surface, top);
    add_to_wall(field.walls, mesh.vertices[corner], 10, FitKind::Corner, right);
    for (std::size_t side = 0; side < 3; ++side)
    {
        const Vec3 middle =
            0.5 * (mesh.vertices[corners[side]] + mesh.vertices[corners[(side + 1) % 3]]);
        add_to_wall(field.walls, middle, 11, FitKind::Edge, right);
    }
    const CaseParticles particles = make(def, field).particles;
    const OffLatticeParticles& off_lattice = particles.off_lattice;
    ASSERT_EQ(off_lattice.size(), 5U);
    EXPECT_EQ(off_lattice.kinds[0], FitKind::Surface);
    EXPECT_EQ(off_lattice.normals[0], (std::array<float, 3>{0, 0, 1}));
    EXPECT_NEAR(off_lattice.distances[0], 1e-9, 1e-15);
    EXPECT_EQ(off_lattice.kinds[1], FitKind::Corner);
    const Vec3 centre{0.5, 0.5, 0.5};
    for (std::size_t i = 1; i < 5; ++i)
    {
        const Vec3 n{off_lattice.normals[i][0], off_lattice.normals[i][1],
                     off_lattice.normals[i][2]};
        // Corners, the middles of edges and of faces all look straight away from the centre.
        const Vec3 outwards = off_lattice.positions[i] - centre;
        EXPECT_LT(norm(n - outwards / norm(outwards)), 1e-6) << i;
        EXPECT_EQ(off_lattice.distances[i], 0) << i;
    }
}

TEST(OffLatticeParticles, OnRoundBodiesHaveTheNormalOfTheTrueShape)
{
    const CaseDef def = read(small_case());
    RunField field = walled(test::DenseMks(def.grid));
    FittedBody& body = field.walls.bodies[0];
    body.round =
        test::cylinder_mesh({0.5, 0.5, 0}, {0.5, 0.5, 1}, 0.5, {true, true, true}, 0.1).round;
    const std::uint32_t side = facet_towards(body.mesh, {1, 0, 0});
    const std::uint32_t cover = facet_towards(body.mesh, {0, 0, 1});
    add_to_wall(field.walls, {0.5 + 0.3, 0.5 + 0.4, 0.3}, 10, FitKind::Surface, side);
    add_to_wall(field.walls, {0.9, 0.5, 1}, 10, FitKind::Surface, cover);
    const OffLatticeParticles off_lattice = make(def, field).particles.off_lattice;
    EXPECT_NEAR(off_lattice.normals[0][0], 0.6, 1e-6);
    EXPECT_NEAR(off_lattice.normals[0][1], 0.8, 1e-6);
    EXPECT_NEAR(off_lattice.distances[0], 0, 1e-15);
    EXPECT_EQ(off_lattice.normals[1], (std::array<float, 3>{0, 0, 1}));
}

TEST(OffLatticeParticles, AreTheSameWithOneAndEightThreads)
{
    for (const char* gravity :
         {R"(<gravity x="0" y="0" z="-9.81" />)", R"(<gravity x="1" y="1" z="-9" />)"})
    {
        Dice dice(11);
        CaseText text = small_case();
        text.gravity = gravity;
        const CaseDef def = read(text);
        RunField field = walled(any_nodes(def.grid, dice));
        for (int i = 0; i < 100000; ++i)
        {
            const Vec3 p{dice.real(-0.4, 0.6), dice.real(-0.2, 0.5), dice.real(0, 1.2)};
            const std::uint16_t mk = dice.one_of({std::uint16_t{1}, std::uint16_t{12}});
            if (dice.coin())
                add_to_wall(field.walls, p, mk, FitKind::Edge);
            else
                add_to_volume(field.walls, p, mk);
        }
        const Made one = make(def, field, 1);
        const Made many = make(def, field, 8);
        EXPECT_TRUE(one.particles.off_lattice.positions == many.particles.off_lattice.positions);
        EXPECT_TRUE(one.particles.off_lattice.normals == many.particles.off_lattice.normals);
        EXPECT_TRUE(one.particles.off_lattice.rhop == many.particles.off_lattice.rhop);
        EXPECT_TRUE(one.particles.rhop == many.particles.rhop);
        EXPECT_EQ(one.constants.hswl, many.constants.hswl);
        EXPECT_TRUE(one.particles.floatings.at(0).center == many.particles.floatings.at(0).center);
        EXPECT_EQ(all_of(one.particles).size(), all_of(many.particles).size());
    }
}

} // namespace
} // namespace fppg
