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

TEST(WriteParticlesVtk, GivesTheSameBytesForAnyNumberOfThreads)
{
    const CaseParticles particles =
        make_particles({columns(ParticleType::Fixed, 10, 0, 100, 777),
                        columns(ParticleType::Fluid, 1, 100, 90, 1001)});
    for (const VtkSelection selection :
         {VtkSelection::All, VtkSelection::Bound, VtkSelection::Fluid})
    {
        const std::string one = vtk_of(particles, selection, 1);
        EXPECT_TRUE(one == vtk_of(particles, selection, 8));
        const VtkFile file(one);
        EXPECT_EQ(file.arrays.at("Mk").back(), selection == VtkSelection::Bound ? 10 : 1);
    }
}

} // namespace

} // namespace fppg
