#include "casedef/expression.h"
#include "casedef/variables.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

/// Any text gives a value or an ExpressionError, as an expression and within a text.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace fppg;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    Variables vars;
    vars.predefine("Dp", 0.1);
    vars.predefine("PosMin_x", -0.5);
    vars.predefine("x1", 2.0);
    vars.predefine("T", "text");
    try
    {
        evaluate_expression(text, vars);
    }
    catch (const ExpressionError&)
    {
    }
    try
    {
        vars.interpolate(text);
    }
    catch (const ExpressionError&)
    {
    }
    return 0;
}
