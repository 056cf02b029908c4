// muParser knows the same arithmetic, comparisons and common functions; both must give the same
// double. What only one of the two has (||, !, blanks, division by zero) is left out.
#include "casedef/expression.h"
#include "casedef/variables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <muParser.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

namespace
{

using namespace fppg;

std::string random_expression(int depth);

std::string pick(std::initializer_list<const char*> words)
{
    return *rc::gen::elementOf(std::vector<std::string>(words.begin(), words.end()));
}

std::string random_operand(int depth)
{
    const int kind = *rc::gen::inRange(0, depth > 0 ? 7 : 3);
    switch (kind)
    {
        case 0:
            return std::to_string(*rc::gen::inRange(0, 20));
        case 1:
            return std::to_string(*rc::gen::inRange(0, 1000)) + pick({".5", ".", "e-2", ".25e+1"});
        case 2:
            return pick({"Dp", "x1", "H"});
        case 3:
            return fmt::format("-{}", random_operand(0));
        case 4:
            return fmt::format("({})", random_expression(depth - 1));
        case 5:
            return fmt::format("{}({})", pick({"abs", "sin", "cos", "tanh", "atan", "exp", "sqrt"}),
                               random_expression(depth - 1));
        default:
            return fmt::format("{}({},{})", pick({"min", "max"}), random_expression(depth - 1),
                               random_expression(depth - 1));
    }
}

std::string random_sum(int depth)
{
    std::string text = random_operand(depth);
    const int more = *rc::gen::inRange(0, 4);
    for (int i = 0; i < more; ++i)
    {
        text += pick({"+", "-", "*", "/"});
        text += random_operand(depth - 1 > 0 ? depth - 1 : 0);
    }
    return text;
}

/// muParser has all six comparisons on one level where GenCase has two, so at most one is used
/// between parentheses.
std::string random_expression(int depth)
{
    std::string text = random_sum(depth);
    if (*rc::gen::inRange(0, 3) > 0) return text;
    text += pick({"<", "<=", ">", ">=", "==", "!="});
    text += random_sum(depth);
    return text;
}

/// The optimizer of muParser computes constants in its own order and stays off.
double muparser_value(const std::string& text)
{
    mu::Parser parser;
    parser.EnableOptimizer(false);
    parser.DefineConst("Dp", 0.1);
    parser.DefineConst("x1", -2.5);
    parser.DefineConst("H", 0.2);
    parser.SetExpr(text);
    return parser.Eval();
}

RC_GTEST_PROP(EvaluateExpression, AgreesWithMuParserWhereBothHaveTheRule, ())
{
    Variables vars;
    vars.predefine("Dp", 0.1);
    vars.predefine("x1", -2.5);
    vars.predefine("H", 0.2);
    const std::string text = random_expression(4);
    RC_LOG() << text << '\n';
    double value = 0;
    bool is_refused = false;
    try
    {
        value = evaluate_expression(text, vars);
    }
    catch (const ExpressionError& error)
    {
        // Only what has no finite value may be refused here.
        is_refused = true;
        const std::string what = error.what();
        RC_ASSERT(what.find("Division by zero") != std::string::npos ||
                  what.find("the result is") != std::string::npos);
    }
    if (is_refused) return;
    const double expected = muparser_value(text);
    RC_ASSERT(value == expected || (std::isnan(value) && std::isnan(expected)) ||
              std::abs(value - expected) <= 1e-12 * std::abs(expected));
}

} // namespace
