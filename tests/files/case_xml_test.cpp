#include "files/helpers.h"
#include "fppg/error.h"

#include <tinyxml2.h>

namespace fppg
{

namespace
{

Element tree_of(const tinyxml2::XMLElement& xml)
{
    Element element;
    element.name = xml.Name();
    for (const auto* a = xml.FirstAttribute(); a; a = a->Next())
        element.attributes.push_back({a->Name(), a->Value()});
    if (xml.GetText()) element.text = xml.GetText();
    for (const auto* child = xml.FirstChildElement(); child; child = child->NextSiblingElement())
        element.children.push_back(tree_of(*child));
    return element;
}

Element parse(const std::string& text)
{
    tinyxml2::XMLDocument document;
    if (document.Parse(text.c_str()) != tinyxml2::XML_SUCCESS)
        throw std::runtime_error(document.ErrorStr());
    return tree_of(*document.RootElement());
}

/// Definition, particles and constants of a case; case_xml() writes it.
struct SmallCase
{
    SmallCase()
    {
        def.mk_bound_first = 10;
        def.casedef = parse("<casedef><mkconfig boundcount=\"240\" fluidcount=\"9\"/></casedef>");
        def.user_variables = {{"VResId", false, 0, ""}};
        particles.pos_max = {2.1, 0.25, 1.4};
        FloatingBody body;
        body.block = 2;
        body.mass_body = 24;
        body.mass_part = 6;
        body.center = {0.45, 0.25, 0.1 + 0.2};
        body.inertia = {Vec3{1, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 3}};
        particles.floatings.push_back(body);
    }
    CaseDef def;
    CaseParticles particles = small_particles();
    CaseConstants constants = small_constants();

