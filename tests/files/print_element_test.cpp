#include "fppg/element.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <tinyxml2.h>

namespace fppg
{

namespace
{

Element tag(std::string name)
{
    Element element;
    element.name = std::move(name);
    return element;
}

TEST(PrintElement, ClosesAnEmptyElementAtOnce)
{
    Element a = tag("a");
    a.set_attribute("x", "1");
    EXPECT_EQ(print_element(a, 1), "    <a x=\"1\" />\n");
}

TEST(PrintElement, KeepsTextInline)
{
    Element a = tag("a");
    a.text = "top | left";
    EXPECT_EQ(print_element(a, 0), "<a>top | left</a>\n");
}

TEST(PrintElement, IndentsChildrenAndComments)
{
    Element comment;
    comment.kind = Element::Kind::Comment;
    comment.text = " why ";
    Element a = tag("a");
    a.children = {comment, tag("b")};
    EXPECT_EQ(print_element(a, 0), "<a>\n    <!-- why -->\n    <b />\n</a>\n");
}

TEST(PrintElement, EscapesWhatWouldBeMarkup)
{
    Element a = tag("a");
    a.set_attribute("x", "1<2 & \"3\"\n");
    a.text = "a<b & \"c\"";
    EXPECT_EQ(print_element(a, 0),
              "<a x=\"1&lt;2 &amp; &quot;3&quot;&#10;\">a&lt;b &amp; \"c\"</a>\n");
}

RC_GTEST_PROP(PrintElement, ReadsBackTheSame, ())
{
    const auto text = rc::gen::container<std::string>(
        rc::gen::oneOf(rc::gen::inRange<char>(32, 126), rc::gen::elementOf(std::string("\n\t\r"))));
    Element a = tag("a");
    a.set_attribute("x", *text);
    a.text = "[" + *text + "]";
    const std::string printed = print_element(a, 0);
    tinyxml2::XMLDocument document;
    RC_ASSERT(document.Parse(printed.c_str()) == tinyxml2::XML_SUCCESS);
    RC_ASSERT(document.RootElement()->Attribute("x") == *a.find_attribute("x"));
    RC_ASSERT(document.RootElement()->GetText() == a.text);
}

} // namespace

} // namespace fppg
