#pragma once

#include "fppg/mesh.h"

#include "meshes/point_grid.h"
#include "meshes/test_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace fppg::test
{

/// A prism over a right triangle with an edge of 14 degrees.
inline TriangleSoup wedge()
{
    TriangleSoup soup;
    const std::array<Vec3, 3> front{Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 0, 0.5}};
    const Vec3 back{0, 1.3, 0};
    add_facet(soup, front[0], front[1], front[2]);
    add_facet(soup, front[2] + back, front[1] + back, front[0] + back);
    for (std::size_t i = 0; i < 3; ++i)
        add_quad(soup, front[(i + 1) % 3], front[i], front[i] + back, front[(i + 1) % 3] + back);
    return soup;
}

/// The largest distance from points sampled on a surface to the nearest particle, in dp, at most 2.
///
/// samples_per_dp2  how many points are taken on a dp squared
inline double farthest_point_dp(const SurfaceMesh& mesh, const std::vector<Vec3>& particles,
                                double dp, double samples_per_dp2)
{
    PointGrid grid(2 * dp, particles.size());
    for (const Vec3& p : particles) grid.add(p);
    double farthest = 0;
    double due = 0;
    unsigned count = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const Vec3& a = mesh.vertices[mesh.facets[f][0]];
        const Vec3& b = mesh.vertices[mesh.facets[f][1]];
        const Vec3& c = mesh.vertices[mesh.facets[f][2]];
        for (due += samples_per_dp2 * mesh.areas[f] / (dp * dp); due >= 1; due -= 1)
        {
            ++count;
            double u = std::fmod(0.7548776662466927 * count, 1.0);
            double v = std::fmod(0.5698402909980532 * count, 1.0);
            if (u + v > 1)
            {
                u = 1 - u;
                v = 1 - v;
            }
            double nearest = 4 * dp * dp;
            grid.for_each_near(a + (b - a) * u + (c - a) * v, 2 * dp,
                               [&](std::uint32_t, double squared)
                               { nearest = std::min(nearest, squared); });
            farthest = std::max(farthest, nearest);
        }
    }
    return std::sqrt(farthest) / dp;
}

} // namespace fppg::test
