// Particles on a mesh without a case.

#include "fppg/fit_mesh.h"
#include "fppg/error.h"

#include "meshes/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

using namespace test;

FitMeshOptions options_of(double dp)
{
    FitMeshOptions options;
    options.dp = dp;
    return options;
}

TEST(FitMesh, ACubeHasItsCornersAndOneParticlePerDpSquaredOnItsFaces)
{
    const double dp = 0.05;
    const FittedMesh fitted = fit_mesh(box({0, 0, 0}, {1, 1, 1}), options_of(dp));
    EXPECT_EQ(std::count(fitted.kinds.begin(), fitted.kinds.end(), FitKind::Corner), 8);
    EXPECT_NEAR(fitted.area, 6, 1e-12);
    EXPECT_NEAR(fitted.volume, 1, 1e-12);
    ASSERT_EQ(fitted.normals.size(), fitted.positions.size());
    EXPECT_NEAR(static_cast<double>(fitted.positions.size()) * dp * dp / 6, 1, 0.06);
    for (std::size_t i = 0; i < fitted.positions.size(); ++i)
    {
        double off = 1;
        for (int axis = 0; axis < 3; ++axis)
            off = std::min({off, std::abs(fitted.positions[i][axis]),
                            std::abs(fitted.positions[i][axis] - 1)});
        ASSERT_LT(off, 1e-12);
        const Vec3 out = fitted.positions[i] - Vec3{0.5, 0.5, 0.5};
        const std::array<float, 3>& n = fitted.normals[i];
        ASSERT_NEAR(dot(out, {n[0], n[1], n[2]}), 0.5, 1e-6);
    }
}

TEST(FitMesh, RelaxationEvensTheSpacingAndTellsHowFarItIs)
{
    int last = 0;
    FitMeshOptions options = options_of(0.05);
    options.on_progress = [&](int iteration) { last = iteration; };
    const FittedMesh relaxed = fit_mesh(sphere(4), options);
    EXPECT_GT(last, 20);
    options.is_relaxed = false;
    const FittedMesh raw = fit_mesh(sphere(4), options);
    const auto variation = [](const FittedMesh& mesh)
    {
        double sum = 0;
        double squares = 0;
        for (const Vec3& p : mesh.positions)
        {
            double nearest = 1e9;
            for (const Vec3& q : mesh.positions)
                if (&p != &q) nearest = std::min(nearest, norm(p - q));
            sum += nearest;
            squares += nearest * nearest;
        }
        const auto n = static_cast<double>(mesh.positions.size());
        return std::sqrt(squares / n - sum / n * sum / n) / (sum / n);
    };
    EXPECT_LT(variation(relaxed), 0.045);
    EXPECT_LT(variation(relaxed), 0.8 * variation(raw));
}

TEST(FitMesh, TheSameParticlesComeFromAnyNumberOfThreads)
{
    FitMeshOptions options = options_of(0.07);
    const FittedMesh one = fit_mesh(sphere(4), options);
    options.threads = 3;
    const FittedMesh three = fit_mesh(sphere(4), options);
    ASSERT_EQ(one.positions.size(), three.positions.size());
    for (std::size_t i = 0; i < one.positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_EQ(one.positions[i][axis], three.positions[i][axis]);
}

TEST(FitMesh, ADistanceThatIsNoneIsRefused)
{
    EXPECT_THROW(fit_mesh(box({0, 0, 0}, {1, 1, 1}), options_of(0)), GeometryError);
    EXPECT_THROW(fit_mesh({}, options_of(0.1)), GeometryError);
}

} // namespace

} // namespace fppg
