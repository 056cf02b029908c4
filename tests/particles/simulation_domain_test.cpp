#include "particles/simulation_domain.h"

#include "fppg/case_def.h"

#include <gmock/gmock.h>

namespace fppg
{
namespace
{

using testing::ElementsAre;
using testing::HasSubstr;

Element limit(const std::string& name, const std::string& x, const std::string& z)
{
    Element out;
    out.name = name;
    out.set_attribute("x", x);
    out.set_attribute("y", "0");
    out.set_attribute("z", z);
    return out;
}

/// h = 1, dp = 0.5, particles from (-1, 0, -1) to (9, 0, 9), in 2D.
struct Domain
{
    CaseDef def;
    CaseParticles particles;

    Domain()
    {
        def.file = "Case_Def.xml";
        def.fit.all = FitSettings{};
        def.h = 1;
        def.grid.dp = 0.5;
        def.grid.is_2d = true;
        particles.pos_min = {-1, 0, -1};
        particles.pos_max = {9, 0, 9};
        particles.off_lattice.positions.resize(1);
        Element parameters;
        parameters.name = "parameters";
        Element domain;
        domain.name = "simulationdomain";
        domain.children = {limit("posmin", "-1.01", "default"), limit("posmax", "9.06", "8.5")};
        parameters.children = {domain};
        def.execution = {parameters};
    }

    std::string value(std::size_t which, const char* axis) const
    {
        return *def.execution[0].children[0].children[which].find_attribute(axis);
    }
};

/// The solver's border is 0.05 h: x = -1.01 is too near, 9.06 is not.
TEST(SimulationDomain, IsWidenedWhereTheSolverWouldRefuseTheWalls)
{
    Domain domain;
    EXPECT_THAT(widen_simulation_domain(domain.particles, domain.def),
                ElementsAre(HasSubstr("<posmin>: x = -1.01"), HasSubstr("<posmax>: z = 8.5")));
    EXPECT_EQ(domain.value(0, "x"), "-1.5");
    EXPECT_EQ(domain.value(0, "z"), "default");
    EXPECT_EQ(domain.value(0, "y"), "0");
    EXPECT_EQ(domain.value(1, "x"), "9.06");
    EXPECT_EQ(domain.value(1, "z"), "9.5");
}

TEST(SimulationDomain, StaysWithoutFittedWalls)
{
    Domain domain;
    domain.def.fit = {};
    EXPECT_THAT(widen_simulation_domain(domain.particles, domain.def), testing::IsEmpty());
    EXPECT_EQ(domain.value(1, "z"), "8.5");
}

} // namespace
} // namespace fppg
