#include "casedef/expression.h"

#include "core/float32.h"
#include "core/nearest_word.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace fppg
{

double RandomStream::next()
{
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-53;
}

std::string format_number(double value)
{
    return fmt::format("{:g}", value);
}

namespace
{

constexpr double pi = std::numbers::pi;

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}
bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// A rule broken by the arguments of a function; the parser adds the place.
struct FunctionError
{
    std::string text;
};

using Arguments = std::span<const double>;

/// Cuts towards zero, to the 32-bit integers that GenCase computes with.
double cut_to_int(double value)
{
    const double cut = std::trunc(value);
    if (!(cut >= std::numeric_limits<std::int32_t>::min() &&
          cut <= std::numeric_limits<std::int32_t>::max()))
        throw FunctionError{fmt::format("{:g} is beyond a 32-bit integer", value)};
    return cut + 0.0; // -0.4 becomes 0, not -0.
}

/// Solves L = L0 tanh(2 pi depth / L). The right side falls with L, so the root is bracketed by 0
/// and L0, and bisection ends when the bracket holds no further double.
double wavelength(double gravity, double depth, double period)
{
    if (gravity < 0 || depth < 0) throw FunctionError{"gravity and depth must not be negative"};
    const double deep = gravity * period * period / (2 * pi);
    if (depth == 0) return 0;
    double low = 0;
    double high = deep;
    while (true)
    {
        const double middle = low + (high - low) / 2;
        if (!(middle > low && middle < high)) return high;
        if (deep * std::tanh(2 * pi * depth / middle) > middle)
            low = middle;
        else
            high = middle;
    }
}

double round_position(double pos, double pos_min, double dp)
{
    if (dp == 0) return pos_min;
    const double node = std::round((pos - pos_min) / dp);
    return pos_min + cut_to_int(node) * dp;
}

double variable_number(const VariableSource& vars, std::string_view name)
{
    const auto value = vars.find(name);
    const double* number = value ? std::get_if<double>(&*value) : nullptr;
    if (!number) throw FunctionError{fmt::format("it needs the number variable '{}'", name)};
    return *number;
}

double round_position_on_axis(double pos, const VariableSource& vars, std::string_view pos_min)
{
    return round_position(pos, variable_number(vars, pos_min), variable_number(vars, "Dp"));
}

double random_integer(double from, double to, RandomStream& random)
{
    const double first = cut_to_int(from);
    const double last = cut_to_int(to);
    if (last < first) throw FunctionError{"the first value must not exceed the second"};
    return std::min(last, first + std::floor(random.next() * (last - first + 1)));
}

struct Function
{
    std::string_view name;
    std::size_t min_arguments;
    std::size_t max_arguments;
    double (*compute)(Arguments a, const VariableSource& vars);
};

using Vars = const VariableSource&;

constexpr std::size_t max_arguments = 10;

constexpr std::array functions{
    Function{"pi", 0, 0, [](Arguments, Vars) { return pi; }},
    Function{"e", 0, 0, [](Arguments, Vars) { return std::numbers::e; }},
    Function{"eval", 3, 3, [](Arguments a, Vars) { return a[0] != 0 ? a[1] : a[2]; }},
    Function{"float", 1, 1,
             [](Arguments a, Vars)
             {
                 if (std::abs(a[0]) > static_cast<double>(std::numeric_limits<float>::max()))
                     throw FunctionError{"the value is beyond a 32-bit real number"};
                 return as_float32(a[0]);
             }},
    Function{"int", 1, 1, [](Arguments a, Vars) { return cut_to_int(a[0]); }},
    Function{"floor", 1, 1, [](Arguments a, Vars) { return std::floor(a[0]); }},
    Function{"ceil", 1, 1, [](Arguments a, Vars) { return std::ceil(a[0]); }},
    Function{"round", 1, 1, [](Arguments a, Vars) { return std::round(a[0]); }},
    Function{"min", 2, max_arguments,
             [](Arguments a, Vars) { return *std::min_element(a.begin(), a.end()); }},
    Function{"max", 2, max_arguments,
             [](Arguments a, Vars) { return *std::max_element(a.begin(), a.end()); }},
    Function{"abs", 1, 1, [](Arguments a, Vars) { return std::abs(a[0]); }},
    Function{"fmod", 2, 2, [](Arguments a, Vars) { return std::fmod(a[0], a[1]); }},
    Function{"fmodr", 2, 2, [](Arguments a, Vars) { return std::round(std::fmod(a[0], a[1])); }},
    Function{"sqrt", 1, 1, [](Arguments a, Vars) { return std::sqrt(a[0]); }},
    Function{"exp", 1, 1, [](Arguments a, Vars) { return std::exp(a[0]); }},
    Function{"log", 1, 1, [](Arguments a, Vars) { return std::log(a[0]); }},
    Function{"log10", 1, 1, [](Arguments a, Vars) { return std::log10(a[0]); }},
    Function{"pow", 2, 2, [](Arguments a, Vars) { return std::pow(a[0], a[1]); }},
    Function{"sin", 1, 1, [](Arguments a, Vars) { return std::sin(a[0]); }},
    Function{"cos", 1, 1, [](Arguments a, Vars) { return std::cos(a[0]); }},
    Function{"tan", 1, 1, [](Arguments a, Vars) { return std::tan(a[0]); }},
    Function{"sindg", 1, 1, [](Arguments a, Vars) { return std::sin(a[0] * pi / 180); }},
    Function{"cosdg", 1, 1, [](Arguments a, Vars) { return std::cos(a[0] * pi / 180); }},
    Function{"tandg", 1, 1, [](Arguments a, Vars) { return std::tan(a[0] * pi / 180); }},
    Function{"sinh", 1, 1, [](Arguments a, Vars) { return std::sinh(a[0]); }},
    Function{"cosh", 1, 1, [](Arguments a, Vars) { return std::cosh(a[0]); }},
    Function{"tanh", 1, 1, [](Arguments a, Vars) { return std::tanh(a[0]); }},
    Function{"asin", 1, 1, [](Arguments a, Vars) { return std::asin(a[0]); }},
    Function{"acos", 1, 1, [](Arguments a, Vars) { return std::acos(a[0]); }},
    Function{"atan", 1, 1, [](Arguments a, Vars) { return std::atan(a[0]); }},
    Function{"atan2", 2, 2, [](Arguments a, Vars) { return std::atan2(a[0], a[1]); }},
    Function{"wavelength", 3, 3, [](Arguments a, Vars) { return wavelength(a[0], a[1], a[2]); }},
    Function{"roundpos", 3, 3, [](Arguments a, Vars) { return round_position(a[0], a[1], a[2]); }},
    Function{"roundposx", 1, 1,
             [](Arguments a, Vars vars) { return round_position_on_axis(a[0], vars, "PosMin_x"); }},
    Function{"roundposy", 1, 1,
             [](Arguments a, Vars vars) { return round_position_on_axis(a[0], vars, "PosMin_y"); }},
    Function{"roundposz", 1, 1,
             [](Arguments a, Vars vars) { return round_position_on_axis(a[0], vars, "PosMin_z"); }},
    Function{"randinit", 1, 1,
             [](Arguments a, Vars vars)
             {
                 const auto seed = static_cast<std::int64_t>(cut_to_int(a[0]));
                 vars.random() = RandomStream(static_cast<std::uint64_t>(seed));
                 return 0.0;
             }},
    Function{"rand", 0, 0, [](Arguments, Vars vars) { return vars.random().next(); }},
    Function{"rand", 2, 2,
             [](Arguments a, Vars vars) { return a[0] + (a[1] - a[0]) * vars.random().next(); }},
    Function{"randint", 2, 2,
             [](Arguments a, Vars vars) { return random_integer(a[0], a[1], vars.random()); }},
};

/// Recursive descent, one function a level of precedence.
class Parser
{
public:
    Parser(std::string_view text, const VariableSource& vars, Blanks blanks)
        : original_(text), vars_(vars)
    {
        for (std::size_t i = 0; i < text.size(); ++i)
        {
            if (text[i] == ' ' && blanks == Blanks::Dropped) continue;
            text_.push_back(text[i]);
            columns_.push_back(i + 1);
        }
    }

    double run()
    {
        if (text_.empty()) throw ExpressionError(0, "the expression is empty; expected a value");
        const double value = parse_or();
        if (at_ < text_.size())
            fail(at_, fmt::format("unexpected {}; expected an operator (+ - * / == != < <= > >= "
                                  "||) or the end",
                                  found(at_)));
        return value;
    }

private:
    [[noreturn]] void fail(std::size_t at, const std::string& text) const
    {
        const std::size_t column = at < columns_.size() ? columns_[at] : original_.size() + 1;
        throw ExpressionError(
            column, fmt::format("expression \"{}\", column {}: {}", original_, column, text));
    }

    std::string found(std::size_t at) const
    {
        return at < text_.size() ? fmt::format("'{}'", text_[at]) : std::string("end of the text");
    }

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    bool take(std::string_view token)
    {
        if (std::string_view(text_).substr(at_, token.size()) != token) return false;
        at_ += token.size();
        return true;
    }

    double parse_or()
    {
        double left = parse_equality();
        while (take("||"))
        {
            const double right = parse_equality();
            left = left != 0 || right != 0 ? 1 : 0;
        }
        return left;
    }

    double parse_equality()
    {
        double left = parse_order();
        while (true)
        {
            if (take("=="))
                left = left == parse_order() ? 1 : 0;
            else if (take("!="))
                left = left != parse_order() ? 1 : 0;
            else
                return left;
        }
    }

    double parse_order()
    {
        double left = parse_sum();
        while (true)
        {
            if (take("<="))
                left = left <= parse_sum() ? 1 : 0;
            else if (take(">="))
                left = left >= parse_sum() ? 1 : 0;
            else if (take("<"))
                left = left < parse_sum() ? 1 : 0;
            else if (take(">"))
                left = left > parse_sum() ? 1 : 0;
            else
                return left;
        }
    }

    double parse_sum()
    {
        double left = parse_product();
        while (true)
        {
            if (take("+"))
                left = left + parse_product();
            else if (take("-"))
                left = left - parse_product();
            else
                return left;
        }
    }

    double parse_product()
    {
        double left = parse_signed();
        while (true)
        {
            const std::size_t at = at_;
            if (take("*"))
                left = left * parse_signed();
            else if (take("/"))
            {
                const double right = parse_signed();
                if (right == 0) fail(at, "Division by zero");
                left = left / right;
            }
            else
                return left;
        }
    }

    double parse_signed()
    {
        const std::size_t first = at_;
        while (peek() == '-' || peek() == '!') ++at_;
        const std::size_t last = at_;
        double value = parse_operand();
        for (std::size_t i = last; i-- > first;)
            value = text_[i] == '-' ? -value : (value == 0 ? 1.0 : 0.0);
        return value;
    }

    double parse_operand()
    {
        const char c = peek();
        if (is_digit(c)) return parse_literal();
        if (is_letter(c)) return parse_name();
        if (c == '(')
        {
            const std::size_t open = at_++;
            const double value = parse_nested(open);
            if (!take(")"))
                fail(at_, fmt::format("unexpected {}; expected ')' for the '(' in column {}",
                                      found(at_), columns_[open]));
            return value;
        }
        fail(at_, fmt::format("unexpected {}; expected a number (beginning with a digit), a "
                              "variable, a function or '('",
                              found(at_)));
    }

    double parse_nested(std::size_t open)
    {
        if (depth_ >= max_expression_depth)
            fail(open, fmt::format("nested more than {} levels deep", max_expression_depth));
        ++depth_;
        const double value = parse_or();
        --depth_;
        return value;
    }

    double parse_literal()
    {
        const std::size_t first = at_;
        while (is_digit(peek())) ++at_;
        if (take("."))
            while (is_digit(peek())) ++at_;
        if (peek() == 'e' || peek() == 'E')
        {
            ++at_;
            const bool is_signed = take("+") || take("-");
            if (!is_signed || !is_digit(peek()))
                fail(first,
                     "an exponent needs a sign and digits; write 1.5e+3 or 1e-2, or '*' before "
                     "a name");
            while (is_digit(peek())) ++at_;
        }
        double value = 0;
        const auto result = std::from_chars(text_.data() + first, text_.data() + at_, value);
        if (result.ec != std::errc{})
            fail(first, "the number is beyond the range of a double; expected 1e-307 to 1e+308");
        return value;
    }

    double parse_name()
    {
        const std::size_t first = at_;
        while (is_name_character(peek())) ++at_;
        std::string name = text_.substr(first, at_ - first);
        if (peek() == '(') return parse_call(first, name);
        if (lower_case(name) == "true") return 1;
        if (lower_case(name) == "false") return 0;
        while (peek() == '[') name += parse_index();
        const auto value = vars_.find(name);
        if (!value)
            fail(first, fmt::format("the variable '{}' does not exist; upper and lower case are "
                                    "different, and functions need their parentheses",
                                    name));
        if (const double* number = std::get_if<double>(&*value)) return *number;
        fail(first, fmt::format("the variable '{}' is a text; expected a numeric variable", name));
    }

    std::string parse_index()
    {
        const std::size_t open = at_++;
        const double index = parse_nested(open);
        if (!take("]"))
            fail(at_, fmt::format("unexpected {}; expected ']' for the '[' in column {}",
                                  found(at_), columns_[open]));
        if (!(index >= 0 && index <= std::numeric_limits<std::int32_t>::max()))
            fail(open, fmt::format("the index in brackets is {:g}; expected 0 or more", index));
        return fmt::format("{}", static_cast<std::int32_t>(index));
    }

    double parse_call(std::size_t first, const std::string& name)
    {
        const std::size_t open = at_++;
        std::vector<double> arguments;
        while (!take(")"))
        {
            if (arguments.size() == max_arguments)
                fail(at_, fmt::format("a function takes {} values at most", max_arguments));
            arguments.push_back(parse_nested(open));
            if (take(",") || peek() == ')') continue;
            fail(at_,
                 fmt::format("unexpected {}; expected ',' or ')' of the function '{}' in column {}",
                             found(at_), name, columns_[first]));
        }
        const auto function = std::find_if(functions.begin(), functions.end(),
                                           [&](const Function& f)
                                           {
                                               return f.name == name &&
                                                      arguments.size() >= f.min_arguments &&
                                                      arguments.size() <= f.max_arguments;
                                           });
        if (function == functions.end()) fail(first, describe_misfit(name, arguments.size()));
        const std::string call = text_.substr(first, at_ - first);
        try
        {
            const double value = function->compute(arguments, vars_);
            if (!std::isfinite(value))
                throw FunctionError{fmt::format(
                    "the result is {}", std::isnan(value) ? "not a number (NaN)" : "infinite")};
            return value;
        }
        catch (const FunctionError& error)
        {
            fail(first, fmt::format("{}: {}", call, error.text));
        }
    }

    static std::string describe_misfit(const std::string& name, std::size_t count)
    {
        std::string expected;
        for (const Function& f : functions)
        {
            if (f.name != name) continue;
            if (!expected.empty()) expected += " or ";
            expected += f.min_arguments == f.max_arguments
                            ? fmt::format("{}", f.min_arguments)
                            : fmt::format("{} to {}", f.min_arguments, f.max_arguments);
        }
        if (!expected.empty())
            return fmt::format("the function '{}' has {} values; expected {}", name, count,
                               expected);
        std::vector<std::string_view> names;
        for (const Function& f : functions) names.push_back(f.name);
        return fmt::format("there is no function '{}'{}", name, did_you_mean(name, names));
    }

    std::string_view original_;
    const VariableSource& vars_;
    std::string text_;
    std::vector<std::size_t> columns_; ///< of the characters of text_, in original_, from 1
    std::size_t at_ = 0;
    int depth_ = 0;
};

} // namespace

