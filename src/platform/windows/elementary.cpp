// Sine, power and their like for all Windows alike. Those of mingw-w64 and of Windows are elsewhere
// in their last digits: the sine takes pi to 66 bits and is wrong from the fourth digit on beside
// multiples of pi/2, a power with a whole exponent is off by 4 units in the last place, an arc sine
// is that of the version of Windows. These are computed to 64 bits and rounded once, as exp, log
// and atan2 of mingw-w64 are, so that one result in a thousand is a unit in the last place off that
// of Linux. They are in the program, and so are found before those of the C library.
#include <cmath>
#include <numbers>

namespace
{

struct Reduced
{
    long double rest; ///< within pi/4 of zero
    unsigned quarter; ///< turns by pi/2, modulo 4
};

Reduced reduced(double angle)
{
    constexpr long double quarters = 0.636619772367581343076L;
    // The first two parts have 40 bits, so that their products with a count are exact.
    constexpr long double part_1 = 0xc90fdaa221p-39L;
    constexpr long double part_2 = 0xd18469898cp-80L;
    constexpr long double part_3 = 0x3145c06e0e689481p-142L;
    constexpr double most = 4194304;
    if (!(std::fabs(angle) < most))
        return {
            std::remainder(static_cast<long double>(angle), 2 * std::numbers::pi_v<long double>),
            0};
    const auto count = static_cast<int>(std::lrint(angle * static_cast<double>(quarters)));
    const auto n = static_cast<long double>(count);
    return {((angle - n * part_1) - n * part_2) - n * part_3, static_cast<unsigned>(count) & 3U};
}

double sine_of(const Reduced& r, unsigned turns)
{
    const unsigned quarter = (r.quarter + turns) & 3U;
    const long double value = (quarter & 1U) != 0 ? ::cosl(r.rest) : ::sinl(r.rest);
    return static_cast<double>(quarter >= 2 ? -value : value);
}

} // namespace

extern "C" double sin(double angle)
{
    return sine_of(reduced(angle), 0);
}

extern "C" double cos(double angle)
{
    return sine_of(reduced(angle), 1);
}

extern "C" void sincos(double angle, double* sine, double* cosine)
{
    const Reduced r = reduced(angle);
    *sine = sine_of(r, 0);
    *cosine = sine_of(r, 1);
}

// What the object file of that one in the C library holds besides.
extern "C" void sincosf(float angle, float* sine, float* cosine)
{
    double both[2];
    sincos(static_cast<double>(angle), both, both + 1);
    *sine = static_cast<float>(both[0]);
    *cosine = static_cast<float>(both[1]);
}

extern "C" void sincosl(long double angle, long double* sine, long double* cosine)
{
    asm("fsincos" : "=t"(*cosine), "=u"(*sine) : "0"(angle));
}

extern "C" double tan(double angle)
{
    const Reduced r = reduced(angle);
    const long double sine = ::sinl(r.rest);
    const long double cosine = ::cosl(r.rest);
    return static_cast<double>((r.quarter & 1U) != 0 ? -cosine / sine : sine / cosine);
}

extern "C" double asin(double x)
{
    return static_cast<double>(::asinl(x));
}

extern "C" double acos(double x)
{
    return static_cast<double>(::acosl(x));
}

extern "C" double atan(double x)
{
    return static_cast<double>(::atanl(x));
}

extern "C" double pow(double x, double y)
{
    return static_cast<double>(::powl(x, y));
}

// glibc computes these from exp, expm1 and log in this way, and is off by up to two units in the
// last place.
extern "C" double log10(double x)
{
    if (!(x > 0) || std::isinf(x)) return std::log(x);
    int exponent = std::ilogb(x);
    if (exponent < 0) ++exponent;
    const double rest = 0.434294481903251816668 * std::log(std::scalbn(x, -exponent));
    return exponent * 3.69423907715893078616e-13 + rest + exponent * 0.301029995663611771306;
}

extern "C" double sinh(double x)
{
    const double half = std::copysign(0.5, x);
    const double size = std::fabs(x);
    if (size >= 709) return half * std::exp(size / 2) * std::exp(size / 2);
    const double grown = std::expm1(size);
    return half *
           (size < 1 ? 2 * grown - grown * grown / (grown + 1) : grown + grown / (grown + 1));
}

extern "C" double cosh(double x)
{
    const double size = std::fabs(x);
    if (size >= 709) return 0.5 * std::exp(size / 2) * std::exp(size / 2);
    if (size >= 0.5 * std::numbers::ln2) return 0.5 * std::exp(size) + 0.5 / std::exp(size);
    const double grown = std::expm1(size);
    return 1 + grown * grown / (2 * (1 + grown));
}

extern "C" double tanh(double x)
{
    const double size = std::fabs(x);
    if (size >= 22) return std::copysign(1.0, x);
    const double grown = std::expm1(size >= 1 ? 2 * size : -2 * size);
    return std::copysign(size >= 1 ? 1 - 2 / (grown + 2) : -grown / (grown + 2), x);
}
