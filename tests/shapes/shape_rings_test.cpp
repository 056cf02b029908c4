#include "shapes/shape_rings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fppg
{
namespace
{

/// What GenCase v5.4.354 wrote into the shapeout of golden case nor_cyl_oblique: float32, all bits.
TEST(ShapeRings, AreGenCasesToTheLastBit)
{
    const auto [near, far] = cylinder_rings({0.3, 0.1, 0.2}, {0.6, 0.7, 0.6}, 0.26, 24);
    ASSERT_EQ(near.size(), 24U);
    ASSERT_EQ(far.size(), 24U);
    const auto expect = [](const Vec3& found, float x, float y, float z)
    {
        EXPECT_EQ(static_cast<float>(found.x), x);
        EXPECT_EQ(static_cast<float>(found.y), y);
        EXPECT_EQ(static_cast<float>(found.z), z);
    };
    expect(near[0], 0.0606506318F, 0.171804816F, 0.27180481F);
    expect(near[1], 0.0640473217F, 0.208223194F, 0.21462974F);
    expect(near[11], 0.5264346F, 0.0695069879F, 0.0759136081F);
    expect(near[23], 0.0735655725F, 0.13049306F, 0.324086457F);
    expect(far[0], 0.360650659F, 0.77180481F, 0.671804845F);
    expect(far[1], 0.364047348F, 0.808223128F, 0.614629745F);
    expect(far[11], 0.826434612F, 0.669506967F, 0.475913644F);
    expect(far[23], 0.373565584F, 0.730493009F, 0.724086523F);
}

TEST(ShapeRings, LieAcrossTheAxisAtTheRadius)
{
    for (const Vec3& axis :
         {Vec3{1, 0, 0}, Vec3{0, -2, 0}, Vec3{0, 0, 3}, Vec3{0, 1, -1}, Vec3{0.3, -0.2, 0.7}})
    {
        const Vec3 a{0.2, 0.1, -0.4};
        const auto rings = cylinder_rings(a, a + axis, 0.5, 16);
        for (std::size_t end = 0; end < 2; ++end)
            for (const Vec3& corner : rings[end])
            {
                const Vec3 spoke = corner - (a + axis * static_cast<double>(end));
                EXPECT_NEAR(norm(spoke), 0.5, 3e-6);
                EXPECT_NEAR(dot(spoke, axis) / norm(axis), 0, 3e-6);
            }
        // Clockwise seen from the tip of the axis.
        EXPECT_LT(dot(cross(rings[0][0] - a, rings[0][1] - a), axis), 0);
    }
}

} // namespace
} // namespace fppg
