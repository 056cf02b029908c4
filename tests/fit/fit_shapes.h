#pragma once

#include "fppg/features.h"
#include "fppg/fit.h"
#include "meshes/test_shapes.h"

#include <cmath>
#include <numbers>

namespace fppg::test
{

/// A prism of height `height` over a wheel of teeth with flat tops and valleys.
inline TriangleSoup gear(int teeth, double inner, double outer, double height)
{
    std::vector<Vec3> rim;
    for (int i = 0; i < 4 * teeth; ++i)
    {
        const double angle = std::numbers::pi * (0.5 * i + (i % 2 == 0 ? 0.1 : -0.1)) / teeth;
        const double radius = i % 4 < 2 ? outer : inner;
        rim.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    TriangleSoup soup;
    const Vec3 up{0, 0, height};
    for (std::size_t i = 0; i < rim.size(); ++i)
    {
        const Vec3& a = rim[i];
        const Vec3& b = rim[(i + 1) % rim.size()];
        add_facet(soup, b, a, {});
        add_facet(soup, a + up, b + up, up);
        add_quad(soup, a, b, b + up, a + up);
    }
    return soup;
}

/// A shape with everything that fitting it needs.
struct FitInput
{
    SurfaceMesh mesh;
    Features features;
    std::vector<FeatureParticle> on_features;
    FitOptions options;

    FitInput(const TriangleSoup& soup, double dp)
    {
        MeshReport report;
        mesh = repair_mesh(soup, {}, 1, report);
        FeatureOptions feature_options;
        feature_options.dp = dp;
        features = find_features(mesh, feature_options);
        on_features = place_feature_particles(mesh, features, feature_options);
        options.dp = dp;
    }

    SurfaceParticles fit(int threads = 1) const
    {
        return fit_surface(mesh, features, on_features, options, threads);
    }
    double area_dp2() const
    {
        double area = 0;
        for (const double a : mesh.areas) area += a;
        return area / (options.dp * options.dp);
    }
};

} // namespace fppg::test
