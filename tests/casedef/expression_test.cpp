#include "casedef/expression.h"
#include "casedef/variables.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace
{

using namespace fppg;

struct Recorded
{
    const char* expression;
    const char* value;
};

// Each was put into <printf text="[...]"/> of a case with dp 0.1 and pointmin -0.5 and run with
// GenCase v5.4.354.01, which prints six digits.
// clang-format off
constexpr Recorded recorded_values[] = {
    {"1e-2", "0.01"},
    {"1E+2", "100"},
    {"1e+2", "100"},
    {"1E-2", "0.01"},
    {"1.5e-3", "0.0015"},
    {"1.5e+3", "1500"},
    {"5.", "5"},
    {"1.", "1"},
    {"Dp", "0.1"},
    {"pi()", "3.14159"},
    {"e()", "2.71828"},
    {"true", "1"},
    {"True", "1"},
    {"TRUE", "1"},
    {"false", "0"},
    {"FALSE", "0"},
    {"pow(0,0)", "1"},
    {"exp(0-1000)", "0"},
    {"tan(pi()/2)", "1.63312e+16"},
    {"atan2(0,0)", "0"},
    {"float(3)", "3"},
    {"round(2.5)", "3"},
    {"round(0-2.5)", "-3"},
    {"round(0.49999999999999994)", "0"},
    {"int(2.7)", "2"},
    {"int(0-2.7)", "-2"},
    {"floor(0-2.5)", "-3"},
    {"ceil(0-2.5)", "-2"},
    {"ceil(0-0.5)", "-0"},
    {"abs(0-3)", "3"},
    {"fmod(0-7,3)", "-1"},
    {"fmodr(7,3)", "1"},
    {"fmodr(0-7,3)", "-1"},
    {"fmodr(7.5,2)", "2"},
    {"fmodr(8.7,3)", "3"},
    {"fmodr(7.5,2.6)", "2"},
    {"fmodr(7,0-3)", "1"},
    {"fmodr(0.3,0.1)", "0"},
    {"fmod(0.3,0.1)", "0.1"},
    {"fmod(7.5,2.6)", "2.3"},
    {"fmod(7,0-3)", "1"},
    {"eval(1,2,3)", "2"},
    {"eval(0,2,3)", "3"},
    {"eval(0.3,2,3)", "2"},
    {"eval(0-1,2,3)", "2"},
    {"min(1,2)", "1"},
    {"min(3,2,1)", "1"},
    {"min(3,2,1,0)", "0"},
    {"max(3,2,1)", "3"},
    {"max(1,2,3,4)", "4"},
    {"wavelength(9.81,1,2)", "5.21537"},
    {"wavelength(9.81,0,2)", "0"},
    {"wavelength(9.81,1,0)", "0"},
    {"roundpos(0.34,0,0.1)", "0.3"},
    {"roundpos(0.35,0,0.1)", "0.3"},
    {"roundpos(0-0.35,0,0.1)", "-0.3"},
    {"roundpos(0.34,0.02,0.1)", "0.32"},
    {"roundpos(0.34,0,0)", "0"},
    {"roundposx(0.34)", "0.3"},
    {"roundposy(0.36)", "0.4"},
    {"roundposz(0.35)", "0.4"},
    {"roundposx(0-5)", "-5"},
    {"roundposx(50)", "50"},
    {"sindg(30)", "0.5"},
    {"cosdg(60)", "0.5"},
    {"tandg(45)", "1"},
    {"sinh(1)", "1.1752"},
    {"cosh(1)", "1.54308"},
    {"tanh(1)", "0.761594"},
    {"asin(1)", "1.5708"},
    {"acos(0)", "1.5708"},
    {"atan(1)", "0.785398"},
    {"atan2(1,2)", "0.463648"},
    {"exp(1)", "2.71828"},
    {"log(2)", "0.693147"},
    {"log10(2)", "0.30103"},
    {"pow(2,3)", "8"},
    {"1+2*3", "7"},
    {"(1+2)*3", "9"},
    {"10-4-3", "3"},
    {"100/5/2", "10"},
    {"2*3/4", "1.5"},
    {"8/4*2", "4"},
    {"-1", "-1"},
    {"-2+3", "1"},
    {"3--2", "5"},
    {"2*-3", "-6"},
    {"2/-4", "-0.5"},
    {"--1", "1"},
    {"---1", "-1"},
    {"-(1+2)", "-3"},
    {"-Dp", "-0.1"},
    {"-pi()", "-3.14159"},
    {"2-1-1", "0"},
    {"1==1", "1"},
    {"1+1==2", "1"},
    {"2==1+1", "1"},
    {"2>1==1", "1"},
    {"1==2>1", "1"},
    {"1==2==0", "1"},
    {"3>2>1", "0"},
    {"3>2>0", "1"},
    {"1<2<3", "1"},
    {"0==0<1", "0"},
    {"1<0==0", "1"},
    {"1==0<1", "1"},
    {"2<1==0", "1"},
    {"0==1<2", "0"},
    {"1==1==2", "0"},
    {"2==2==1", "1"},
    {"3!=2==1", "1"},
    {"1!=1==0", "1"},
    {"1==0!=1", "1"},
    {"1||0", "1"},
    {"0||0", "0"},
    {"1||0==0", "1"},
    {"0==1||1", "1"},
    {"0==(1||1)", "0"},
    {"1==0||0", "0"},
    {"1==2||1", "1"},
    {"2||0", "1"},
    {"0.5||0", "1"},
    {"2>1||0", "1"},
    {"0||2>1", "1"},
    {"0>1||1", "1"},
    {"1+0||0", "1"},
    {"1||1+1", "1"},
    {"1+(1||1)", "2"},
    {"0*2||1", "1"},
    {"2*0||1", "1"},
    {"1||1*0", "1"},
    {"!0", "1"},
    {"!1", "0"},
    {"!2", "0"},
    {"!0.5", "0"},
    {"!Dp", "0"},
    {"!true", "0"},
    {"!1==0", "1"},
    {"!0==1", "1"},
    {"!1+1", "1"},
    {"!0+1", "2"},
    {"1+!0", "2"},
    {"1-!1", "1"},
    {"2*!0", "2"},
    {"!!1", "1"},
    {"!!3", "1"},
    {"!-1", "0"},
    {"-!0", "-1"},
    {"!(1==2)", "1"},
    {"!1||1", "1"},
    {"1<=1", "1"},
    {"1>=1", "1"},
    {"1<1", "0"},
    {"1>1", "0"},
    {"1!=1", "0"},
    {"((1))", "1"},
    {"abs(-1)", "1"},
    {"abs((1))", "1"},
    {"-abs(-1)", "-1"},
    {"2*-abs(-1)", "-2"},
    {"-2*-3", "6"},
    {"1-2*-3", "7"},
    {"2-3*4-5", "-15"},
    {"1+2>2", "1"},
    {"1>2+3", "0"},
    {"2*3==6", "1"},
    {"6==2*3", "1"},
    {"-1==-1", "1"},
    {"1==-1", "0"},
    {"1>-1", "1"},
    {"1-1==0", "1"},
    {"-1<0", "1"},
    {"1<-0", "0"},
    {"1>-2+1", "1"},
    {"5-3==2", "1"},
    {"5-3==1+1", "1"},
    {"1==1+0", "1"},
    {"1+1==1+1", "1"},
    {"1<2==2>1", "1"},
    {"1<2==(2>1)", "1"},
    {"Dp!=0.1==(1||0)", "0"},
    {"Dp==0.1", "1"},
    {"Dp*3==0.3", "0"},
    {"0.1+0.2==0.3", "0"},
    {"1/3==0.333333", "0"},
    {"0.1+0.2-0.3", "5.55112e-17"},
    {"1e-17+1==1", "1"},
    {"1000001==1000000", "0"},
    {"1.0000001==1", "0"},
    {"1.0000000001==1", "0"},
    {"1.0000001>1", "1"},
    {"1.00000000000000001==1", "1"},
    {"1.0000000000000002==1", "0"},
    {"1.0000000000000002>1", "1"},
    {"1.0000000000000002!=1", "1"},
    {"true||false", "1"},
    {"true+true", "2"},
    {"-true", "-1"},
    {"2==2!=2", "1"},
    {"2!=2==2", "0"},
    {"2>0<1", "0"},
    {"0.5<2>1", "0"},
    {"2>=0<1", "0"},
    {"0.5<=2>1", "0"},
    {"2>0<=0.5", "0"},
    {"1-2+3", "2"},
    {"!0==2", "0"},
    {"!0*2", "2"},
    {"!0<0.5", "0"},
    {"1e+300*1e+300", "inf"},
    {"0-1e+300*1e+300", "-inf"},
    {"5.e-1", "0.5"},
    {"5.e+1", "50"},
    {"abs(1,)", "1"},
    {"min(1,2,3,4,5)", "1"},
    {"max(1,2,3,4,5,6,7,8)", "8"},
    {"roundpos(-2.5,0,1)", "-3"},
    {"roundpos(2.5,0,1)", "3"},
    {"roundpos(-0.5,0,1)", "-1"},
    {"roundpos(0.34,0.02,0)", "0.02"},
    {"roundpos(2.5,0,0-1)", "3"},
    {"roundposx(0.351)", "0.4"},
    {"fmodr(-5.5,4)", "-2"},
    {"fmodr(5.5,4)", "2"},
    {"fmodr(5.99,3)", "3"},
    {"fmodr(2.5,1)", "1"},
    {"fmodr(-0.5,3)", "-1"},
    {"fmodr(5.9999999,3)", "3"},
    {"fmod(5.9999999,3)", "3"},
    {"fmodr(3.6,1.2)", "0"},
    {"fmodr(7,2.5)", "2"},
    {"fmodr(7,1.7)", "0"},
    {"fmodr(7,1.3)", "0"},
    {"round(1e+20)", "1e+20"},
    {"floor(1e+20)", "1e+20"},
    {"ceil(1e+20)", "1e+20"},
    {"round(3e+9)", "3e+09"},
    {"float(1/3)-1/3", "9.93411e-09"},
    {"(wavelength(9.81,1,2)-5.21537)*1e+6", "2.9314"},
    {"(wavelength(9.81,1,2)-5.215370)*1e+9", "2931.4"},
    {"(wavelength(9.81,0.3,5)-8.55)*1e+6", "-41504"},
    {"(wavelength(9.81,10,3)-14.05)*1e+6", "-1873.11"},
    {"wavelength(9.81,10,3)", "14.0481"},
    {"wavelength(9.81,0.3,5)", "8.5085"},
    {"wavelength(9.81,0.01,5)", "1.56563"},
    {"wavelength(9.81,0.001,20)", "1.98091"},
    {"wavelength(9.81,100,20)", "521.537"},
    {"wavelength(9.81,1,0-2)", "5.21537"},
    {"wavelength(0,1,2)", "0"},
    {"(sindg(30)-0.5)*1e+16", "-0.555112"},
    {"(cosdg(60)-0.5)*1e+16", "1.11022"},
    {"cosdg(90)", "6.12323e-17"},
    {"sindg(180)", "1.22465e-16"},
    {"sindg(360)", "-2.44929e-16"},
    {"tandg(45)-1", "-1.11022e-16"},
    {"tandg(180)", "-1.22465e-16"},
    {"cosdg(270)", "-1.83697e-16"},
    {"tandg(90)", "1.63312e+16"},
    {"sin(pi())", "1.22465e-16"},
    {"pi()-3.14159265358979", "3.10862e-15"},
    {"e()-2.71828182845904", "4.88498e-15"},
    {"(e()-2.71828182845904)*1e+16", "48.8498"},
    {"(pi()-3.14159265358979)*1e+17", "310.862"},
    {"(((((((((1)))))))))", "1"},
    {"123456789", "1.23457e+08"},
    {"0.000012345678", "1.23457e-05"},
    {"1234567.8", "1.23457e+06"},
    {"100000", "100000"},
    {"1000000", "1e+06"},
    {"00012", "12"},
    {"1e+0005", "100000"},
    {"1e-0", "1"},
    {"0-0", "0"},
    {"-0", "-0"},
    {"-0.0", "-0"},
    {"(0-1)*0", "-0"},
    {"abs(-0.0)", "0"},
    {"1e+308*10-1", "inf"},
    {"min(1,2,3,4,5,6,7,8,9)", "1"},
    {"min(1,2,3,4,5,6,7,8,9,10)", "1"},
    {"1e-310", "1e-310"},
    {"1e-300", "1e-300"},
    {"1e+308", "1e+308"},
    {"(wavelength(9.81,0.3,5)-8.5085)*1e+10", "-39767.2"},
    {"(wavelength(9.81,10,3)-14.0481)*1e+10", "268859"},
    {"(wavelength(9.81,0.01,5)-1.56563)*1e+10", "-41845.4"},
    {"(wavelength(9.81,0.001,20)-1.98091)*1e+10", "-44392.7"},
    {"(wavelength(9.81,100,20)-521.537)*1e+8", "29314"},
    {"(wavelength(9.81,1,2)-5.21537)*1e+12", "2.9314e+06"},
    {"(sindg(10)-0.173648)*1e+12", "177667"},
    {"(sindg(77)-0.97437)*1e+12", "64785.2"},
    {"(sindg(77)-0.97437-1e-7)*1e+16", "-3.52148e+08"},
    {"1e+10*1e+10", "1e+20"},
    {"pow(2,0.5)", "1.41421"},
    {"sqrt(2)*sqrt(2)==2", "0"},
    {"(-2)", "-2"},
    {"-(-2)", "2"},
    {"2-(-2)", "4"},
    {"!(1)", "0"},
    {"!-0", "1"},
    {"-!1", "-0"},
    {"2--!0", "3"},
    {"1!=!1", "1"},
    {"1==!0", "1"},
    {"1<!0", "0"},
    {"1||!1", "1"},
    {"!0||0", "1"},
    {"1E+2*2", "200"},
    {"3.*Dp", "0.3"},
    {"abs(-1)*-1", "-1"},
    {"eval(Dp==0.1,max(1,2),min(1,2))", "2"},
    {"max(1,2)+max(3,4)", "6"},
    {"pow(pow(2,2),2)", "16"},
    {"abs(abs(-3)-5)", "2"},
    {"min((1),(2+1)*2)", "1"},
    {"int(-0.5)", "0"},
    {"round(-0.4)", "-0"},
    {"floor(-0)", "-0"},
    {"atan2(-1,-1)", "-2.35619"},
    {"atan2(0,-1)", "3.14159"},
};

constexpr const char* recorded_refusals[] = {
    "1e5",
    "1E5",
    "1.5e3",
    ".5",
    ".",
    "1..2",
    "1.2.3",
    "1e",
    "1e+",
    "1e-",
    "1e1e1",
    "1ee3",
    "2e3.5",
    "1e-2e",
    "0x10",
    "1 2",
    "1 + 2",
    "12 3",
    "D p",
    "dp",
    "DP",
    "PI()",
    "Pi()",
    "pi ()",
    "pi( )",
    "pi",
    "e",
    "SIN(0)",
    "Sin(0)",
    "sqrt(-1)",
    "sqrt(0-1)",
    "log(0)",
    "log(0-1)",
    "log10(0)",
    "asin(2)",
    "acos(2)",
    "pow(0-8,1/3)",
    "pow(0,0-1)",
    "fmod(1,0)",
    "fmodr(1,0)",
    "1/0",
    "0/0",
    "1/(1-1)",
    "exp(1000)",
    "eval(true,1/0,3)",
    "eval(false,1/0,3)",
    "eval(1,2)",
    "min(1)",
    "min()",
    "sin()",
    "sin(1,2)",
    "sin",
    "foo(1)",
    "wavelength(0-9.81,1,2)",
    "asindg(0.5)",
    "acosdg(0.5)",
    "atandg(1)",
    "asinh(1)",
    "ln(2)",
    "mod(7,3)",
    "sign(2)",
    "+1",
    "1++1",
    "2+-+3",
    "- 1",
    "1||1/0",
    "1!0",
    "1=1",
    "1=2",
    "1=<1",
    "1=>1",
    "1<>2",
    "1 == 1",
    "1 = = 1",
    "1= =1",
    "1 | | 0",
    "1|0",
    "1&0",
    "1&&0",
    "1^2",
    "2%2",
    "if(1,2,3)",
    "1?2:3",
    "()",
    "(1",
    "1)",
    "(1)(2)",
    "2(3)",
    "(2)3",
    "2Dp",
    "Dp2",
    "1,2",
    ",",
    "1+",
    "*2",
    "1*/2",
    "2**3",
    "1//2",
    "1;2",
    "\"1\"",
    "'1'",
    "abs",
    "abs(1",
    "abs(1))",
    "abs 1",
    "abs (1)",
    "abs( -1 )",
    "min( 1 , 2 )",
    "min(,1)",
    "min(1,)",
    "truex",
    "trueDp",
    "1trueDp",
    "#1",
    "#1+1",
    "1 + 2 * 3",
    "1+ 2",
    "-  3",
    "1 e-2",
    "1e -2",
    "1e- 2",
    ". 5",
    "1 .5",
    "d p",
    "1e+400",
    "1e-2.5",
    "1e-400",
    "pi(,)",
    "abs(,1)",
    "abs(1,,)",
    "min(1,2,3,4,5,6,7,8,9,10,11,12)",
    "float(1e+39)",
    "float(1e+300)",
    "1_000",
    "_a",
    "min(1,2,3,4,5,6,7,8,9,10,11)",
    "2*3%2",
    "1e+2e",
    "3.Dp",
    "1.e5",
    "Dp.5",
    "Dp(1)",
    "pi()()",
    "pi()pi()",
    "abs(1)2",
    "2abs(1)",
    "true()",
    "true(1)",
};
// clang-format on

Variables sample()
{
    Variables vars;
    vars.predefine("Dp", 0.1);
    for (const char* name : {"PosMin_x", "PosMin_y", "PosMin_z"}) vars.predefine(name, -0.5);
    vars.predefine("CaseName", "c");
    vars.define_number("x1", "11");
    vars.define_number("x2", "22");
    vars.define_number("x12", "5");
    vars.define_text("s", "1");
    return vars;
}

std::string error_of(const char* text)
{
    try
    {
        evaluate_expression(text, sample());
    }
    catch (const ExpressionError& error)
    {
        return error.what();
    }
    return "no error";
}

TEST(EvaluateExpression, GivesTheValuesThatGenCaseGives)
{
    const Variables vars = sample();
    for (const Recorded& recorded : recorded_values)
        EXPECT_EQ(format_number(evaluate_expression(recorded.expression, vars, Blanks::Refused)),
                  recorded.value)
            << recorded.expression;
}

TEST(EvaluateExpression, RefusesWhatGenCaseRefuses)
{
    const Variables vars = sample();
    for (const char* text : recorded_refusals)
        EXPECT_THROW(evaluate_expression(text, vars, Blanks::Refused), ExpressionError) << text;
}

TEST(EvaluateExpression, DropsBlanksInAttributesButNotTabs)
{
    const Variables vars = sample();
    EXPECT_EQ(evaluate_expression("1 + 2", vars), 3);
    EXPECT_EQ(evaluate_expression("1 2", vars), 12);
    EXPECT_EQ(evaluate_expression("1 e-2", vars), 0.01);
    EXPECT_EQ(evaluate_expression("D p", vars), 0.1);
    EXPECT_EQ(evaluate_expression("x [ 1 ]", vars), 11);
    EXPECT_THROW(evaluate_expression("\t1+2", vars), ExpressionError);
    EXPECT_THROW(evaluate_expression("  ", vars), ExpressionError);
}

TEST(EvaluateExpression, BuildsNamesFromIndices)
{
    const Variables vars = sample();
    EXPECT_EQ(evaluate_expression("x[1]+x[1+1]", vars), 33);
    EXPECT_EQ(evaluate_expression("x[1][2]", vars), 5);
    EXPECT_EQ(evaluate_expression("x[x[1]-10]", vars), 11);
    EXPECT_EQ(evaluate_expression("x[1.9999999]", vars), 11);
    for (const char* text : {"[Dp]", "2*[Dp]", "x[1]y", "x[s]", "x[-1]", "1[2]", "pi[1]", "x[",
                             "x[]", "x]", "(Dp)[1]", "x[1", "s", "x[1)", "x[0/0]"})
        EXPECT_THROW(evaluate_expression(text, vars), ExpressionError) << text;
}

TEST(EvaluateExpression, RefusesIntegersBeyond32Bits)
{
    for (const char* text : {"int(3e+9)", "int(-1e+20)", "roundpos(3e+9,0,1)", "randint(5,1)"})
        EXPECT_NE(error_of(text), "no error") << text;
}

TEST(EvaluateExpression, NamesColumnAndExpectation)
{
    EXPECT_EQ(error_of("1 + 2 ^ 3"),
              "expression \"1 + 2 ^ 3\", column 7: unexpected '^'; expected an operator (+ - * / "
              "== != < <= > >= ||) or the end");
    EXPECT_EQ(error_of("2*(1/0)"), "expression \"2*(1/0)\", column 5: Division by zero");
    EXPECT_EQ(error_of("min(1)"),
              "expression \"min(1)\", column 1: the function 'min' has 1 "
              "values; expected 2 to 10");
    EXPECT_EQ(error_of("rand(1)"),
              "expression \"rand(1)\", column 1: the function 'rand' has 1 "
              "values; expected 0 or 2");
    EXPECT_EQ(error_of("1+sqrt(-1)"),
              "expression \"1+sqrt(-1)\", column 3: sqrt(-1): the result "
              "is not a number (NaN)");
    EXPECT_EQ(error_of("(1+2"),
              "expression \"(1+2\", column 5: unexpected end of the text; "
              "expected ')' for the '(' in column 1");
}

TEST(EvaluateExpression, SolvesTheWavelengthToTheLastDigits)
{
    const Variables vars = sample();
    EXPECT_NEAR(evaluate_expression("wavelength(9.81,1,2)", vars), 5.2153729314, 1e-10);
    EXPECT_NEAR(evaluate_expression("wavelength(9.81,0.3,5)", vars), 8.50849602328, 1e-10);
    EXPECT_NEAR(evaluate_expression("wavelength(9.81,10,3)", vars), 14.0481268859, 1e-9);
    EXPECT_NEAR(evaluate_expression("wavelength(9.81,0.001,20)", vars), 1.98090556073, 1e-10);
}

TEST(EvaluateExpression, RepeatsRandomNumbersForTheSameSeed)
{
    const Variables vars = sample();
    const double unseeded = evaluate_expression("rand()", vars);
    EXPECT_EQ(evaluate_expression("rand()", sample()), unseeded);
    EXPECT_EQ(evaluate_expression("randinit(7)", vars), 0);
    const double first = evaluate_expression("rand()", vars);
    const double second = evaluate_expression("rand()", vars);
    evaluate_expression("randinit(7.9)", vars);
    EXPECT_EQ(evaluate_expression("rand()", vars), first);
    EXPECT_EQ(evaluate_expression("rand()", vars), second);
    EXPECT_NE(first, second);
}

TEST(EvaluateExpression, KeepsRandomNumbersWithinTheirBounds)
{
    const Variables vars = sample();
    bool seen[3] = {false, false, false};
    for (int i = 0; i < 1000; ++i)
    {
        const double real = evaluate_expression("rand(-2,3)", vars);
        EXPECT_TRUE(real >= -2 && real < 3);
        const double integer = evaluate_expression("randint(-1.5,1.5)", vars);
        ASSERT_TRUE(integer == -1 || integer == 0 || integer == 1);
        seen[static_cast<int>(integer) + 1] = true;
    }
    EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
}

TEST(EvaluateExpression, LimitsTheNesting)
{
    const Variables vars = sample();
    const auto nested = [](int n, const std::string& open, const std::string& close)
    {
        std::string text;
        for (int i = 0; i < n; ++i) text += open;
        text += "1";
        for (int i = 0; i < n; ++i) text += close;
        return text;
    };
    EXPECT_EQ(evaluate_expression(nested(max_expression_depth, "(", ")"), vars), 1);
    EXPECT_THROW(evaluate_expression(nested(max_expression_depth + 1, "(", ")"), vars),
                 ExpressionError);
    EXPECT_THROW(evaluate_expression(nested(100000, "abs(", ")"), vars), ExpressionError);
    EXPECT_THROW(evaluate_expression(nested(1000, "x[", "]"), vars), ExpressionError);
    EXPECT_EQ(evaluate_expression(std::string(100000, '-') + "1", vars), 1);
}

TEST(EvaluateExpression, GivesAValueOrAnErrorForAnyText)
{
    // Words weighted towards what makes expressions; the seed makes failures repeatable.
    const std::vector<std::string> words{
        "1",  "0", "2.5",  "1e-3", "1e",         ".",           "Dp",     "x",
        "x1", "s", "true", "(",    ")",          "(",           ")",      "[",
        "]",  "+", "-",    "*",    "/",          "==",          "!=",     "<",
        "<=", ">", "||",   "!",    ",",          "min(",        " ",      "&&",
        "^",  "%", "e(",   "=",    "abs(",       "eval(",       "\t",     "\xff",
        "#",  "_", "int(", "pow(", "roundposx(", "99999999999", "1e+308", "randint("};
    std::mt19937 random(1);
    const Variables vars = sample();
    int values = 0;
    for (int i = 0; i < 20000; ++i)
    {
        std::string text;
        const auto count = random() % 12 + 1;
        for (unsigned k = 0; k < count; ++k) text += words[random() % words.size()];
        try
        {
            evaluate_expression(text, vars);
            ++values;
        }
        catch (const ExpressionError& error)
        {
            EXPECT_LE(error.column, text.size() + 1) << text;
            EXPECT_NE(std::string(error.what()), "") << text;
        }
        try
        {
            vars.interpolate(text);
        }
        catch (const ExpressionError&)
        {
        }
    }
    EXPECT_GT(values, 100);
}

TEST(EvaluateCondition, TakesAnyValueButZeroAsTrue)
{
    const Variables vars = sample();
    for (const char* text : {"1 == 1", "1", "2", "0.5", "-1", "#1", "# 1 == 1", "TRUE", "", "Dp",
                             "x[1]==11", "Dp!=0.1==(true||false)||1"})
        EXPECT_TRUE(evaluate_condition(text, vars)) << text;
    for (const char* text : {"0", "#1==2", "false", "Dp!=0.1==(true||false)"})
        EXPECT_FALSE(evaluate_condition(text, vars)) << text;
}

TEST(EvaluateCondition, RefusesWordsAndBlankText)
{
    const Variables vars = sample();
    for (const char* text : {"yes", "no", " ", "[Dp]", "CaseName", "#"})
        EXPECT_THROW(evaluate_condition(text, vars), ExpressionError) << text;
}

TEST(ParseNumber, TakesPlainRealNumbersAndExpressionsAfterHash)
{
    const Variables vars = sample();
    EXPECT_EQ(parse_number("0.2", vars), 0.2);
    EXPECT_EQ(parse_number(".2", vars), 0.2);
    EXPECT_EQ(parse_number("+.5", vars), 0.5);
    EXPECT_EQ(parse_number("-0.2", vars), -0.2);
    EXPECT_EQ(parse_number("5.", vars), 5);
    EXPECT_EQ(parse_number("1.5e1", vars), 15);
    EXPECT_EQ(parse_number("2E+1", vars), 20);
    EXPECT_EQ(parse_number(" 0.2 ", vars), 0.2);
    EXPECT_EQ(parse_number("# Dp * 2", vars), 0.2);
    EXPECT_EQ(parse_number("#1 2", vars), 12);
    EXPECT_EQ(parse_number("#x[1]-11", vars), 0);
}

TEST(ParseNumber, RefusesEverythingElse)
{
    const Variables vars = sample();
    for (const char* text :
         {" #Dp*2", "Dp*2", "0.2m",  "0,2", "0.2.1", "1e", "#",     "inf",
          "nan",    "-inf", "0x1",   "--1", "+-1",   "-",  "+",     "1e+",
          "#.2",    "[Dp]", "#[Dp]", "1 2", "",      " ",  "1e400", "#1e+300*1e+300",
          "\t0.1\n"})
        EXPECT_THROW(parse_number(text, vars), ExpressionError) << text;
    try
    {
        parse_number("1,5", vars);
    }
    catch (const ExpressionError& error)
    {
        EXPECT_NE(std::string(error.what()).find("'1,5' is not a valid real number"),
                  std::string::npos);
    }
}

} // namespace
