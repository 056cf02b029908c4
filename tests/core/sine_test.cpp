#include "core/sine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fppg
{

TEST(PortableSine, IsWithinAUnitInTheLastPlaceOfTheLibrarys)
{
    for (int i = -20'000; i <= 20'000; ++i)
    {
        const double angle = i * 0.0731234;
        const auto [sine, cosine] = portable_sine_and_cosine(angle);
        ASSERT_DOUBLE_EQ(sine, std::sin(angle)) << angle;
        ASSERT_DOUBLE_EQ(cosine, std::cos(angle)) << angle;
    }
}

// Values to 53 bits from tables with 40 digits; the sine of the double beside pi is what pi has
// beyond it.
TEST(PortableSine, HasTheLastDigitOnEverySystem)
{
    EXPECT_EQ(portable_sine_and_cosine(0).sine, 0);
    EXPECT_EQ(portable_sine_and_cosine(0).cosine, 1);
    EXPECT_EQ(portable_sine_and_cosine(std::numbers::pi).sine, 0x1.1a62633145c07p-53);
    EXPECT_EQ(portable_sine_and_cosine(std::numbers::pi).cosine, -1);
    EXPECT_EQ(portable_sine_and_cosine(std::numbers::pi / 2).cosine, 0x1.1a62633145c07p-54);
    EXPECT_EQ(portable_sine_and_cosine(-std::numbers::pi / 2).sine, -1);
    EXPECT_EQ(portable_sine_and_cosine(1).sine,
              0.841470984807896506652502321630298999622563060798371);
    EXPECT_EQ(portable_sine_and_cosine(2).cosine,
              -0.416146836547142386997568229500762189766000771075544);
    EXPECT_EQ(portable_sine_and_cosine(1e-20).sine, 1e-20);
}

} // namespace fppg
