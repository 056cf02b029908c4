#include "casedef/variables.h"

#include <gtest/gtest.h>

namespace
{

using namespace fppg;

double number(const Variables& vars, const char* name)
{
    return std::get<double>(vars.find(name).value());
}

std::string error_of(auto&& action)
{
    try
    {
        action();
    }
    catch (const ExpressionError& error)
    {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

std::string exported_names(const Variables& vars)
{
    std::string names;
    for (const Variable& v : vars.exported()) names += (names.empty() ? "" : " ") + v.name;
    return names;
}

/// The variables of the experiments with delvar and exportvar.
Variables sample()
{
    Variables vars;
    vars.predefine("VResId", 0.0, true);
    vars.predefine("Dp", 0.1);
    vars.define_number("A", "1");
    vars.define_number("AB", "2");
    vars.define_number("ABC", "3");
    vars.define_number("B", "4");
    vars.define_number("b", "5");
    vars.define_number("K", "1", true);
    vars.define_text("Ts", "x");
    return vars;
}

TEST(NewVar, AllowsTheSameValueAgainAndNoOther)
{
    Variables vars;
    vars.define_number("A", "1");
    EXPECT_NO_THROW(vars.define_number("A", "0+1"));
    EXPECT_THROW(vars.define_number("A", "1.000000000000001"), ExpressionError);
    EXPECT_EQ(number(vars, "A"), 1);
}

TEST(NewVar, RefusesAnotherTypeOrConstancyOfAnExistingName)
{
    Variables vars;
    vars.define_number("A", "1");
    EXPECT_THROW(vars.define_text("A", "1"), ExpressionError);
    EXPECT_THROW(vars.define_number("A", "1", true), ExpressionError);
    vars.predefine("Dp", 0.1);
    EXPECT_THROW(vars.define_number("Dp", "0.1"), ExpressionError);
}

TEST(NewVar, TellsUpperFromLowerCase)
{
    Variables vars;
    vars.predefine("Dp", 0.1);
    vars.define_number("dp", "0.2");
    EXPECT_EQ(number(vars, "dp"), 0.2);
    EXPECT_EQ(number(vars, "Dp"), 0.1);
}

TEST(NewVar, RefusesReservedAndIllFormedNames)
{
    Variables vars;
    for (const char* name : {"e", "E", "true", "True", "false", "all", "All", "none", "a.b", "a-b",
                             "a:b", "\xc3\xa9", ""})
        EXPECT_THROW(vars.define_number(name, "1"), ExpressionError) << name;
    for (const char* name : {"sin", "pi", "F", "E1", "e5", "not", "_", "rem", "eval", "_if"})
        EXPECT_NO_THROW(vars.define_number(name, "1")) << name;
}

TEST(NewVar, LeavesTextAndNumberVariablesOfFunctionNamesUsable)
{
    Variables vars;
    vars.define_number("sin", "2");
    EXPECT_EQ(evaluate_expression("sin+sin(0)", vars), 2);
}

TEST(NewVar, TakesAnExpressionWithOrWithoutHash)
{
    Variables vars;
    vars.define_number("A", " 1 + 2 ");
    vars.define_number("B", "# A+1");
    EXPECT_EQ(number(vars, "B"), 4);
    EXPECT_THROW(vars.define_number("C", ""), ExpressionError);
}

TEST(SetVar, NeedsAVariableOfItsTypeThatIsNotConstant)
{
    Variables vars;
    vars.define_number("A", "1");
    vars.define_number("K", "1", true);
    vars.define_text("S", "1");
    vars.define_text("C", "2", true);
    EXPECT_TRUE(contains(error_of([&] { vars.set_number("Z", "1"); }), "does not exist"));
    EXPECT_TRUE(contains(error_of([&] { vars.set_number("K", "1"); }), "is constant"));
    EXPECT_TRUE(contains(error_of([&] { vars.set_number("S", "2"); }), "numeric variable"));
    EXPECT_TRUE(contains(error_of([&] { vars.set_text("A", "2"); }), "text variable"));
    EXPECT_TRUE(contains(error_of([&] { vars.set_text("C", "3"); }), "is constant"));
    vars.set_number("A", "A+4");
    EXPECT_EQ(number(vars, "A"), 5);
}

TEST(Variables, KnowWhichAttributesAreVariables)
{
    EXPECT_FALSE(Variables::is_variable_attribute("_rem"));
    EXPECT_FALSE(Variables::is_variable_attribute("_print"));
    EXPECT_FALSE(Variables::is_variable_attribute("if"));
    EXPECT_TRUE(Variables::is_variable_attribute("_Print"));
    EXPECT_TRUE(Variables::is_variable_attribute("_if"));
}

TEST(DelVar, TakesNamesAndPatterns)
{
    const auto left = [](const char* patterns)
    {
        Variables vars = sample();
        vars.erase(patterns);
        return exported_names(vars);
    };
    EXPECT_EQ(left("A"), "Ts AB ABC B K VResId b");
    EXPECT_EQ(left("A*"), "Ts B K VResId b");
    EXPECT_EQ(left("A?"), "Ts A ABC B K VResId b");
    EXPECT_EQ(left("A, B"), "Ts AB ABC K VResId b");
    EXPECT_EQ(left("A*C"), "Ts A AB B K VResId b");
    EXPECT_EQ(left("A B"), "Ts A ABC B K VResId b");
    EXPECT_EQ(left("?"), "Ts AB ABC VResId");
    EXPECT_EQ(left("**"), "");
    EXPECT_EQ(left("Zz*"), "Ts A AB ABC B K VResId b");
    EXPECT_EQ(left(","), "Ts A AB ABC B K VResId b");
}

TEST(DelVar, RefusesUnknownNamesAndChangesNothingThen)
{
    Variables vars = sample();
    EXPECT_THROW(vars.erase("A,Zz"), ExpressionError);
    EXPECT_THROW(vars.erase("-A"), ExpressionError);
    EXPECT_THROW(vars.erase("all"), ExpressionError);
    EXPECT_TRUE(vars.find("A").has_value());
}

TEST(DelVar, RemovesPredefinedVariablesToo)
{
    Variables vars = sample();
    vars.erase("Dp");
    EXPECT_FALSE(vars.find("Dp").has_value());
}

TEST(VarsSave, RestoresValuesAdditionsAndDeletions)
{
    Variables vars;
    vars.define_number("A", "1");
    vars.save();
    vars.set_number("A", "2");
    vars.define_number("B", "3");
    vars.save();
    vars.erase("A");
    vars.load();
    EXPECT_EQ(number(vars, "A"), 2);
    vars.load();
    EXPECT_EQ(number(vars, "A"), 1);
    EXPECT_FALSE(vars.find("B").has_value());
}

TEST(VarsSave, LoadingAnEmptyStackChangesNothing)
{
    Variables vars;
    vars.define_number("A", "1");
    vars.load();
    EXPECT_EQ(number(vars, "A"), 1);
}

TEST(ExportVar, GivesTextsFirstAndSortedNamesAndOnlyOwnVariables)
{
    const std::string all = "Ts A AB ABC B K VResId b";
    EXPECT_EQ(exported_names(sample()), all);
    const auto chosen = [](std::initializer_list<const char*> commands)
    {
        Variables vars = sample();
        for (const char* patterns : commands) vars.choose_exported(patterns);
        return exported_names(vars);
    };
    EXPECT_EQ(chosen({"all"}), all);
    EXPECT_EQ(chosen({""}), all);
    EXPECT_EQ(chosen({"*"}), all);
    EXPECT_EQ(chosen({"-A,all"}), all);
    EXPECT_EQ(chosen({"-all,Dp"}), "");
    EXPECT_EQ(chosen({"Dp"}), "");
    EXPECT_EQ(chosen({"-A"}), "Ts AB ABC B K VResId b");
    EXPECT_EQ(chosen({"-ALL, A , B"}), "A B");
    EXPECT_EQ(chosen({"-all,A*,-AB"}), "A ABC");
    EXPECT_EQ(chosen({"-all,A,-A"}), "");
    EXPECT_EQ(chosen({"-all,A", "B"}), "A B");
    EXPECT_EQ(chosen({"-all,A", "-all,B"}), "B");
    EXPECT_EQ(chosen({"A", "-B"}), "A");
    EXPECT_EQ(chosen({"all,-Dp,-VResId"}), "Ts A AB ABC B K b");
}

TEST(ExportVar, ChoosesFromTheVariablesThatExist)
{
    for (const char* patterns : {"-all,A,K", "-B", "all", "*"})
    {
        Variables vars = sample();
        vars.choose_exported(patterns);
        const std::string before = exported_names(vars);
        vars.define_number("A9", "1", false);
        EXPECT_EQ(exported_names(vars), before) << patterns;
        vars.choose_exported("A9");
        EXPECT_NE(exported_names(vars), before) << patterns;
    }
    Variables vars = sample();
    vars.choose_exported("");
    vars.define_number("A9", "1", false);
    EXPECT_EQ(exported_names(vars), "Ts A A9 AB ABC B K VResId b");
}

TEST(ExportVar, GivesTheValuesOfTheEnd)
{
    Variables vars = sample();
    vars.choose_exported("-all,A");
    vars.set_number("A", "77");
    EXPECT_EQ(std::get<double>(vars.exported().at(0).value), 77);
}

TEST(ExportVar, RefusesANameNotYetDefinedUnlessItIsTakenOut)
{
    Variables vars = sample();
    EXPECT_THROW(vars.choose_exported("-all,Zz"), ExpressionError);
    EXPECT_NO_THROW(vars.choose_exported("-all,A,-Zz,Zz*"));
}

TEST(ExportVar, HasOnlyVResIdInACaseWithoutVariables)
{
    Variables vars;
    vars.predefine("VResId", 0.0, true);
    vars.predefine("Dp", 0.1);
    EXPECT_EQ(exported_names(vars), "VResId");
}

TEST(Interpolate, PrintsSixDigitsAndTextVariables)
{
    Variables vars;
    vars.predefine("Dp", 0.05);
    vars.define_text("Text1", "Hello", true);
    vars.define_text("Text2", "bye", true);
    EXPECT_EQ(vars.interpolate("[Text1][Text2]_[Dp*100]"), "Hellobye_5");
    EXPECT_EQ(vars.interpolate("[1/3] [1e-5] [123456789] [100000] [1e+20] [-0.0] [2.50]"),
              "0.333333 1e-05 1.23457e+08 100000 1e+20 -0 2.5");
    EXPECT_EQ(vars.interpolate("%d \\n [Dp]%"), "%d \\n 0.05%");
}

TEST(Interpolate, ReplacesInnerBracketsFirstAsText)
{
    Variables vars;
    vars.define_number("x1", "11");
    vars.define_number("x2", "22");
    vars.define_number("x12", "5");
    vars.define_number("x1y", "7");
    vars.define_text("s", "1");
    vars.define_text("s2", "bye");
    EXPECT_EQ(vars.interpolate("[x[1]] [x[1+1]] [x[1]+x[x[1]-9]]"), "11 22 33");
    EXPECT_EQ(vars.interpolate("[x[s]] [x[1]y] [x[1][2]] [s[1+1]] [1+[1]]"), "11 7 5 bye 2");
    EXPECT_EQ(vars.interpolate("[x[1.9999999]]"), "22");
}

TEST(Interpolate, KeepsBracketsThatHoldNothingOrHaveNoPartner)
{
    Variables vars;
    vars.define_number("x1", "11");
    EXPECT_EQ(vars.interpolate("a]b"), "a]b");
    EXPECT_EQ(vars.interpolate("a[b"), "a[b");
    EXPECT_EQ(vars.interpolate("a[]b"), "a[]b");
    EXPECT_EQ(vars.interpolate("[x[1]"), "[x1");
    EXPECT_EQ(vars.interpolate("a[[x1]]b"), "a11b");
}

TEST(Interpolate, RefusesBlanksAndTextInExpressions)
{
    Variables vars;
    vars.predefine("Dp", 0.1);
    vars.define_text("s", "5");
    EXPECT_EQ(vars.interpolate("[s]"), "5");
    EXPECT_THROW(vars.interpolate("[ Dp ]"), ExpressionError);
    EXPECT_THROW(vars.interpolate("[s+1]"), ExpressionError);
    EXPECT_THROW(vars.interpolate("[(s)]"), ExpressionError);
}

TEST(Interpolate, ReadsNamesBeginningWithUnderscoreOnlyAsAWhole)
{
    Variables vars;
    vars.define_number("_a", "1");
    EXPECT_EQ(vars.interpolate("[_a]"), "1");
    EXPECT_THROW(vars.interpolate("[_a+1]"), ExpressionError);
}

TEST(DescribeAll, KeepsTheOrderOfDefinitionAndMarksConstantsAndTexts)
{
    Variables vars;
    vars.predefine("Rhop0", 1000.0);
    vars.define_number("Zed", "28.11", true);
    vars.define_text("Tt", "a[Zed]", true);
    vars.define_number("Q", "1/3");
    vars.define_text("S", "w");
    vars.predefine("Dp", 0.1);
    EXPECT_EQ(vars.describe_all(),
              "Rhop0=[1000]  Zed=[28.11]  Tt=[\"a28.11\"]  Q=0.333333  S=\"w\"  Dp=[0.1]");
}

} // namespace
