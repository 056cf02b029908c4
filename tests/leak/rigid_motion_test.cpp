#include "leak/rigid_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace fppg;

const std::vector<Vec3> corner{{1, 2, 3}, {2, 2, 3}, {1, 2.5, 3}, {1, 2, 3.25}};

/// Turned about z by an angle, then moved.
Vec3 turned(const Vec3& p, double angle)
{
    return {std::cos(angle) * p.x - std::sin(angle) * p.y + 5,
            std::sin(angle) * p.x + std::cos(angle) * p.y - 1, p.z + 0.5};
}

} // namespace

TEST(FitRigidMotion, FindsARotationByAnyAngleAndAMove)
{
    for (const double angle : {0.0, 0.3, -2.0, 3.14159265358979, 6.0})
    {
        std::vector<Vec3> to;
        for (const Vec3& p : corner) to.push_back(turned(p, angle));
        const RigidMotion motion = fit_rigid_motion(corner, to);
        EXPECT_LT(motion.farthest, 1e-12) << angle;
        const Vec3 other{-3, 0.5, 8};
        EXPECT_LT(norm(motion.forward(other) - turned(other, angle)), 1e-11) << angle;
        EXPECT_LT(norm(motion.backward(motion.forward(other)) - other), 1e-11) << angle;
    }
}

TEST(FitRigidMotion, TellsHowFarABodyThatBendsIsOff)
{
    std::vector<Vec3> to = corner;
    to[1].z += 0.2;
    const RigidMotion motion = fit_rigid_motion(corner, to);
    EXPECT_GT(motion.farthest, 0.01);
    EXPECT_LT(motion.farthest, 0.2);
}

TEST(FitRigidMotion, DoesNotMirror)
{
    std::vector<Vec3> to = corner;
    for (Vec3& p : to) p.x = -p.x;
    EXPECT_GT(fit_rigid_motion(corner, to).farthest, 0.01);
}

TEST(FitRigidMotion, MovesASinglePoint)
{
    const RigidMotion motion = fit_rigid_motion({{1, 2, 3}}, {{4, 2, 3}});
    EXPECT_LT(norm(motion.forward({1, 2, 3}) - Vec3{4, 2, 3}), 1e-12);
    EXPECT_LT(motion.farthest, 1e-12);
}
