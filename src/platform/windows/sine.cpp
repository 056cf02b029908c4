// The sine and cosine of mingw-w64 are those of the processor, which takes pi to 66 bits: beside
// multiples of pi/2 they are wrong from the fourth digit on, and the half turns of cases would
// stand elsewhere than on Linux in their last bits. These take pi to 140 bits first. They are in
// the program, and so are found before those of the C library.
#include <cmath>

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
    if (!(std::fabs(angle) < most)) return {angle, 0};
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
