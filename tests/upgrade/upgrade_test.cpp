// fppg upgrade: which bytes of a definition change. Each form was given to GenCase v5.4.354, or
// looked up in the source of its solver.

#include "fppg/error.h"
#include "helpers/case_text.h"
#include "upgrade/upgrade_cases.h"

#include <filesystem>

namespace
{

using namespace fppg;
using namespace fppg::test;

TEST(Upgrade, RealIsActual)
{
    const auto modes = [](const std::string& text)
    { return definition("<commands><setshapemode>" + text + "</setshapemode></commands>\n"); };
    expect_upgrade(modes("real | dp | bound"), modes("actual | dp | bound"));
    expect_upgrade(modes("dp|real"), modes("dp|actual"));
    expect_upgrade(modes("\n  real \n| all\n"), modes("\n  actual \n| all\n"));
    // Both are the same: one stays.
    expect_upgrade(modes("actual | real | bound"), modes("actual | bound"));
    expect_upgrade(modes("actual|real"), modes("actual"));
    expect_upgrade(modes("real | real"), modes("actual"));
    // GenCase v5.4 refuses these.
    expect_upgrade(modes("Real | bound"), modes("Real | bound"));
    expect_upgrade(modes("reality"), modes("reality"));
}

TEST(Upgrade, TellsLineFromAndTo)
{
    const UpgradedDefinition out =
        upgrade(definition("<commands>\n<setshapemode>real</setshapemode>\n</commands>\n"
                           "<motion><objreal ref=\"1\">\n<mvfile id=\"1\" duration=\"2\">"
                           "<file name=\"a.dat\" fields=\"2\" fieldtime=\"0\" fieldx=\"1\"/>"
                           "</mvfile>\n</objreal></motion>\n"));
    ASSERT_EQ(out.changes.size(), 2U);
    EXPECT_EQ(out.changes[0].line, 5);
    EXPECT_EQ(out.changes[0].from, "<setshapemode>real");
    EXPECT_EQ(out.changes[0].to, "<setshapemode>actual");
    EXPECT_EQ(out.changes[1].line, 8);
    EXPECT_EQ(out.changes[1].from, "<mvfile>");
    EXPECT_EQ(out.changes[1].to, "<mvrectfile>");
}

TEST(Upgrade, KeepsEveryOtherByte)
{
    // Blanks before the declaration, line ends of two kinds, tabs, quotes, a '<' in a value, bytes
    // that are no UTF-8, comments and elements that are switched off.
    const auto text = [](const std::string& mode)
    {
        return "\xEF\xBB\xBF\n<?xml version='1.0' ?>\r\n<case app = 'x'  ><!-- real: "
               "<setshapemode>real</setshapemode> -->\r\n\t<casedef>\n<abort if=\"Dp<0.1\" "
               "text='\"a\" > b'/>\r\n<_setshapemode>real</_setshapemode><_list><setshapemode>real"
               "</setshapemode></_list>\t<setshapemode >" +
               mode +
               "</setshapemode  ><![CDATA[</case>]]><note>\xE9 real</note>\n\n</casedef></case>";
    };
    expect_upgrade(text("real"), text("actual"));
    expect_upgrade(text("actual"), text("actual"));
}

struct Names
{
    const char* before;
    const char* after;
};

TEST(Upgrade, GivesElementsOfTheDefinitionTheirNewNames)
{
    const Names all[] = {
        {"<constantsdef><coefficient value=\"1\"/></constantsdef>",
         "<constantsdef><coefh value=\"1\"/></constantsdef>"},
        {"<motion><objreal ref=\"1\"><mvpredef id=\"1\" duration=\"9\"><file name=\"a\"/>"
         "</mvpredef><mvfile id=\"2\"/><mvnull id=\"3\"/></objreal></motion>",
         "<motion><objreal ref=\"1\"><mvrectfile id=\"1\" duration=\"9\"><file name=\"a\"/>"
         "</mvrectfile><mvrectfile id=\"2\"/><mvnull id=\"3\"/></objreal></motion>"},
        {"<floatings><floating mkbound=\"1\"><velini x=\"1\"/><omegaini x=\"1\"/><translation "
         "x=\"0\"/><rotation x=\"0\"></rotation></floating></floatings>",
         "<floatings><floating mkbound=\"1\"><linearvelini x=\"1\"/><angularvelini x=\"1\"/>"
         "<translationDOF x=\"0\"/><rotationDOF x=\"0\"></rotationDOF></floating></floatings>"},
        {"<newvar A=\"1\" _cte=\"True\" _rem=\"r\"/><newvarstr _cte='1' B=\"b\"></newvarstr>"
         "<newvar _cte=\"0\" C=\"1\"/>",
         "<newvarcte A=\"1\" _rem=\"r\"/><newvarstrcte B=\"b\"></newvarstrcte>"
         "<newvar _cte=\"0\" C=\"1\"/>"},
    };
    for (const Names& names : all)
        expect_upgrade(definition(names.before), definition(names.after));
}

TEST(Upgrade, GivesElementsOfTheSolverTheirNewNames)
{
    const Names all[] = {
        {"<moorings><moordyn comment=\"c\"><output><time dtOut=\"1\"/></output><lines><line "
         "output=\"1\"/></lines></moordyn></moorings>",
         "<moorings><moordynplus comment=\"c\"><savedata><time dtOut=\"1\"/></savedata><lines>"
         "<line output=\"1\"/></lines></moordynplus></moorings>"},
        {"<relaxationzones><rzwaves_uniform/><rzwaves_uniform></rzwaves_uniform><rzwaves_regular/>"
         "</relaxationzones>",
         "<relaxationzones><rz_uniform/><rz_uniform></rz_uniform><rzwaves_regular/>"
         "</relaxationzones>"},
        {"<gauges><default><output value=\"1\"/></default></gauges>",
         "<gauges><default><output value=\"1\"/></default></gauges>"},
    };
    for (const Names& names : all)
        expect_upgrade(definition("", fmt::format("<special>{}</special>", names.before)),
                       definition("", fmt::format("<special>{}</special>", names.after)));
}

TEST(Upgrade, LeavesAnOldNameBesideItsNewOne)
{
    expect_note(definition("<constantsdef><coefh value=\"1\"/>\n<coefficient value=\"2\"/>"
                           "</constantsdef>\n"),
                5, "<coefficient> is called <coefh> now");
    expect_note(definition("<floatings><floating mkbound=\"1\"><velini x=\"1\"/><linearvelini "
                           "x=\"2\"/></floating></floatings>\n"),
                4, "keep one");
}

TEST(Upgrade, NamesShapeFilesAsTheyAreWritten)
{
    const auto files = [](const std::string& own, const std::string& other)
    {
        return definition("<normals><norgeometry><geometryfile file=\"[CaseName]_hdp_" + own +
                              ".vtk\" /></norgeometry></normals>\n",
                          "<special><chrono><bodyfixed id=\"a\" modelfile=\"CaseA__" + own +
                              ".vtk\" /><bodyfixed id=\"b\" modelfile=\"" + other +
                              "\" /></chrono></special>\n");
    };
    expect_upgrade(files("Real", "Dam_Real.vtk"), files("Actual", "Dam_Real.vtk"));
    // A file that is there is not one that this case writes.
    const TemporaryFolder folder;
    write_text(folder / "CaseA__Real.vtk", "");
    const std::string text = definition("<drawfilevtk file=\"CaseA__Real.vtk\" />");
    EXPECT_EQ(upgrade_definition(text, folder / "CaseA_Def.xml").text, text);
}

std::string parameters(const std::string& inside)
{
    return definition("", "        <parameters>\n" + inside + "        </parameters>\n");
}

TEST(Upgrade, TellsDeprecatedParametersAnew)
{
    expect_upgrade(parameters("<parameter key=\"PosDouble\" value=\"2\" comment=\"old\" />\n"),
                   parameters("<parameter key=\"SavePosDouble\" value=\"1\" comment=\"Saves "
                              "positions in double precision (default=0)\" />\n"));
    expect_upgrade(parameters("<parameter key=\"PosDouble\" value=\"1\"/>\n"),
                   parameters("<parameter key=\"SavePosDouble\" value=\"0\"/>\n"));
    expect_upgrade(parameters("<parameter key=\"PosDouble\" value=\"1\"/><parameter "
                              "key=\"SavePosDouble\" value=\"1\"/>\n"),
                   parameters("<_parameter key=\"PosDouble\" value=\"1\"/><parameter "
                              "key=\"SavePosDouble\" value=\"1\"/>\n"));
    expect_upgrade(parameters("<parameter key=\"PartsOutMax\" value=\"1.0\" units_comment=\"u\"/>"),
                   parameters("<parameter key=\"MinFluidStop\" value=\"0\" units_comment=\"u\"/>"));
}

TEST(Upgrade, MakesTwoParametersOfDeltaSph)
{
    expect_upgrade(parameters("\t<parameter key=\"DeltaSPH\" value=\"0.2\" />\n"),
                   parameters("\t<parameter key=\"DensityDT\" value=\"1\" />\n"
                              "\t<parameter key=\"DensityDTvalue\" value=\"0.2\" />\n"));
    expect_upgrade(
        parameters("<a/><parameter comment=\"c\" key=\"DeltaSPH\" value=\"0.1\"/>"),
        parameters(
            "<a/><parameter comment=\"Density diffusion 0: none, 1: Molteni, 2: Fourtakas, 3: "
            "Fourtakas with boundaries (default=0)\" key=\"DensityDT\" value=\"1\"/>"
            "<parameter comment=\"Factor of the density diffusion (default=0.1)\" "
            "key=\"DensityDTvalue\" value=\"0.1\"/>"));
    expect_upgrade(parameters("<parameter key=\"DeltaSPH\" value=\"0\" />\n"),
                   parameters("<parameter key=\"DensityDT\" value=\"0\" />\n"));
    expect_upgrade(parameters("<parameter key=\"DeltaSPH\" value=\"0.3\" /><parameter "
                              "key=\"DensityDTvalue\" value=\"0.1\" />\n"),
                   parameters("<parameter key=\"DensityDT\" value=\"1\" /><parameter "
                              "key=\"DensityDTvalue\" value=\"0.3\" />\n"));
}

TEST(Upgrade, MakesASimulationDomainOfLimits)
{
    expect_upgrade(
        parameters("            <parameter key=\"IncZ\" value=\"0.5\" comment=\"c\" />\n"),
        parameters("            <simulationdomain>\n"
                   "                <posmin x=\"default\" y=\"default\" z=\"default\" />\n"
                   "                <posmax x=\"default\" y=\"default\" z=\"default + 50%\" />\n"
                   "            </simulationdomain>\n"));
    // DomainFixed puts IncZ aside, and single limits come after it.
    expect_upgrade(parameters("<parameter key=\"IncZ\" value=\"0.5\" />\n"
                              "<parameter key=\"DomainFixed\" value=\"0:1:2:3:4:5\" />\n"
                              "<parameter key=\"A\" value=\"1\" />\n"
                              "<parameter key=\"DomainFixedYmax\" value=\"4.5\" />\n"),
                   parameters("<simulationdomain>\n"
                              "    <posmin x=\"0\" y=\"1\" z=\"2\" />\n"
                              "    <posmax x=\"3\" y=\"4.5\" z=\"5\" />\n"
                              "</simulationdomain>\n"
                              "<parameter key=\"A\" value=\"1\" />\n"));
    const auto domain = [](const std::string& x, const std::string& z)
    {
        return "<simulationdomain><posmin x=\"" + x +
               "\" y=\"default\" z=\"default\" comment=\"c\" /><posmax x=\"default\" "
               "y=\"default\" z=\"" +
               z + "\" /></simulationdomain>\n";
    };
    const std::string inc = "<parameter key=\"IncZ\" value=\"0.1\" />\n";
    const std::string fixed = "<parameter key=\"DomainFixedXmin\" value=\"-1\" />\n";
    expect_upgrade(parameters(inc + fixed + domain("default", "default")),
                   parameters(domain("-1", "default + 10%")));
    expect_note(parameters(inc + domain("-2", "default")), 7, "refuses it together with limits");
    expect_upgrade(parameters("<parameter key=\"IncZ\" value=\"0\" />\n"),
                   parameters("<_parameter key=\"IncZ\" value=\"0\" />\n"));
}

TEST(Upgrade, NotesWhatAPersonHasToDecide)
{
    expect_note(parameters("<parameter key=\"PartsOutMax\" value=\"0.9\" />"), 7,
                "MinFluidStop=\"0.1\" stops a run");
    expect_note(parameters("<parameter key=\"DomainParticlesXmin\" value=\"0.9\" />"), 7,
                "v5.4 does not look at it");
    expect_note(parameters("<parameter key=\"DeltaSPH\" value=\"0.1\" /><parameter "
                           "key=\"DensityDT\" value=\"1\" />"),
                7, "refuses it together with DensityDT");
    expect_note(parameters("<parameter key=\"PosDouble\" value=\"#a\" />"), 7, "no plain number");
    expect_note(parameters("<parameter key=\"PosDouble\" value=\"1\" /><parameter "
                           "key=\"PosDouble\" value=\"2\" />"),
                7, "given 2 times");
    expect_note(definition("",
                           "<special><inout><inoutzone/>\n<inoutzone><convertfluid "
                           "value=\"1\"/></inoutzone></inout></special>"),
                7, "<convertfluid>: v5.4's solver refuses it");
    expect_note(definition("", "<special><boundcorr/></special>"), 6, "refuses it");
    expect_note(definition("<setshapemode>real<!-- c --></setshapemode>\n"), 4, "has a comment");
    // One that is switched off has no effect.
    const std::string off =
        parameters("<parameter key=\"PartsOutMax\" value=\"0.9\" active=\"false\" />");
    EXPECT_TRUE(upgrade(off).notes.empty());
}

TEST(Upgrade, MovesTheMkOfAccelerationsIntoAnAttribute)
{
    const auto special = [](const std::string& inside)
    { return definition("", "<special><accinputs>\n" + inside + "</accinputs></special>\n"); };
    expect_upgrade(special("  <accinput>\n    <mkfluid value=\"0\" comment=\"c\" />\n"
                           "    <datafile value=\"a.csv\" />\n  </accinput>\n"),
                   special("  <accinput mkfluid=\"0\">\n    <acctimesfile value=\"a.csv\" />\n"
                           "  </accinput>\n"));
    expect_note(special("<accinput mkfluid=\"1\"><mkfluid value=\"0\" /></accinput>\n"), 7,
                "attribute of <accinput>");
}

TEST(Upgrade, MovesTheThreadsOfChrono)
{
    const auto special = [](const std::string& inside)
    { return definition("", "<special>\n<chrono>\n" + inside + "</chrono></special>\n"); };
    const std::string old =
        "  <collision activate=\"true\">\n    <distancedp value=\"0.5\" />\n"
        "    <ompthreads value=\"2\" />\n  </collision>\n";
    expect_upgrade(special(old), special("  <collision activate=\"true\">\n"
                                         "    <distancedp value=\"0.5\" />\n  </collision>\n"
                                         "  <ompthreads value=\"2\" />\n"));
    expect_upgrade(special("<ompthreads value=\"1\" /><collision activate=\"1\"><ompthreads "
                           "value=\"2\" /></collision>\n"),
                   special("<ompthreads value=\"1\" /><collision activate=\"1\"><_ompthreads "
                           "value=\"2\" /></collision>\n"));
    // Not looked at.
    const std::string idle = special("<collision><ompthreads value=\"2\" /></collision>\n");
    expect_upgrade(idle, idle);
}

TEST(Upgrade, RefusesWhatIsNoDefinition)
{
    const auto message = [](const std::string& text) -> std::string
    {
        try
        {
            upgrade_definition(text, "A_Def.xml");
        }
        catch (const CaseError& error)
        {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message("<case>\n<casedef>\n</case>"),
              "A_Def.xml:3: </case> closes nothing, expected </casedef>");
    EXPECT_EQ(message("<case>\n<casedef>\n"), "A_Def.xml:2: <casedef>: is not closed");
    EXPECT_EQ(message("<case>\n<a b=\"1></a></case>"),
              "A_Def.xml:2: <a>: the value of attribute 'b' is not closed");
    EXPECT_EQ(message("<case><a b=1/></case>"),
              "A_Def.xml:1: <a>: the value of attribute 'b' has no quotes");
    EXPECT_EQ(message("<case><!-- </case>"), "A_Def.xml:1: the comment is not closed");
    EXPECT_EQ(message("<cas></cas>"), "A_Def.xml:1: the root element is <cas>, expected <case>");
    EXPECT_EQ(message(""), "A_Def.xml: there is no element, expected the root <case>");
    EXPECT_NE(message(std::string("<case>") +
                      []
                      {
                          std::string deep;
                          for (int i = 0; i < 300; ++i) deep += "<a>";
                          return deep;
                      }())
                  .find("nested more than 200 deep"),
              std::string::npos);
}

TEST(Upgrade, LeavesDefinitionsInTheFormsOfV54)
{
    namespace fs = std::filesystem;
    std::size_t count = 0;
    for (const char* folder : {"xml-templates", "cases"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(FPPG_SOURCE) / folder))
        {
            if (!entry.path().string().ends_with("_Def.xml")) continue;
            // These show old names.
            const std::string name = entry.path().filename().string();
            if (name == "ConstantsOld_Def.xml" || name == "MotionFiles_Def.xml" ||
                name == "Parameters_Def.xml" || name == "NormalsOld_Def.xml")
                continue;
            const std::string text = read_text(entry.path().string());
            const UpgradedDefinition out = upgrade_definition(text, entry.path().string());
            for (const UpgradeChange& change : out.changes)
                ADD_FAILURE() << entry.path() << ":" << change.line << ": " << change.from;
            EXPECT_EQ(out.text, text);
            ++count;
        }
    EXPECT_GT(count, 50U);
}

} // namespace
