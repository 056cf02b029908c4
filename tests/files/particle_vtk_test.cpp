#include "files/helpers.h"
#include "files/vtk_reader.h"

namespace fppg
{

namespace
{

std::string vtk_of(const CaseParticles& particles, VtkSelection selection, int threads = 1)
{
    return written(
        [&](OutputFile& file)
        { write_particles_vtk(file, particles, small_constants(), selection, threads); });
}

TEST(WriteParticlesVtk, HasAllParticlesWithTheirMarks)
{
    const VtkFile all(vtk_of(small_particles(), VtkSelection::All));
    EXPECT_EQ(all.points.size(), 69U);
    EXPECT_EQ(all.arrays.at("Idp").back(), 22);
    EXPECT_EQ(all.arrays.at("Vel").size(), 69U);
    EXPECT_EQ(all.arrays.at("Rhop")[9], 1001);
    const std::vector<double> mk{10, 10, 10, 11, 11, 15, 15, 15, 15, 1, 1, 1,
                                 1,  1,  1,  1,  1,  2,  2,  2,  2,  2, 2};
    EXPECT_EQ(all.arrays.at("Mk"), mk);
    EXPECT_EQ(all.types.at("Mk"), "unsigned_char");
    EXPECT_EQ(all.arrays.at("Type")[3], 1);
    EXPECT_EQ(all.arrays.at("Type")[5], 2);
    EXPECT_EQ(all.arrays.at("Type")[22], 3);
}

TEST(WriteParticlesVtk, RoundsPositionsOnce)
{
    const VtkFile all(vtk_of(small_particles(), VtkSelection::All));
    EXPECT_EQ(all.points[0], static_cast<float>(-0.1));
    EXPECT_EQ(all.points[1], static_cast<float>(0.25));
    EXPECT_EQ(all.points[5], static_cast<float>(0.3 + 2 * 0.1));
}

TEST(WriteParticlesVtk, LeavesVelocityAndDensityOutOfTheBoundary)
{
    const VtkFile bound(vtk_of(small_particles(), VtkSelection::Bound));
    EXPECT_EQ(bound.points.size(), 27U);
    EXPECT_EQ(bound.arrays.count("Vel"), 0U);
    EXPECT_EQ(bound.arrays.count("Rhop"), 0U);
    EXPECT_EQ(bound.arrays.at("Type").back(), 2);
}

TEST(WriteParticlesVtk, ShowsTheNormalsOfTheBoundaryAndTheirSizes)
{
    CaseParticles particles = small_particles();
    for (int i = 0; i < 9; ++i) particles.bound_normals.push_back({3, 0, static_cast<float>(i)});
    const VtkFile bound(vtk_of(particles, VtkSelection::Bound));
    EXPECT_EQ(bound.arrays.at("Normal")[3 * 4 + 2], 4);
    EXPECT_EQ(bound.arrays.at("NormalSize")[4], 5);
    EXPECT_EQ(bound.types.at("Mk"), "unsigned_short");
    EXPECT_EQ(bound.arrays.at("Mk").back(), 15);
    EXPECT_EQ(bound.arrays.at("Type").back(), 2);
    EXPECT_EQ(VtkFile(vtk_of(particles, VtkSelection::All)).arrays.count("Normal"), 0U);
}

TEST(WriteParticlesVtk, ShowsParticlesAfterTheInitialsOfTheirBlock)
{
    CaseParticles particles = small_particles();
    Transform aside;
    aside.offset = {0.5, 0, 0};
    particles.blocks[3].initials = {{1, 1, {}, UniformVelocity{{0, 0, 7}}},
                                    {2, 1, {}, MoveParticles{aside}}};
    const VtkFile fluid(vtk_of(particles, VtkSelection::Fluid));
    EXPECT_FLOAT_EQ(fluid.points[0], static_cast<float>(-0.1 + 0.8 + 0.5));
    EXPECT_EQ(fluid.arrays.at("Vel")[2], 7);
    EXPECT_EQ(fluid.arrays.at("Vel").back(), 0);
    EXPECT_EQ(fluid.arrays.at("Rhop")[0], 1001);
    EXPECT_EQ(fluid.arrays.at("Rhop").back(), 1006);
}

TEST(WriteParticlesVtk, KeepsTheIdsOfTheFluid)
{
    const VtkFile fluid(vtk_of(small_particles(), VtkSelection::Fluid));
    EXPECT_EQ(fluid.arrays.at("Idp").front(), 9);
    EXPECT_EQ(fluid.arrays.at("Idp").size(), 14U);
    EXPECT_EQ(fluid.cells.at("VERTICES").back(), 13);
    EXPECT_EQ(fluid.arrays.at("Rhop").back(), 1006);
}

TEST(WriteParticlesVtk, TakesMkAbove255WhereItIsSelected)
{
    CaseParticles particles = small_particles();
    particles.blocks[0].mk = 300;
    const VtkFile bound(vtk_of(particles, VtkSelection::Bound));
    EXPECT_EQ(bound.types.at("Mk"), "unsigned_short");
    EXPECT_EQ(bound.arrays.at("Mk")[0], 300);
    EXPECT_EQ(bound.arrays.at("Mk")[3], 11);
    const VtkFile fluid(vtk_of(particles, VtkSelection::Fluid));
    EXPECT_EQ(fluid.types.at("Mk"), "unsigned_char");
}

TEST(WriteParticlesVtk, WritesAnEmptySelection)
{
    const VtkFile empty(vtk_of(CaseParticles{}, VtkSelection::All));
    EXPECT_TRUE(empty.points.empty());
}

TEST(WriteParticlesVtk, HasKindNormalDistanceAndLayerWhereThereAreWalls)
{
    const CaseParticles particles = walled_particles();
    const VtkFile all(vtk_of(particles, VtkSelection::All));
    const VtkFile bound(vtk_of(particles, VtkSelection::Bound));
    const std::vector<double> kinds{3, 3, 3, 3, 0, 1, 3, 3, 3, 3, 3};
    EXPECT_EQ(bound.arrays.at("Kind"), kinds);
    EXPECT_EQ(bound.types.at("Kind"), "int");
    ASSERT_EQ(all.arrays.at("Kind").size(), 28U);
    EXPECT_EQ(all.arrays.at("Kind")[25], 2);
    ASSERT_EQ(all.arrays.at("Normal").size(), 84U);
    EXPECT_EQ(all.arrays.at("Normal")[16], 1);
    EXPECT_EQ(all.arrays.at("Normal")[77], 0.8F);
    EXPECT_EQ(all.arrays.at("Normal")[0], 0);
    EXPECT_EQ(all.arrays.at("Distance")[0], distance_of_nodes);
    EXPECT_EQ(all.arrays.at("Distance")[5], 1e-17F);
    EXPECT_EQ(all.arrays.at("Distance").back(), 0.2F);
    EXPECT_EQ(bound.arrays.at("Distance")[5], 1e-17F);
    EXPECT_EQ(bound.types.at("Layer"), "int");
    EXPECT_EQ(bound.arrays.at("Layer"), (std::vector<double>{0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 0}));
    EXPECT_EQ(all.arrays.at("Layer")[25], 3);
    EXPECT_EQ(all.points[3 * 5 + 2], static_cast<float>(1.0 / 3));
    EXPECT_EQ(all.arrays.at("Rhop")[4], 999);
    EXPECT_EQ(all.arrays.at("Rhop").back(), 1012);
    EXPECT_EQ(all.arrays.at("Mk").back(), 2);
    const VtkFile fluid(vtk_of(particles, VtkSelection::Fluid));
    EXPECT_EQ(fluid.arrays.count("Kind"), 0U);
    EXPECT_EQ(fluid.points.back(), 0.5F);
}

TEST(WriteParticlesVtk, NamesTheNormalsOfWallsApartFromThoseOfTheBoundary)
{
    CaseParticles particles = walled_particles();
    for (int i = 0; i < 11; ++i) particles.bound_normals.push_back({3, 0, static_cast<float>(i)});
    const VtkFile bound(vtk_of(particles, VtkSelection::Bound));
    ASSERT_EQ(bound.arrays.at("Normal").size(), 33U);
    EXPECT_EQ(bound.arrays.at("Normal")[3 * 4 + 2], 4);
    EXPECT_EQ(bound.arrays.at("NormalSize")[4], 5);
    ASSERT_EQ(bound.arrays.at("WallNormal").size(), 33U);
    EXPECT_EQ(bound.arrays.at("WallNormal")[3 * 5 + 1], 1);
    EXPECT_EQ(bound.arrays.at("Kind")[5], 1);
    EXPECT_EQ(bound.arrays.at("Distance")[5], 1e-17F);
    EXPECT_EQ(VtkFile(vtk_of(particles, VtkSelection::All)).arrays.at("Normal")[3 * 5 + 1], 1);
}

TEST(WriteParticlesVtk, MovesParticlesOffTheLatticeAndTurnsTheirNormals)
{
    CaseParticles particles = walled_particles();
    Transform turn; // a quarter about z, then upwards
    turn.linear = {Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}};
    turn.offset = {0, 0, 1};
    particles.blocks[1].initials = {{1, 11, {}, MoveParticles{turn}}};
    for (const VtkSelection selection : {VtkSelection::All, VtkSelection::Bound})
    {
        const VtkFile file(vtk_of(particles, selection));
        EXPECT_EQ(file.points[3 * 4], -0.25F);
        EXPECT_EQ(file.points[3 * 4 + 1], 0.2F);
        EXPECT_EQ(file.points[3 * 4 + 2], 1.41F);
        EXPECT_EQ(file.arrays.at("Normal")[3 * 4], 0);
        EXPECT_EQ(file.arrays.at("Normal")[3 * 4 + 1], 1);
        EXPECT_EQ(file.arrays.at("Normal")[3 * 5], -1);
    }
}

TEST(WriteParticlesVtk, HasNoArraysOfWallsInACaseWithoutThem)
{
    const VtkFile all(vtk_of(small_particles(), VtkSelection::All));
    for (const char* name : {"Kind", "Normal", "Distance", "Layer"})
        EXPECT_EQ(all.arrays.count(name), 0U);
}

TEST(WriteParticlesVtk, GivesTheSameBytesForAnyNumberOfThreads)
{
    CaseParticles particles = make_particles({columns(ParticleType::Fixed, 10, 0, 100, 777),
                                              columns(ParticleType::Fluid, 1, 100, 90, 1001)});
    // Runs off the lattice of several pieces, that begin and end within pieces.
    std::vector<ParticleBlock> blocks = particles.blocks;
    for (std::uint32_t block = 0; block < 2; ++block)
    {
        blocks[block].runs.insert(blocks[block].runs.begin() + 40,
                                  ParticleRun::of_off_lattice(block * 50000, 50000));
        blocks[block].count += 50000;
    }
    particles = make_particles(std::move(blocks));
    particles.has_walls = true;
    for (int i = 0; i < 100000; ++i)
    {
        particles.off_lattice.positions.push_back({0.001 * i, 0.1, 0.2});
        particles.off_lattice.kinds.push_back(static_cast<FitKind>(i % 4));
        particles.off_lattice.normals.push_back({0, static_cast<float>(i), 0});
        particles.off_lattice.distances.push_back(static_cast<float>(-i));
        particles.off_lattice.layers.push_back(static_cast<std::uint8_t>(i % 4));
        particles.off_lattice.rhop.push_back(static_cast<float>(1000 + i));
    }
    for (const VtkSelection selection :
         {VtkSelection::All, VtkSelection::Bound, VtkSelection::Fluid})
    {
        const std::string one = vtk_of(particles, selection, 1);
        EXPECT_TRUE(one == vtk_of(particles, selection, 2));
        EXPECT_TRUE(one == vtk_of(particles, selection, 8));
        const VtkFile file(one);
        EXPECT_EQ(file.arrays.at("Mk").back(), selection == VtkSelection::Bound ? 10 : 1);
    }
}

} // namespace

} // namespace fppg
