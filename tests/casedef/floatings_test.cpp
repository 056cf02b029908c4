// <floatings> as GenCase v5.4.354 reads it; every value and refusal here is its own.

#include "fppg/case_def.h"
#include "fppg/error.h"

#include "helpers/case_text.h"

#include <gtest/gtest.h>

#include <string>

namespace fppg
{
namespace
{

CaseDef read(const std::string& attributes, const std::string& children,
             const std::string& rhop0 = "1000")
{
    test::CaseText text;
    text.constants.replace(text.constants.find("1000"), 4, rhop0);
    text.after_geometry = "<floatings><floating mkbound=\"3-4,7\" " + attributes + ">" + children +
                          "</floating></floatings>";
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    return read_case(folder / "Case_Def.xml", {});
}

FloatingDef body_of(const std::string& attributes, const std::string& children = "")
{
    return read(attributes, children).floatings.at(0);
}

TEST(Floatings, HaveTheirMassInOneOfThreeForms)
{
    EXPECT_EQ(body_of(R"(rhopbody="700")").mkbound, (std::vector<std::uint16_t>{3, 4, 7}));
    EXPECT_EQ(body_of(R"(rhopbody="#350*2")").rhop_body, 700);
    EXPECT_EQ(body_of(R"(relativeweight="0.5")").rhop_body, 500);
    EXPECT_EQ(body_of("", R"(<massbody value="6" />)").mass_body, 6);
    // A zero says nothing.
    EXPECT_EQ(body_of(R"(rhopbody="0" relativeweight="0")", R"(<massbody value="6" />)").mass_body,
              6);
    const FloatingDef dense = body_of(R"(rhopbody="700")", R"(<massbody value="0" />)");
    EXPECT_EQ(dense.rhop_body, 700);
    EXPECT_FALSE(dense.mass_body);
}

TEST(Floatings, TakeRhopbodyAsAWeightOfTheFluidAndSaySo)
{
    const CaseDef heavy = read(R"(rhopbody="700")", "", "1025");
    EXPECT_NEAR(heavy.floatings.at(0).rhop_body.value_or(0), 717.5, 1e-9);
    ASSERT_EQ(heavy.warnings.size(), 1U);
    EXPECT_NE(heavy.warnings[0].find("rhopbody=\"700\" gives 717.5 kg/m^3"), std::string::npos)
        << heavy.warnings[0];
    EXPECT_TRUE(read(R"(relativeweight="0.7")", "", "1025").warnings.empty());
    EXPECT_TRUE(read(R"(rhopbody="700")", "").warnings.empty());
}

TEST(Floatings, ShareTheMassOfTheBodyWhereTheParticlesMassIsZero)
{
    EXPECT_TRUE(body_of(R"(rhopbody="7")", R"(<masspart value="0" />)").distribute_mass);
    EXPECT_TRUE(
        body_of(R"(rhopbody="7")", R"(<masspart value="distributed_bodymass" />)").distribute_mass);
    const FloatingDef given = body_of(R"(rhopbody="7")", R"(<masspart value="0.3" />)");
    EXPECT_FALSE(given.distribute_mass);
    EXPECT_EQ(given.mass_part, 0.3);
}

TEST(Floatings, LeaveEntriesOfAFullInertiaThatAreMissingAtZero)
{
    const auto inertia =
        body_of(R"(rhopbody="7")",
                R"(<inertiafull><values v11="1" v13="2" /><values v33="3" /></inertiafull>)")
            .inertia;
    ASSERT_TRUE(inertia);
    EXPECT_EQ((*inertia)[0], (Vec3{1, 0, 2}));
    EXPECT_EQ((*inertia)[1], (Vec3{}));
    EXPECT_EQ((*inertia)[2], (Vec3{0, 0, 3}));
}

TEST(Floatings, LeaveOutAxesOfAVelocityThatNoRowGives)
{
    const std::vector<Element> extra =
        body_of(R"(rhopbody="7")",
                R"(<linearvel><vel time="0" x="1" y="none" /><vel time="1" /></linearvel>)")
            .extra;
    ASSERT_EQ(extra.size(), 1U);
    ASSERT_EQ(extra[0].children.size(), 2U);
    EXPECT_EQ(*extra[0].children[0].find_attribute("x"), "1");
    EXPECT_EQ(*extra[0].children[1].find_attribute("x"), "none");
    for (const Element& row : extra[0].children)
        for (const char* axis : {"y", "z"}) EXPECT_EQ(row.find_attribute(axis), nullptr) << axis;
}

struct Mistake
{
    const char* name;
    const char* attributes;
    const char* children;
    const char* message;
};

class FloatingMistake : public testing::TestWithParam<Mistake>
{
};

TEST_P(FloatingMistake, IsNamedWithItsElement)
{
    try
    {
        read(GetParam().attributes, GetParam().children);
        FAIL() << "no error";
    }
    catch (const CaseError& error)
    {
        EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos)
            << error.what();
    }
}

std::string name_of(const testing::TestParamInfo<Mistake>& info)
{
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Floatings, FloatingMistake,
    testing::Values(
        Mistake{"NoMass", "", "",
                "<floating>: one value that is not 0 must be defined, the child <massbody> or the "
                "attribute relativeweight or rhopbody"},
        Mistake{"MassZero", "", R"(<massbody value="0" />)",
                "<floating>: one value that is not 0 must be defined"},
        Mistake{"MassAsAttribute", R"(massbody="6")", "",
                "<floating>: one value that is not 0 must be defined"},
        Mistake{"TwoMasses", R"(rhopbody="2")", R"(<massbody value="1" />)",
                "<floating>: only one value must be defined"},
        Mistake{"DensityAsChild", "", R"(<rhopbody value="2" />)",
                "<rhopbody>: is not known in <floating>"},
        Mistake{"OldVelocity", R"(rhopbody="2")", R"(<velini x="1" y="0" z="0" />)",
                "<velini>: is not known in <floating>"},
        Mistake{"TwoCentres", R"(rhopbody="2")",
                R"(<center x="0" y="0" z="0" /><center x="0" y="0" z="0" />)",
                "<center>: there are two of it in <floating>"},
        Mistake{"TwoInertias", R"(rhopbody="2")", R"(<inertia x="1" y="1" z="1" /><inertiafull />)",
                "<inertiafull>: is given beside <inertia>"},
        Mistake{"CentreWithoutZ", R"(rhopbody="2")", R"(<center x="0" y="0" />)",
                "<center>: attribute 'z' is missing"}),
    name_of);

} // namespace
} // namespace fppg
