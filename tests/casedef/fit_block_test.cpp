// The block <fppg> of <casedef>, and -fit.
#include "fppg/case_def.h"
#include "fppg/error.h"

#include "helpers/case_text.h"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>

namespace fppg
{
namespace
{

using test::CaseText;
using testing::HasSubstr;
using testing::IsEmpty;

/// mk of mkbound 0 where <mkconfig> leaves nine for fluid.
constexpr std::uint16_t first_bound = 10;

CaseDef read(const CaseText& text, FitChoice fit = FitChoice::AsCase)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    CaseOptions options;
    options.fit = fit;
    return read_case(folder / "Case_Def.xml", options);
}

/// A tank with this after its geometry.
CaseText tank_with(const std::string& text)
{
    CaseText out = test::tank();
    out.after_geometry = text;
    return out;
}

CaseDef read_block(const std::string& inside, FitChoice fit = FitChoice::AsCase)
{
    return read(tank_with("<fppg>" + inside + "</fppg>"), fit);
}

/// The message without the folder of the file.
std::string error_of(const CaseText& text, FitChoice fit = FitChoice::AsCase)
{
    try
    {
        read(text, fit);
    }
    catch (const CaseError& error)
    {
        const std::string what = error.what();
        return what.substr(what.find("Case_Def.xml"));
    }
    return "no error";
}

const FitSettings& settings(const CaseDef& def, int mkbound)
{
    const FitSettings* found =
        fit_settings(def.fit, static_cast<std::uint16_t>(first_bound + mkbound));
    if (found == nullptr) throw std::runtime_error("not fitted");
    return *found;
}

bool is_fitted(const CaseDef& def, int mkbound)
{
    return fit_settings(def.fit, static_cast<std::uint16_t>(first_bound + mkbound)) != nullptr;
}

TEST(FitBlock, IsAbsentInAPlainCase)
{
    const CaseDef def = read(test::tank());
    EXPECT_TRUE(def.fit.is_empty());
    EXPECT_TRUE(def.fluid_bands.empty());
    EXPECT_EQ(fit_settings(def.fit, first_bound), nullptr);
}

TEST(FitBlock, FitsEveryBoundaryWithTheDefaultsWhenItSaysNothingElse)
{
    const CaseDef def = read_block("<bodyfitted />");
    for (const int mkbound : {0, 1, 239})
    {
        const FitSettings& s = settings(def, mkbound);
        EXPECT_EQ(s.feature_angle_deg, 30);
        EXPECT_EQ(s.density, FitDensity::Area);
        EXPECT_FALSE(s.clearance_dp || s.relax.iterations);
        EXPECT_EQ(s.one_sheet_dp, 0.6);
        EXPECT_TRUE(s.relax.is_active);
        EXPECT_EQ(s.relax, RelaxSettings{});
    }
    EXPECT_THAT(def.warnings, IsEmpty());
}

TEST(FitBlock, SetsEverythingThatItNames)
{
    const CaseDef def = read_block(
        R"(<bodyfitted mkbound="0-1,7" featureangle="45" density="cell" clearance="0.55" plates="one">
<relax iterations="40" tolerance="0.1" h="1.2" band="2" snapshots="10" /></bodyfitted>)");
    for (const int mkbound : {0, 1, 7})
    {
        const FitSettings& s = settings(def, mkbound);
        EXPECT_EQ(s.feature_angle_deg, 45);
        EXPECT_EQ(s.density, FitDensity::Cell);
        EXPECT_EQ(s.clearance_dp, 0.55);
        EXPECT_EQ(s.one_sheet_dp, 1);
        EXPECT_EQ(s.relax, (RelaxSettings{true, 40, 0.1, 1.2, 2, 10}));
    }
    EXPECT_FALSE(is_fitted(def, 2));
}

TEST(FitBlock, TakesTheWordsForItsDefaultsToo)
{
    const CaseDef def = read_block(
        R"(<bodyfitted density="area" clearance="auto" plates="auto"><relax iterations="auto" /></bodyfitted>)");
    EXPECT_EQ(settings(def, 0).relax.tolerance, 0.001);
    FitSettings plain;
    plain.line = settings(def, 0).line;
    plain.boundary = WallBoundary::Dbc; // as the case has no parameter Boundary
    plain.sheet_depths_dp = {0, 1, 2};
    EXPECT_EQ(settings(def, 0), plain);
}

TEST(FitBlock, SwitchesRelaxationOffAndWidensItsBand)
{
    EXPECT_FALSE(settings(read_block(R"(<bodyfitted><relax active="false" /></bodyfitted>)"), 0)
                     .relax.is_active);
    EXPECT_TRUE(std::isinf(
        settings(read_block(R"(<bodyfitted><relax band="all" /></bodyfitted>)"), 0).relax.band_dp));
}

TEST(FitBlock, LetsTheLaterElementWin)
{
    const CaseDef narrow_last = read_block(
        R"(<bodyfitted featureangle="10" /><bodyfitted mkbound="0,1" featureangle="20" /><bodyfitted mkbound="1" featureangle="40" />)");
    EXPECT_EQ(settings(narrow_last, 0).feature_angle_deg, 20);
    EXPECT_EQ(settings(narrow_last, 1).feature_angle_deg, 40);
    EXPECT_EQ(settings(narrow_last, 2).feature_angle_deg, 10);
    const CaseDef all_last = read_block(
        R"(<bodyfitted mkbound="0" featureangle="20" /><bodyfitted featureangle="10" />)");
    EXPECT_EQ(settings(all_last, 0).feature_angle_deg, 10);
}

/// With this boundary condition in the parameters of the case.
CaseText tank_with_boundary(const std::string& fppg, const std::string& parameters)
{
    CaseText out = tank_with("<fppg>" + fppg + "</fppg>");
    out.execution = "<parameters>" + parameters + "</parameters>";
    return out;
}

const std::string best_mdbc =
    R"(<parameter key="Boundary" value="2" /><parameter key="SlipMode" value="2" /><parameter key="NoPenetration" value="1" />)";

TEST(FitBlock, PutsLayersAsDeepAsTheKernelWhereTheCaseAsksForMdbc)
{
    using testing::ElementsAre;
    const CaseDef mdbc = read(tank_with_boundary(R"(<bodyfitted />)", best_mdbc));
    EXPECT_THAT(settings(mdbc, 0).depths_dp, ElementsAre(0.5, 1.5, 2.5));
    EXPECT_TRUE(mdbc.normals.is_active);
    EXPECT_THAT(mdbc.warnings, IsEmpty());
    const CaseDef two = read(
        tank_with_boundary(R"(<bodyfitted boundary="auto" layers="2" side="both" />)", best_mdbc));
    EXPECT_THAT(settings(two, 0).depths_dp, ElementsAre(0.5, 1.5));
    EXPECT_EQ(settings(two, 0).side, LayerSide::Both);
    const CaseDef dbc = read_block(R"(<bodyfitted boundary="dbc" layers="3" />)");
    EXPECT_THAT(settings(dbc, 0).depths_dp, ElementsAre(0, 1, 2));
    EXPECT_FALSE(dbc.normals.is_active);
    EXPECT_THAT(settings(read_block("<bodyfitted />"), 0).depths_dp, IsEmpty());
    EXPECT_THAT(settings(read_block("<bodyfitted />"), 0).sheet_depths_dp, ElementsAre(0, 1, 2));
    // What is farther than 0.92 of the kernel's reach is not felt.
    CaseText wider = tank_with("<fppg><bodyfitted /></fppg>");
    wider.constants.replace(wider.constants.find("coefh value=\"1\""), 15, "coefh value=\"1.2\"");
    EXPECT_THAT(settings(read(wider), 0).sheet_depths_dp, ElementsAre(0, 1, 2));
    EXPECT_THAT(settings(dbc, 0).sheet_depths_dp, IsEmpty());
    EXPECT_THAT(settings(mdbc, 0).sheet_depths_dp, IsEmpty());
}

TEST(FitBlock, RefusesAKernelFarWiderThanWallsOrWithoutWidth)
{
    for (const char* coefh : {"6", "1e308", "0", "-1e9"})
        for (const char* block :
             {"<bodyfitted />", R"(<bodyfitted layers="3" />)", R"(<bodyfitted boundary="dbc" />)"})
        {
            CaseText text = tank_with_boundary(block, best_mdbc);
            text.constants.replace(text.constants.find("coefh value=\"1\""), 15,
                                   std::string("coefh value=\"") + coefh + "\"");
            EXPECT_THAT([&] { (void)read(text); }, testing::ThrowsMessage<CaseError>(
                                                       HasSubstr("more than 0 and at most 17 dp")));
        }
}

TEST(FitBlock, SaysThatAllParticlesAreInside)
{
    const CaseDef def = read_block(
        R"(<bodyfitted place="inside" across="4" volume="exact" /><bodyfitted mkbound="1" />)");
    EXPECT_EQ(def.fit.all->place, Placement::Inside);
    EXPECT_EQ(def.fit.all->across, 4);
    EXPECT_TRUE(def.fit.all->has_exact_volumes);
    EXPECT_EQ(def.fit.all->depths_dp, std::vector<double>{0.5});
    ASSERT_EQ(def.fit.of_mk.size(), 1);
    EXPECT_NE(def.fit.of_mk.begin()->second.place, Placement::Inside);
    EXPECT_FALSE(def.fit.of_mk.begin()->second.has_exact_volumes);
}

/// By itself: with dynamic boundaries, what floats.
TEST(FitBlock, PutsFloatingBodiesInside)
{
    const auto is_inside = [](const std::string& block, int mkbound, int boundary = 1)
    {
        CaseText text = tank_with("<fppg>" + block + "</fppg>");
        text.after_geometry +=
            R"(<floatings><floating mkbound="1-2" rhopbody="500" /></floatings>)";
        text.execution = fmt::format(
            R"(<parameters><parameter key="Boundary" value="{}" /></parameters>)", boundary);
        return settings(read(text), mkbound).place == Placement::Inside;
    };
    for (const int mkbound : {1, 2}) EXPECT_TRUE(is_inside("<bodyfitted />", mkbound));
    for (const int mkbound : {0, 3}) EXPECT_FALSE(is_inside("<bodyfitted />", mkbound));
    // Layers hold water at the surface.
    EXPECT_FALSE(is_inside("<bodyfitted />", 1, 2));
    EXPECT_FALSE(is_inside(R"(<bodyfitted boundary="mdbc" />)", 1));
    for (const char* asked : {R"(place="surface")", R"(layers="2")", R"(clearance="0.8")"})
        EXPECT_FALSE(is_inside(fmt::format("<bodyfitted {} />", asked), 2)) << asked;
    EXPECT_TRUE(is_inside(R"(<bodyfitted layers="auto" plates="auto" />)", 2));
}

TEST(FitBlock, WarnsOfOneLayerForMdbcAndHintsAtMore)
{
    const CaseDef one = read(tank_with_boundary(R"(<bodyfitted layers="1" />)", best_mdbc));
    ASSERT_EQ(one.warnings.size(), 1u);
    EXPECT_THAT(one.warnings[0], HasSubstr("Case_Def.xml:9: <bodyfitted layers=\"1\">: fluid goes "
                                           "through walls of one layer"));
    EXPECT_THAT(one.warnings[0], HasSubstr("they need 3"));
    const CaseDef two =
        read(tank_with_boundary(R"(<bodyfitted mkbound="0,0" layers="2" />)", best_mdbc));
    EXPECT_THAT(two.warnings, IsEmpty());
    ASSERT_EQ(two.hints.size(), 1u);
    EXPECT_THAT(two.hints[0], HasSubstr("sees 3 layers"));
    EXPECT_THAT(read_block(R"(<bodyfitted boundary="dbc" layers="1" />)").warnings, IsEmpty());
}

TEST(FitBlock, HintsAtTheParametersThatKeepFluidOutOfMdbcWalls)
{
    const auto hints = [](const std::string& parameters, const char* fppg)
    {
        const CaseDef def = read(
            tank_with_boundary(fppg, R"(<parameter key="Boundary" value="2" />)" + parameters));
        EXPECT_TRUE(def.warnings.empty() || std::string(fppg).find("dbc") != std::string::npos);
        return def.hints;
    };
    const std::string no_penetration = R"(<parameter key="NoPenetration" value="1" />)";
    const std::string slip = R"(<parameter key="SlipMode" value="2" />)";
    ASSERT_EQ(hints("", "<bodyfitted />").size(), 1u);
    EXPECT_THAT(hints("", "<bodyfitted />")[0], HasSubstr("SlipMode is 1"));
    EXPECT_EQ(hints(no_penetration, "<bodyfitted />").size(), 1u);
    ASSERT_EQ(hints(slip, "<bodyfitted />").size(), 1u);
    EXPECT_THAT(hints(slip, "<bodyfitted />")[0], HasSubstr("NoPenetration is not 1"));
    EXPECT_EQ(
        hints(slip + R"(<_parameter key="NoPenetration" value="1" />)", "<bodyfitted />").size(),
        1u);
    EXPECT_THAT(hints(slip + no_penetration, "<bodyfitted />"), IsEmpty());
    EXPECT_THAT(
        hints(R"(<parameter key="SlipMode" value="3" />)" + no_penetration, "<bodyfitted />"),
        IsEmpty());
    EXPECT_THAT(hints("", ""), IsEmpty());
    EXPECT_THAT(hints("", R"(<bodyfitted boundary="dbc" />)"), IsEmpty());
}

TEST(FitBlock, EvaluatesExpressionsWithVariablesOfTheCommands)
{
    CaseText text = tank_with(
        R"(<fppg><bodyfitted mkbound="#wall" featureangle="#2*a"><relax iterations="#a" /></bodyfitted></fppg>)");
    text.mainlist += R"(<newvar a="20" wall="0" />)";
    const CaseDef def = read(text);
    EXPECT_EQ(settings(def, 0).feature_angle_deg, 40);
    EXPECT_EQ(settings(def, 0).relax.iterations, 20);
}

TEST(FitBlock, ReadsBandsOfFluid)
{
    const CaseDef def = read_block(
        R"(<fluidband width="2.5" packing="cubic" /><fluidband mkfluid="0" /><bodyfitted mkbound="0" />)");
    ASSERT_EQ(def.fluid_bands.size(), 2u);
    EXPECT_TRUE(def.fluid_bands[0].mk.empty());
    EXPECT_EQ(def.fluid_bands[0].width_dp, 2.5);
    EXPECT_FALSE(def.fluid_bands[0].packs);
    EXPECT_TRUE(def.fluid_bands[1].packs);
    EXPECT_EQ(def.fluid_bands[1].mk, std::vector<std::uint16_t>{1});
    EXPECT_EQ(def.fluid_bands[1].width_dp, 3);
}

TEST(FitBlock, MayStandAnywhereInCasedefAndMoreThanOnce)
{
    std::string text =
        tank_with(R"(<fppg><bodyfitted mkbound="1" featureangle="5" /></fppg>)").text();
    text.insert(text.find("<constantsdef>"),
                R"(<fppg><bodyfitted mkbound="0-1" featureangle="15" /></fppg>)");
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text);
    const CaseDef def = read_case(folder / "Case_Def.xml", {});
    EXPECT_EQ(settings(def, 0).feature_angle_deg, 15);
    EXPECT_EQ(settings(def, 1).feature_angle_deg, 5);
}

TEST(FitBlock, PassesOverRemarks)
{
    const CaseDef def = read_block(
        R"(<!-- all --><_bodyfitted angle="1" /><bodyfitted comment="walls" _angle="1"><_relax /></bodyfitted>)");
    EXPECT_TRUE(is_fitted(def, 0));
}

TEST(FitBlock, StaysInTheCopyOfTheDefinition)
{
    const CaseDef def = read_block(R"(<bodyfitted mkbound="0" featureangle="#15*2" />)");
    const Element* block = def.casedef.find_child("fppg");
    ASSERT_NE(block, nullptr);
    EXPECT_EQ(*block->find_child("bodyfitted")->find_attribute("mkbound"), "0");
}

// -- the command line
// -------------------------------------------------------------------------------------

TEST(FitChoice, OnAddsTheDefaultsToWhatTheBlockNames)
{
    const CaseDef plain = read(test::tank(), FitChoice::On);
    FitSettings defaults;
    defaults.boundary = WallBoundary::Dbc; // as the case has no parameter Boundary
    defaults.sheet_depths_dp = {0, 1, 2};
    EXPECT_EQ(settings(plain, 5), defaults);
    const CaseDef named =
        read_block(R"(<bodyfitted mkbound="0" featureangle="20" />)", FitChoice::On);
    EXPECT_EQ(settings(named, 0).feature_angle_deg, 20);
    EXPECT_EQ(settings(named, 1), defaults);
    const CaseDef all = read_block(R"(<bodyfitted featureangle="20" />)", FitChoice::On);
    EXPECT_EQ(settings(all, 1).feature_angle_deg, 20);
}

TEST(FitChoice, RawIsOnWithoutRelaxation)
{
    const CaseDef def = read_block(
        R"(<bodyfitted mkbound="0" featureangle="20"><relax active="true" /></bodyfitted><fluidband />)",
        FitChoice::Raw);
    EXPECT_EQ(settings(def, 0).feature_angle_deg, 20);
    EXPECT_FALSE(settings(def, 0).relax.is_active);
    EXPECT_FALSE(settings(def, 1).relax.is_active);
    EXPECT_TRUE(def.fluid_bands.empty());
}

TEST(FitChoice, OffIgnoresTheBlockWhole)
{
    const CaseDef def = read_block("<bodyfitted /><fluidband /><wrong />", FitChoice::Off);
    EXPECT_TRUE(def.fit.is_empty());
    EXPECT_TRUE(def.fluid_bands.empty());
    EXPECT_THAT(def.warnings, IsEmpty());
}

// -- warnings
// ---------------------------------------------------------------------------------------------

TEST(FitBlock, WarnsOfNumbersThatNothingDraws)
{
    const CaseDef def = read_block(R"(<bodyfitted mkbound="0-2" />
<fluidband mkfluid="0,3" />)");
    ASSERT_EQ(def.warnings.size(), 2u);
    EXPECT_THAT(def.warnings[0], HasSubstr("Case_Def.xml:9: <bodyfitted>: mkbound 1,2: nothing"));
    EXPECT_THAT(def.warnings[1], HasSubstr("Case_Def.xml:10: <fluidband>: mkfluid 3: nothing"));
    EXPECT_TRUE(is_fitted(def, 2));
}

TEST(FitBlock, WarnsOfALongListInOneShortLine)
{
    const CaseDef def = read_block(R"(<bodyfitted mkbound="0-200" />)");
    ASSERT_EQ(def.warnings.size(), 1u);
    EXPECT_THAT(def.warnings[0], HasSubstr("mkbound 1,2,3,4,5,6,7,8,9,10 and 190 more: nothing"));
}

TEST(FitBlock, CountsADrawOfPointsAsNoSurface)
{
    CaseText text = tank_with(R"(<fppg><bodyfitted mkbound="1" /></fppg>)");
    text.mainlist += R"(<setmkbound mk="1" /><drawpoint x="0" y="0" z="0" />)";
    EXPECT_EQ(read(text).warnings.size(), 1u);
    text.mainlist += R"(<drawsphere radius="0.3"><point x="0.5" y="0.5" z="0.5" /></drawsphere>)";
    EXPECT_THAT(read(text).warnings, IsEmpty());
}

TEST(FitBlock, WarnsOfAFluidBandWithoutWalls)
{
    const CaseDef def = read_block("<fluidband />");
    ASSERT_EQ(def.warnings.size(), 1u);
    EXPECT_THAT(def.warnings[0], HasSubstr("<fluidband>: no wall is body-fitted"));
    EXPECT_THAT(read_block("<fluidband />", FitChoice::On).warnings, IsEmpty());
}

// -- mistakes
// ---------------------------------------------------------------------------------------------

struct Mistake
{
    const char* name;
    const char* block;
    const char* message;
};

void PrintTo(const Mistake& mistake, std::ostream* out)
{
    *out << mistake.name;
}

class FitBlockMistake : public testing::TestWithParam<Mistake>
{
};

TEST_P(FitBlockMistake, IsNamedWithFileLineElementAndWhatIsExpected)
{
    const std::string message = error_of(tank_with(GetParam().block));
    EXPECT_EQ(message.rfind("Case_Def.xml:9: <", 0), 0u) << message;
    EXPECT_THAT(message, HasSubstr(GetParam().message));
}

std::string name_of(const testing::TestParamInfo<Mistake>& info)
{
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Block, FitBlockMistake,
    testing::Values(
        Mistake{"UnknownElement", "<fppg><bodyfit /></fppg>",
                "<bodyfit>: is not known in <fppg>, expected bodyfitted, boolean, fluidband, fill, "
                "floatings, offlattice, points"},
        Mistake{"UnknownInOfflattice", R"(<fppg><offlattice hydrostatics="1" /></fppg>)",
                "<offlattice>: attribute hydrostatics=\"1\" is not known (did you mean "
                "hydrostatic?), expected hydrostatic"},
        Mistake{
            "UnknownAttribute", R"(<fppg><bodyfitted angle="30" /></fppg>)",
            "<bodyfitted>: attribute angle=\"30\" is not known, expected mkbound, featureangle,"},
        Mistake{"AttributeOfTheBlock", R"(<fppg active="0"></fppg>)",
                "<fppg>: attribute active=\"0\" is not known, expected none"},
        Mistake{"UnknownInBodyfitted", "<fppg><bodyfitted><fluidband /></bodyfitted></fppg>",
                "<fluidband>: is not known in <bodyfitted>, expected relax"},
        Mistake{"UnknownRelaxAttribute",
                R"(<fppg><bodyfitted><relax steps="3" /></bodyfitted></fppg>)",
                "<relax>: attribute steps=\"3\" is not known, expected active, iterations,"},
        Mistake{"Text", "<fppg>walls</fppg>", "<fppg>: text \"walls\" has no meaning here"},
        Mistake{"TwoRelaxes", "<fppg><bodyfitted><relax /><relax /></bodyfitted></fppg>",
                "<relax>: is given twice in <bodyfitted>, expected once at most"},
        Mistake{"FlatAngle", R"(<fppg><bodyfitted featureangle="180" /></fppg>)",
                "attribute featureangle=\"180\" is 180, expected degrees from 0 to less than 180"},
        Mistake{"EmptyAngle", R"(<fppg><bodyfitted featureangle=" " /></fppg>)",
                "attribute featureangle=\"\" is empty, expected degrees"},
        Mistake{"NoNumber", R"(<fppg><bodyfitted clearance="wide" /></fppg>)",
                "attribute clearance=\"wide\""},
        Mistake{"UnknownVariable", R"(<fppg><bodyfitted clearance="#wide" /></fppg>)",
                "attribute clearance=\"#wide\""},
        Mistake{"NarrowClearance", R"(<fppg><bodyfitted clearance="0.4" /></fppg>)",
                "clearance=\"0.4\" is 0.4, expected auto or 0.5 to 1 (times dp)"},
        Mistake{"Density", R"(<fppg><bodyfitted density="Area" /></fppg>)",
                "attribute density=\"Area\" is invalid, expected area or cell"},
        Mistake{"Plates", R"(<fppg><bodyfitted plates="none" /></fppg>)",
                "attribute plates=\"none\" is invalid, expected auto, both or one"},
        Mistake{"Boundary", R"(<fppg><bodyfitted boundary="mDBC" /></fppg>)",
                "<bodyfitted>: attribute boundary=\"mDBC\" is invalid, expected auto, mdbc or dbc"},
        Mistake{"NoLayers", R"(<fppg><bodyfitted layers="0" /></fppg>)",
                "attribute layers=\"0\" is 0, expected auto or a whole number from 1 to 16"},
        Mistake{"TooManyLayers", R"(<fppg><bodyfitted layers="17" /></fppg>)",
                "layers=\"17\" is 17, expected auto or a whole number from 1 to 16"},
        Mistake{"HalfALayer", R"(<fppg><bodyfitted layers="2.5" /></fppg>)",
                "layers=\"2.5\" is 2.5, expected auto or a whole number"},
        Mistake{"EmptyLayers", R"(<fppg><bodyfitted layers="" /></fppg>)",
                "attribute layers=\"\" is empty, expected auto or a whole number"},
        Mistake{"WordForLayers", R"(<fppg><bodyfitted layers="deep" /></fppg>)",
                "attribute layers=\"deep\""},
        Mistake{"Side", R"(<fppg><bodyfitted side="inside" /></fppg>)",
                "attribute side=\"inside\" is invalid, expected behind, front or both"},
        Mistake{"Place", R"(<fppg><bodyfitted place="within" /></fppg>)",
                "attribute place=\"within\" is invalid, expected surface or inside"},
        Mistake{"AcrossASurface", R"(<fppg><bodyfitted across="3" /></fppg>)",
                "attribute across is for place=\"inside\" only"},
        Mistake{"NothingAcross", R"(<fppg><bodyfitted place="inside" across="0" /></fppg>)",
                "across=\"0\" is 0, expected auto or a whole number from 1 to 64"},
        Mistake{"LayersInside", R"(<fppg><bodyfitted place="inside" layers="2" /></fppg>)",
                "attribute layers has no meaning with place=\"inside\""},
        Mistake{"Volume", R"(<fppg><bodyfitted volume="own" /></fppg>)",
                "attribute volume=\"own\" is invalid, expected equal or exact"},
        Mistake{"NoIterations", R"(<fppg><bodyfitted><relax iterations="0" /></bodyfitted></fppg>)",
                "iterations=\"0\" is 0, expected auto or a whole number from 1 to 1000000"},
        Mistake{"HalfAnIteration",
                R"(<fppg><bodyfitted><relax iterations="1.5" /></bodyfitted></fppg>)",
                "iterations=\"1.5\" is 1.5, expected auto"},
        Mistake{"NoTolerance", R"(<fppg><bodyfitted><relax tolerance="0" /></bodyfitted></fppg>)",
                "tolerance=\"0\" is 0, expected above 0 to 1"},
        Mistake{"NoH", R"(<fppg><bodyfitted><relax h="0" /></bodyfitted></fppg>)",
                "h=\"0\" is 0, expected 0.5 to 2"},
        Mistake{"HalfASnapshot",
                R"(<fppg><bodyfitted><relax snapshots="0.5" /></bodyfitted></fppg>)",
                "snapshots=\"0.5\" is 0.5, expected a whole number of iterations from 0"},
        Mistake{"NegativeBand", R"(<fppg><bodyfitted><relax band="-1" /></bodyfitted></fppg>)",
                "band=\"-1\" is -1, expected all or a width from 0 on"},
        Mistake{"UnknownPacking", R"(<fppg><fluidband packing="square" /></fppg>)",
                "<fluidband>: packing=\"square\" is unknown, expected stable"},
        Mistake{"NoWidth", R"(<fppg><fluidband width="0" /></fppg>)",
                "<fluidband>: attribute width=\"0\" is 0, expected a width above 0"},
        Mistake{"BadList", R"(<fppg><bodyfitted mkbound="3-1" /></fppg>)",
                "attribute mkbound=\"3-1\" is not a list of whole numbers"},
        Mistake{"EmptyList", R"(<fppg><bodyfitted mkbound="" /></fppg>)",
                "attribute mkbound=\"\" is not a list of whole numbers"},
        Mistake{"BrokenMk", R"(<fppg><bodyfitted mkbound="#0.5" /></fppg>)",
                "mkbound=\"#0.5\" is 0.5, expected a whole number from 0 to 65000"},
        Mistake{"MkboundBeyondMkconfig", R"(<fppg><bodyfitted mkbound="240" /></fppg>)",
                "<bodyfitted>: mkbound 240 is out of range, <mkconfig> leaves 0 to 239 (raise "
                "boundcount"},
        Mistake{"MkfluidBeyondMkconfig", R"(<fppg><fluidband mkfluid="9" /></fppg>)",
                "<fluidband>: mkfluid 9 is out of range, <mkconfig> leaves 0 to 8 (raise "
                "fluidcount"},
        Mistake{"WrongPlace", "<someblock><fppg /></someblock>",
                "<fppg>: is in <someblock>, expected directly in <casedef>"},
        Mistake{"WallsWithoutBlock", R"(<bodyfitted mkbound="0" />)",
                "<bodyfitted>: is in <casedef>, expected in <casedef><fppg>"},
        Mistake{"FluidInWrongPlace", "<special><fluidband /></special>",
                "<fluidband>: is in <special>, expected in <casedef><fppg>"}),
    name_of);

TEST(FitBlock, TakesEveryNumberOfMkconfig)
{
    CaseText text = tank_with(R"(<fppg><bodyfitted mkbound="39999" /></fppg>)");
    text.mkconfig = R"(<mkconfig boundcount="40000" fluidcount="9" />)";
    text.mainlist += R"(<setmkbound mk="39999" /><drawpoint x="0" y="0" z="0" />)";
    EXPECT_EQ(error_of(text), "no error");
    EXPECT_EQ(error_of(text, FitChoice::On), "no error");
}

} // namespace
} // namespace fppg