    std::string case_xml() const
    {
        return written(
            [&](OutputFile& file)
            {
                write_case_xml(file, def, particles, constants,
                               {{"c_a_Dp.vtk", "1,10", "0", "0"}, {"c_b_Dp.vtk", "10", "0", ""}},
                               {"Maker", "01-02-2026 03:04:05", "c"});
            });
    }
    Element execution() const { return *parse(case_xml()).find_child("execution"); }
};

TEST(WriteCaseXml, RepeatsTheDefinitionAndAddsTheExecution)
{
    const std::string expected = R"xml(<?xml version="1.0" encoding="UTF-8" ?>
<case app="Maker" date="01-02-2026 03:04:05">
    <casedef>
        <mkconfig boundcount="240" fluidcount="9" />
    </casedef>
    <execution>
        <particles np="23" nb="9" nbf="3" mkboundfirst="10" mkfluidfirst="1">
            <_summary>
                <positions units_comment="metres (m)">
                    <posmin x="0" y="0" z="0" />
                    <posmax x="2.1" y="0.25" z="1.4" />
                </positions>
                <fixed count="3" id="0-2" mkcount="1" mkvalues="10" />
                <moving count="2" id="3-4" mkcount="1" mkvalues="11" />
                <floating count="4" id="5-8" mkcount="1" mkvalues="15" />
                <fluid count="14" id="9-22" mkcount="2" mkvalues="1-2" />
            </_summary>
            <fixed mkbound="0" mk="10" begin="0" count="3" />
            <moving mkbound="1" mk="11" begin="3" count="2" refmotion="0" />
            <floating mkbound="5" mk="15" begin="5" count="4">
                <massbody value="24" units_comment="kg" />
                <masspart value="6" units_comment="kg" />
                <center x="0.45" y="0.25" z="0.30000000000000004" units_comment="metres (m)" />
                <inertia x="1" y="2" z="3" units_comment="kg*m^2" />
            </floating>
            <fluid mkfluid="0" mk="1" begin="9" count="8" />
            <fluid mkfluid="1" mk="2" begin="17" count="6" />
        </particles>
        <constants>
            <data2d value="false" />
            <gravity x="0" y="0" z="-9.81" units_comment="m/s^2" />
            <cflnumber value="0.2" />
            <gamma value="7" />
            <rhop0 value="999" units_comment="kg/m^3" />
            <dp value="0.1" units_comment="metres (m)" />
            <h value="0.17320508075688773" units_comment="metres (m)" />
            <b value="100000.5" units_comment="Pascal (Pa)" />
            <massbound value="0.999" units_comment="kg" />
            <massfluid value="0.999" units_comment="kg" />
        </constants>
        <uservars>
            <varnum name="VResId" value="0" />
        </uservars>
        <motion />
        <vtkout mkboundfirst="10" mkfluidfirst="1">
            <vtkfile name="c_a_Dp.vtk" mk="1,10" mkbound="0" mkfluid="0" />
            <vtkfile name="c_b_Dp.vtk" mk="10" mkbound="0" />
        </vtkout>
    </execution>
</case>
)xml";
    EXPECT_EQ(SmallCase().case_xml(), expected);
}

TEST(WriteCaseXml, DeclaresThePrefixOfOwnAttributes)
{
    SmallCase small;
    EXPECT_EQ(small.case_xml().find("xmlns"), std::string::npos);
    small.def.casedef = parse("<casedef><a><drawfilestl fppg:fill=\"inside\"/></a></casedef>");
    EXPECT_NE(small.case_xml().find(" xmlns:fppg=\"urn:fppg\""), std::string::npos);
}

TEST(WriteCaseXml, KeepsTheYOfATwoDimensionalCaseExactly)
{
    SmallCase small;
    small.constants.is_2d = true;
    small.constants.y_2d = 0.12345678901234567;
    const Element execution = small.execution();
    const Element* constants = execution.find_child("constants");
    EXPECT_EQ(*constants->find_child("data2d")->find_attribute("value"), "true");
    EXPECT_EQ(std::stod(*constants->find_child("data2dposy")->find_attribute("value")),
              0.12345678901234567);
}

TEST(WriteCaseXml, CompletesTheSimulationDomain)
{
    for (const std::string given : {"", "<simulationdomain><posmin x=\"0.5\"/></simulationdomain>"})
    {
        SmallCase small;
        small.def.execution = {parse("<parameters>" + given + "</parameters>")};
        const Element execution = small.execution();
        const Element* domain = execution.children.at(0).find_child("simulationdomain");
        ASSERT_NE(domain, nullptr);
        EXPECT_EQ(*domain->find_child("posmin")->find_attribute("x"),
                  given.empty() ? "default" : "0.5");
        EXPECT_EQ(*domain->find_child("posmax")->find_attribute("z"), "default");
    }
}

TEST(WriteCaseXml, PutsASecondBlockOfParametersBeforeTheFirst)
{
    SmallCase small;
    small.def.execution = {parse("<parameters><parameter key=\"A\" value=\"1\"/></parameters>"),
                           parse("<parameters><parameter key=\"B\" value=\"2\"/></parameters>")};
    const Element execution = small.execution();
    const Element& joined = execution.children.at(0);
    EXPECT_EQ(execution.children.at(1).name, "particles");
    ASSERT_EQ(joined.children.size(), 3u);
    EXPECT_EQ(*joined.children[0].find_attribute("key"), "B");
    EXPECT_EQ(*joined.children[1].find_attribute("key"), "A");
}

TEST(WriteCaseXml, MarksDeprecatedParametersAndJoinsRepeatedOnes)
{
    SmallCase small;
    small.def.execution = {parse(
        "<parameters><parameter key=\"IncZ\" value=\"1\" comment=\"up\"/><parameter key=\"TimeMax\""
        " value=\"2\"/><parameter key=\"DomainFixedXmin\" value=\"0\"/><parameter key=\"IncZ\""
        " value=\"3\" comment=\"**DEPRECATED** again\"/></parameters>")};
    const Element execution = small.execution();
    const std::vector<Element>& parameters = execution.children[0].children;
    ASSERT_EQ(parameters.size(), 4U);
    EXPECT_EQ(*parameters[0].find_attribute("value"), "3");
    EXPECT_EQ(*parameters[0].find_attribute("comment"), "**DEPRECATED** again");
    EXPECT_EQ(parameters[1].find_attribute("comment"), nullptr);
    EXPECT_EQ(*parameters[2].find_attribute("comment"), "**DEPRECATED** ");
}

TEST(WriteCaseXml, WritesTheFullInertiaWhereAnEntryIsOffTheDiagonal)
{
    SmallCase small;
    small.particles.floatings[0].inertia[0].y = -0.5;
    const Element execution = small.execution();
    const Element* inertia =
        execution.find_child("particles")->find_child("floating")->find_child("inertia");
    ASSERT_EQ(inertia->children.size(), 3U);
    EXPECT_EQ(*inertia->children[0].find_attribute("v12"), "-0.5");
    EXPECT_EQ(*inertia->children[2].find_attribute("v33"), "3");
}

TEST(WriteCaseXml, WritesWhatRestrictsAFloatingBody)
{
    SmallCase small;
    FloatingDef floating;
    floating.mkbound = {4, 5};
    floating.extra = {parse("<linearvelini x=\"1\" y=\"0\" z=\"0\"/>"),
                      parse("<translationDOF x=\"0\" y=\"1\" z=\"1\"/>")};
    small.def.floatings = {floating};
    const Element execution = small.execution();
    const Element* body = execution.find_child("particles")->find_child("floating");
    ASSERT_EQ(body->children.size(), 6U);
    EXPECT_EQ(body->children[4].name, "translationDOF");
    EXPECT_EQ(body->children[5].name, "linearvelini");
    EXPECT_EQ(*body->children[5].find_attribute("units_comment"), "m/s");
}

TEST(WriteCaseXml, LinksOnlyPropertiesInUse)
{
    SmallCase small;
    small.particles.blocks[0].property = "steel";
    small.particles.blocks[2].property = "steel+wood";
    small.particles.blocks[4].property = "steel";
    small.def.properties = parse(
        "<properties><property name=\"steel\"><a v=\"1\"/></property>"
        "<property name=\"clay\"/><property name=\"wood\"/></properties>");
    const Element execution = small.execution();
    const Element* particles = execution.find_child("particles");
    EXPECT_EQ(*particles->find_child("fixed")->find_attribute("property"), "steel");
    const Element* properties = particles->find_child("properties");
    ASSERT_NE(properties, nullptr);
    EXPECT_EQ(print_element(*properties, 0), R"(<properties>
    <links>
        <link mk="2,10" property="steel" />
        <link mk="15" property="steel+wood" />
    </links>
    <property name="steel">
        <a v="1" />
    </property>
    <property name="wood" />
</properties>
)");
}

TEST(WriteCaseXml, RewritesMotionForTheMovingBlocks)
{
    SmallCase small;
    small.def.motion = parse(R"(<motion>
        <objreal ref="99"><begin mov="1" start="0"/></objreal>
        <obj>
            <begin mov="1" start="0" comment="c"/>
            <mvrot id="1" duration="2"><axisp2 x="1"/><vel ang="3"/><axisp1 x="0"/></mvrot>
            <objreal ref="1">
                <begin mov="4" start="0.5" finish="1"/>
                <mvrectace id="4" duration="1" next="7"><ace x="1"/><velini x="0"/></mvrectace>
                <mvrect id="5" duration="1"/>
                <wait id="7" duration="1" next="4"/>
            </objreal>
        </obj></motion>)");
    const Element execution = small.execution();
    EXPECT_EQ(print_element(*execution.find_child("motion"), 0), R"(<motion>
    <obj>
        <begin mov="1" start="0" />
        <mvrot id="1" duration="2" anglesunits="degrees">
            <vel ang="3" units_comment="degrees/s" />
            <axisp1 x="0" />
            <axisp2 x="1" />
        </mvrot>
        <objreal ref="0">
            <begin mov="4" start="0.5" finish="1" />
            <mvrectace id="4" duration="1" next="7">
                <velini x="0" units_comment="m/s" />
                <ace x="1" units_comment="m/s^2" />
            </mvrectace>
            <wait id="7" duration="1" next="4" />
        </objreal>
    </obj>
</motion>
)");
}

TEST(WriteCaseXml, WritesUserVariablesOfBothKinds)
{
    SmallCase small;
    small.def.user_variables = {{"T", true, 0, "a & b"}, {"A", false, 1.0 / 3, ""}};
    const std::string text = small.case_xml();
    EXPECT_NE(text.find("<varstr name=\"T\" value=\"a &amp; b\" />"), std::string::npos);
    EXPECT_NE(text.find("<varnum name=\"A\" value=\"0.3333333333333333\" />"), std::string::npos);
}

TEST(FormatRanges, JoinsNeighboursAndSorts)
{
    EXPECT_EQ(format_ranges({}), "");
    EXPECT_EQ(format_ranges({20, 10, 11, 10}), "10-11,20");
    EXPECT_EQ(format_ranges({3, 1, 2, 7}), "1-3,7");
}

} // namespace

} // namespace fppg
