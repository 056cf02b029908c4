// Particles off the lattice in cases that the solver repeats.
#include "fppg/periodic.h"
#include "fppg/case_def.h"
#include "fppg/error.h"

#include "casedef/execution.h"
#include "helpers/case_text.h"

#include <gmock/gmock.h>

namespace fppg
{
namespace
{

using testing::HasSubstr;
using testing::IsEmpty;

/// 11 nodes a metre apart along each axis, periodic along x, where the next copy is 3 m higher.
CaseDef tilted_case()
{
    CaseDef def;
    def.file = "Case_Def.xml";
    def.grid.dp = 1;
    def.grid.n = {11, 11, 11};
    def.grid.is_periodic = {true, false, false};
    def.period_shift[0] = {0, 0, 3};
    return def;
}

RunField field_of(const CaseDef& def, const std::vector<Vec3>& walls,
                  const std::vector<Vec3>& volume)
{
    RunField field;
    field.grid = def.grid;
    for (const Vec3& p : walls)
    {
        WallParticles one;
        one.positions = {p};
        one.kinds = {FitKind::Surface};
        one.bodies = {0};
        one.facets = {0};
        one.mk = {11};
        one.held = {0};
        field.walls.particles.append(one);
    }
    field.walls.volume.positions = volume;
    field.walls.volume.mk.assign(volume.size(), 1);
    field.walls.volume.distances.assign(volume.size(), 1.0F);
    return field;
}

TEST(CloseSeams, TakesTheParticleAtTheEndThatIsTooNearToTheNextCopy)
{
    const CaseDef def = tilted_case();
    RunField field =
        field_of(def, {{-0.3, 5, 2}, {10.4, 5, 5.1}, {10.4, 5, 2}, {5, 5, 5}, {10.6, 2, 2}},
                 {{-0.2, 4, 2}, {10.45, 4, 5}, {10.4, 5, 5}, {-0.8, 8, 2}});
    const SeamsClosed done = close_seams(def, field);
    EXPECT_EQ(done.left_out, 2U);
    EXPECT_EQ(done.moved, 1U);
    const std::vector<Vec3> walls{{-0.3, 5, 2}, {10.4, 5, 2}, {5, 5, 5}};
    EXPECT_EQ(field.walls.particles.positions, walls);
    const std::vector<Vec3> volume{{-0.2, 4, 2}, {10.4, 5, 5}, {10.2, 8, 5}};
    EXPECT_EQ(field.walls.volume.positions, volume);
    EXPECT_EQ(field.walls.volume.mk.size(), 3U);
    EXPECT_EQ(field.walls.volume.distances.size(), 3U);
}

/// The solver stopped: "Found new particles out".
TEST(CloseSeams, KeepsParticlesOffTheVeryEnds)
{
    const CaseDef def = tilted_case();
    RunField field = field_of(def, {{-0.5, 5, 2}, {10.5 - 1e-5, 8, 5}}, {});
    close_seams(def, field);
    ASSERT_EQ(field.walls.particles.size(), 2U);
    for (const Vec3& p : field.walls.particles.positions)
    {
        EXPECT_GT(p.x, -0.5 + 5e-5);
        EXPECT_LT(p.x, 10.5 - 5e-5);
    }
}

TEST(CloseSeams, LeavesACaseThatIsNotPeriodic)
{
    CaseDef def = tilted_case();
    def.grid.is_periodic = {};
    RunField field = field_of(def, {{-0.3, 5, 2}, {10.6, 5, 5}}, {});
    EXPECT_EQ(close_seams(def, field).left_out, 0U);
    EXPECT_EQ(field.walls.particles.size(), 2U);
}

CaseParticles particles_between(const CaseDef& def, double low, double high)
{
    CaseParticles particles;
    particles.grid = def.grid;
    particles.off_lattice.positions = {{low, 0, 0}, {high, 0, 0}};
    particles.pos_min = {low, 2, 2};
    particles.pos_max = {high, 3, 3};
    return particles;
}

TEST(SetPeriod, MakesTheSolversPeriodThatOfTheLattice)
{
    const CaseDef def = tilted_case();
    std::vector<std::string> warnings;
    CaseParticles particles = particles_between(def, -0.48, 10.3);
    set_period(def, particles, warnings);
    EXPECT_THAT(warnings, IsEmpty());
    EXPECT_EQ(particles.pos_min, (Vec3{0, 2, 2}));
    EXPECT_EQ(particles.pos_max, (Vec3{10, 3, 3}));
}

TEST(SetPeriod, WarnsWhereParticlesDoNotFillThePeriod)
{
    const CaseDef def = tilted_case();
    std::vector<std::string> warnings;
    CaseParticles particles = particles_between(def, 1.2, 10.3);
    set_period(def, particles, warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_THAT(warnings[0], HasSubstr("periodic along x, but its particles, 1.2 to 10.3 m"));
    EXPECT_EQ(particles.pos_min.x, 1.2);
}

TEST(SetPeriod, LeavesTheLimitsOfNodes)
{
    const CaseDef def = tilted_case();
    std::vector<std::string> warnings;
    CaseParticles particles = particles_between(def, 0, 9);
    particles.off_lattice = {};
    set_period(def, particles, warnings);
    EXPECT_THAT(warnings, IsEmpty());
    EXPECT_EQ(particles.pos_max.x, 9);
}

CaseDef read_with(const std::string& parameters)
{
    test::CaseText text = test::tank();
    text.execution = "<parameters>" + parameters + "</parameters>";
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    return read_case(folder / "Case_Def.xml", {});
}

TEST(PeriodicAxes, AreThoseThatTheSolverReads)
{
    const CaseDef tilted = read_with(R"(<parameter key="XPeriodicIncZ" value="#-3*0.5" />)");
    EXPECT_EQ(tilted.grid.is_periodic, (std::array<bool, 3>{true, false, false}));
    EXPECT_EQ(tilted.period_shift[0], (Vec3{0, 0, 1.5}));
    const CaseDef both = read_with(R"(<parameter key="XYPeriodic" value="1" />)");
    EXPECT_EQ(both.grid.is_periodic, (std::array<bool, 3>{true, true, false}));
    const CaseDef none = read_with(
        R"(<_parameter key="XYPeriodic" value="1" /><parameter key="#XPeriodicIncZ" value="1" />)");
    EXPECT_EQ(none.grid.is_periodic, (std::array<bool, 3>{}));
    EXPECT_THROW(read_with(R"(<parameter key="XPeriodicIncZ" value="much" />)"), CaseError);
}

} // namespace
} // namespace fppg
