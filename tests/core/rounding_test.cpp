#include <gtest/gtest.h>

#include <array>

namespace fppg
{
namespace
{

void to_float_and_back(const double* given, double* rounded)
{
    const auto x = static_cast<float>(given[0]);
    const auto y = static_cast<float>(given[1]);
    rounded[0] = x;
    rounded[1] = y;
}

/// Particles stand at the same places on every system only where every compiler rounds.
TEST(Rounding, IsNotLeftOutOfTwoNumbersSideBySide)
{
    const std::array<double, 2> given{0.1, 0.3};
    std::array<double, 2> rounded{};
    // The compiler shall not know the numbers.
    void (*volatile convert)(const double*, double*) = to_float_and_back;
    convert(given.data(), rounded.data());
    EXPECT_EQ(rounded[0], double{0.1F});
    EXPECT_EQ(rounded[1], double{0.3F});
}

} // namespace
} // namespace fppg
