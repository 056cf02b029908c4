#include "casedef/xml_document.h"

#include "fppg/error.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

std::string error_of(const std::string& text)
{
    try
    {
        parse_xml(text, "a.xml");
    }
    catch (const CaseError& error)
    {
        return error.what();
    }
    return "no error";
}

TEST(ParseXml, SkipsACommentBeforeTheDeclaration)
{
    const Element root =
        parse_xml("<!-- made by\n a tool -->\n<?xml version=\"1.0\"?>\n<case a=\"1\"/>", "a.xml");
    EXPECT_EQ(root.name, "case");
    EXPECT_EQ(root.line, 4);
}

TEST(ParseXml, SkipsAByteOrderMarkAlsoBeforeAComment)
{
    EXPECT_EQ(parse_xml("\xEF\xBB\xBF<?xml version=\"1.0\"?><case/>", "a.xml").name, "case");
    EXPECT_EQ(parse_xml("\xEF\xBB\xBF<!-- x --><?xml version=\"1.0\"?><case/>", "a.xml").name,
              "case");
    EXPECT_EQ(parse_xml("\xEF\xBB\xBF<case/>", "a.xml").name, "case");
}

TEST(ParseDocument, KeepsWhatStandsAroundTheRoot)
{
    const Element document = parse_document(
        "<!-- a --><?xml version=\"1.0\"?><!-- b --><case/>tail<!-- c --><other/>", "a.xml");
    ASSERT_EQ(document.children.size(), 5u);
    EXPECT_EQ(document.children[0].text, " a ");
    EXPECT_EQ(document.children[1].text, " b ");
    EXPECT_EQ(root_of(document).name, "case");
    EXPECT_EQ(document.children[4].name, "other");
}

TEST(ParseXml, KeepsTextsInTheirPlaceAndCondensesBlanks)
{
    const Element root = parse_xml(
        "<case>  one \n two <a/> three<!-- c -->\tfour  <b/>  <![CDATA[ a  b ]]></case>", "a.xml");
    EXPECT_EQ(root.text, "one two");
    ASSERT_EQ(root.children.size(), 3u);
    EXPECT_EQ(root.children[0].tail, "three");
    EXPECT_EQ(root.children[1].tail, "four");
    EXPECT_EQ(root.children[2].tail, " a  b ");
}

TEST(ParseXml, TakesTextThatIsNotUtf8AsLatin1)
{
    EXPECT_EQ(parse_xml("<case a=\"\xE9\"/>", "a.xml").attributes[0].value, "\xC3\xA9");
    EXPECT_EQ(parse_xml("<case a=\"\xC3\xA9\"/>", "a.xml").attributes[0].value, "\xC3\xA9");
    EXPECT_EQ(parse_xml("<case a=\"\xC3\xA9 \xE9\"/>", "a.xml").attributes[0].value.size(), 7u);
}

TEST(ParseXml, CountsLinesWithBothKindsOfLineEnds)
{
    const Element crlf =
        parse_xml("<?xml version=\"1.0\"?>\r\n<case>\r\n\r\n<b/>\r\n</case>\r\n", "a.xml");
    const Element lf = parse_xml("<?xml version=\"1.0\"?>\n<case>\n\n<b/>\n</case>\n", "a.xml");
    ASSERT_EQ(crlf.children.size(), 1u);
    EXPECT_EQ(crlf.children[0].line, 4);
    EXPECT_EQ(lf.children[0].line, 4);
}

TEST(ParseXml, KeepsAttributesChildrenCommentsAndTextInOrder)
{
    const Element root =
        parse_xml("<case z=\"1\" a=\"&lt;2&gt;\"><!-- c --><b> some text </b></case>", "a.xml");
    ASSERT_EQ(root.attributes.size(), 2u);
    EXPECT_EQ(root.attributes[0].name, "z");
    EXPECT_EQ(root.attributes[1].value, "<2>");
    ASSERT_EQ(root.children.size(), 2u);
    EXPECT_EQ(root.children[0].kind, Element::Kind::Comment);
    EXPECT_EQ(root.children[1].text, "some text");
}

TEST(ParseXml, NamesTheLineWhereTheXmlBreaks)
{
    EXPECT_EQ(error_of("<case>\n<a>\n</b>\n</case>").rfind("a.xml:", 0), 0u);
    EXPECT_NE(error_of("<case>\n<a>\n</b>\n</case>").find("this is not well-formed XML"),
              std::string::npos);
    EXPECT_NE(error_of("<case").find("this is not well-formed XML"), std::string::npos);
    EXPECT_NE(error_of("<case a/>").find("this is not well-formed XML"), std::string::npos);
    EXPECT_NE(error_of("<case a=\"1\" a=\"2\"/>").find("this is not well-formed XML"),
              std::string::npos);
}

// All tried with GenCase v5.4.354.
TEST(ParseXml, TakesWhatTheParserOfGenCaseTakes)
{
    const Element root = parse_xml(
        "<?xml version=\"1.0\"?>\n<case a=1 b= 'x > y' c=\"p<q & r\"><!-- a -- b=c --><?tool "
        "<x>\n?>\n"
        "<d e=2/><f g=h></f></case>\nbehind <it>",
        "a.xml");
    EXPECT_EQ(*root.find_attribute("a"), "1");
    EXPECT_EQ(*root.find_attribute("b"), "x > y");
    EXPECT_EQ(*root.find_attribute("c"), "p<q & r");
    EXPECT_EQ(*root.find_child("d")->find_attribute("e"), "2");
    EXPECT_EQ(*root.find_child("f")->find_attribute("g"), "h");
    EXPECT_EQ(root.find_child("f")->line, 4);
    EXPECT_EQ(parse_xml("<a><![CDATA[x=<y>]]></a>", "a.xml").text, "x=<y>");
}

TEST(ParseXml, RefusesAnEmptyFile)
{
    EXPECT_NE(error_of("").find("the file is empty"), std::string::npos);
    EXPECT_NE(error_of(" \n ").find("the file is empty"), std::string::npos);
    EXPECT_NE(error_of("<!-- nothing -->").find("there is no element"), std::string::npos);
}

TEST(ParseXml, RefusesEndlessNesting)
{
    std::string text;
    for (int i = 0; i < 400; ++i) text += "<a>";
    for (int i = 0; i < 400; ++i) text += "</a>";
    EXPECT_NE(error_of(text), "no error");
}

TEST(ReadXml, SaysWhichFileCannotBeRead)
{
    try
    {
        read_xml("/nowhere/Case_Def.xml");
        FAIL();
    }
    catch (const IoError& error)
    {
        EXPECT_NE(std::string(error.what()).find("/nowhere/Case_Def.xml: cannot open the file"),
                  std::string::npos);
    }
}

} // namespace
} // namespace fppg
