#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

namespace fppg
{

/// An expression, a variable or a number that cannot be used. what() quotes the expression, names
/// the column, what is wrong there and what was expected; the caller adds file and line.
struct ExpressionError : std::runtime_error
{
    /// column from 1 in the text as it was given; 0 when the error belongs to no place in it
    ExpressionError(std::size_t column_from_1, const std::string& text)
        : std::runtime_error(text), column(column_from_1)
    {
    }
    std::size_t column;
};

/// Letters, digits and `_`.
bool is_name_character(char c);

/// The value of a variable: a number or a text.
using VariableValue = std::variant<double, std::string>;

/// A stream of pseudo-random numbers: splitmix64, the same on every machine.
class RandomStream
{
public:
    explicit RandomStream(std::uint64_t seed = 0) : state_(seed) {}
    /// A number in [0, 1) with 53 random bits.
    double next();

private:
    std::uint64_t state_;
};

/// Where an expression finds its variables.
class VariableSource
{
public:
    virtual ~VariableSource() = default;
    /// The value of `name` (case-sensitive), or nothing if there is no such variable.
    virtual std::optional<VariableValue> find(std::string_view name) const = 0;
    /// The stream that rand, randint and randinit use. Its state is no part of the variables.
    virtual RandomStream& random() const = 0;
};

/// What blanks (the character ' ' only) are in an expression.
enum class Blanks : std::uint8_t
{
    Dropped, ///< attributes, if= and #: all blanks are left out first, so `1 2` is 12
    Refused, ///< inside `[...]` of a text
};

/// Deepest nesting of parentheses, functions and `name[...]` in an expression.
inline constexpr int max_expression_depth = 200;

/// Evaluates an expression by the rules of GenCase (v5.4.354, each found by running it; rules V1
/// to V4 of the semantics, held by tests/casedef/expression_test.cpp).
///
/// Operators, tightest first; those of a line go from left to right:
///     - !          unary, in any number (--1 is 1, !!3 is 1); there is no unary +
///     * /          division by zero is an error, also in a branch that is not used
///     + -
///     < <= > >=    1 or 0; so 3>2>1 is 0
///     == !=        exact comparison of doubles
///     ||           1 or 0; both sides are always evaluated
/// `&&`, `&`, `^`, `%`, `=`, `?:` and if(a,b,c) do not exist and are refused.
///
/// Numbers begin with a digit: 5, 5., 0.5, 1e-2, 1.5E+3. An exponent needs its sign (1e5 is
/// refused, as is .5), and the value must fit a double. true and false in any letter case are 1 and
/// 0. A value other than 0 is true.
///
/// Names are letters, digits and `_`, begin with a letter, and tell upper from lower case.
/// `name[expression]` is the variable called name followed by the index cut to an integer, which
/// must not be negative; `x[1][2]` is x12. A name followed at once by `(` is a function, so
/// a variable may be called sin.
///
/// Functions: pi() e() eval(condition,a,b) float(a) (rounded to float32) int(a) (cut towards zero)
/// floor ceil round (halves away from zero) min max (2 to 10 values) abs sqrt exp log log10 pow
/// fmod(a,b) (sign of a) fmodr(a,b) = round(fmod(a,b)) sin cos tan sinh cosh tanh asin acos atan
/// atan2(y,x) in radians, sindg cosdg tandg in degrees (of a*pi/180), wavelength(g,depth,period)
/// (the solution of L = g period^2/(2 pi) tanh(2 pi depth/L), metres), roundpos(pos,posmin,dp) =
/// posmin + round((pos-posmin)/dp)*dp (posmin for dp 0), roundposx roundposy roundposz(pos) with
/// the variables PosMin_x (.._y, .._z) and Dp, randinit(seed) (0; the seed cut to an integer),
/// rand() in [0, 1), rand(a,b) in [a, b), randint(a,b) (bounds cut to integers, both included).
/// One comma after the last argument is ignored. All arguments are evaluated. A function whose
/// result is no finite number is an error (sqrt(-1), log(0), fmod(1,0)); an operator may overflow
/// to infinity.
///
/// Differences from GenCase, all deliberate: the numbers of rand are our own, and repeatable
/// without randinit (GenCase starts from another number in each run); int() and roundpos() beyond
/// 32 bits and randint(a,b) with b < a are errors (GenCase gives -2147483648 without a word);
/// nesting is limited to max_expression_depth.
///
/// text    the expression without a leading `#`
/// returns the value
/// throws  ExpressionError
/// cost    O(length)
double evaluate_expression(std::string_view text, const VariableSource& vars,
                           Blanks blanks = Blanks::Dropped);

/// Whether the value of `if="..."` lets the command run. An empty text is true, a leading `#` is
/// ignored, and any value but 0 is true. Texts such as "yes" are names of variables.
/// throws ExpressionError
bool evaluate_condition(std::string_view text, const VariableSource& vars);

/// The number in an attribute: `#` as the very first character and an expression, or a plain real
/// number.
///
/// A plain number is an optional sign, digits with an optional point (.5 and 5. are good) and an
/// optional exponent whose sign is optional here; blanks around it are allowed, tabs are not.
/// GenCase also takes an empty text and 1e400; both are refused here, as are inf, nan and
/// hexadecimal numbers, which GenCase refuses too.
///
/// returns  a finite number
/// throws   ExpressionError: "'1,5' is not a valid real number ..."
double parse_number(const std::string& text, const VariableSource& vars);

/// A number as GenCase writes it into texts: %g, six significant digits.
std::string format_number(double value);

} // namespace fppg
