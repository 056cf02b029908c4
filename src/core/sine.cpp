#include "core/sine.h"

#include <cmath>
#include <numbers>

namespace fppg
{

namespace
{

/// A number of 106 bits: a sum of two doubles, the second below half of the last digit of the
/// first.
struct DoubleDouble
{
    double high = 0;
    double low = 0;
};

DoubleDouble sum_of(double a, double b)
{
    const double sum = a + b;
    const double part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}

DoubleDouble product_of(const DoubleDouble& a, const DoubleDouble& b)
{
    const double high = a.high * b.high;
    const double low = std::fma(a.high, b.high, -high) + (a.high * b.low + a.low * b.high);
    return sum_of(high, low);
}

/// 1 - a / divisor
DoubleDouble one_minus_quotient(const DoubleDouble& a, double divisor)
{
    const double high = a.high / divisor;
    const double low = (std::fma(-high, divisor, a.high) + a.low) / divisor;
    const DoubleDouble sum = sum_of(1, -high);
    return sum_of(sum.high, sum.low - low);
}

/// angle - n pi/2
DoubleDouble rest_of(double angle, double n)
{
    // Of pi/2 to 159 bits.
    constexpr double part_1 = 0x1.921fb54442d18p0;
    constexpr double part_2 = 0x1.1a62633145c07p-54;
    constexpr double part_3 = -0x1.f1976b7ed8fbcp-110;
    const double first = n * part_1;
    const double second = n * part_2;
    const DoubleDouble rest = sum_of(angle, -first);
    DoubleDouble small = sum_of(rest.low, -std::fma(n, part_1, -first));
    const DoubleDouble smaller = sum_of(small.high, -second);
    small.low += smaller.low - std::fma(n, part_2, -second) - n * part_3;
    const DoubleDouble all = sum_of(rest.high, smaller.high);
    return sum_of(all.high, all.low + small.low);
}

/// 1 - x^2 / (first (first + 1)) (1 - x^2 / ((first + 2) (first + 3)) (...)), the series of cosine
/// (first = 1) and of sine by its angle (2), of an angle x within pi/4 of zero. From the fourth
/// term on doubles suffice: those are below 2^-16 of the sum.
DoubleDouble series(const DoubleDouble& square, double first)
{
    double end = 1;
    double k = first + 18;
    for (; k > first + 4; k -= 2) end = 1 - square.high / (k * (k + 1)) * end;
    DoubleDouble sum{end, 0};
    for (; k >= first; k -= 2) sum = one_minus_quotient(product_of(square, sum), k * (k + 1));
    return sum;
}

} // namespace

SineAndCosine portable_sine_and_cosine(double angle)
{
    const double n = std::nearbyint(angle * (2 / std::numbers::pi));
    const DoubleDouble rest = rest_of(angle, n);
    const DoubleDouble square = product_of(rest, rest);
    const double sine = product_of(rest, series(square, 2)).high;
    const double cosine = series(square, 1).high;
    switch (static_cast<int>(n) & 3)
    {
        case 0:
            return {sine, cosine};
        case 1:
            return {cosine, -sine};
        case 2:
            return {-sine, -cosine};
        default:
            return {-cosine, sine};
    }
}

} // namespace fppg