bool is_name_character(char c)
{
    return is_letter(c) || is_digit(c) || c == '_';
}

double evaluate_expression(std::string_view text, const VariableSource& vars, Blanks blanks)
{
    return Parser(text, vars, blanks).run();
}

bool evaluate_condition(std::string_view text, const VariableSource& vars)
{
    if (text.empty()) return true;
    if (text.front() == '#') text.remove_prefix(1);
    return evaluate_expression(text, vars) != 0;
}

double parse_number(const std::string& text, const VariableSource& vars)
{
    if (!text.empty() && text.front() == '#')
    {
        const double value = evaluate_expression(std::string_view(text).substr(1), vars);
        if (!std::isfinite(value))
            throw ExpressionError(
                0, fmt::format("'{}' is {:g}; expected a finite real number", text, value));
        return value;
    }
    std::string_view number = trimmed(text, " ");
    const bool has_plus = !number.empty() && number.front() == '+';
    if (has_plus) number.remove_prefix(1);

    double value = 0;
    const auto result = std::from_chars(number.data(), number.data() + number.size(), value);
    // from_chars also takes the words inf and nan, and would take the minus of "+-1".
    const bool is_plain = number.find_first_of("iInN") == std::string_view::npos &&
                          !(has_plus && number.starts_with('-'));
    if (result.ec != std::errc{} || result.ptr != number.data() + number.size() || !is_plain)
        throw ExpressionError(
            0, fmt::format("'{}' is not a valid real number (nor '#' with an expression)", text));
    return value;
}

} // namespace fppg
