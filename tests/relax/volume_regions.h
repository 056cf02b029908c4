#pragma once

#include "fppg/relax_volume.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

namespace fppg::test
{

/// Volume particles at the nodes of a lattice inside a wall, with the wall's particles.
struct VolumeRegion
{
    std::vector<Vec3> moving;
    std::vector<Vec3> held;
    std::vector<Vec3> walls;
    ClosestWallPoint closest;
    std::function<double(const Vec3&)> depth; ///< distance to the wall, negative outside
    double dp = 0.1;
    bool is_2d = false;

    VolumeSurroundings surroundings() const { return {held, walls, closest}; }

    RelaxVolumeOptions options() const
    {
        RelaxVolumeOptions o;
        o.dp = dp;
        o.is_2d = is_2d;
        return o;
    }

    /// Fills with nodes at `first` + (i, j, k) dp between the corners of a box.
    void fill(const Vec3& first, const Vec3& last, double clearance_dp = 0.55)
    {
        for (int i = 0; first.x + i * dp < last.x; ++i)
            for (int j = 0; j == 0 || (!is_2d && first.y + j * dp < last.y); ++j)
                for (int k = 0; first.z + k * dp < last.z; ++k)
                {
                    const Vec3 p = first + dp * Vec3{1.0 * i, 1.0 * j, 1.0 * k};
                    const double d = depth(p) / dp;
                    if (d < clearance_dp) continue;
                    (d < 3 ? moving : held).push_back(p);
                }
    }
};

inline VolumeRegion ball(double radius)
{
    VolumeRegion region;
    region.closest = [=](const Vec3& p) {
        return norm(p) > 0 ? p * (radius / norm(p)) : Vec3{radius, 0, 0};
    };
    region.depth = [=](const Vec3& p) { return radius - norm(p); };
    // Points along a spiral, one a dp^2.
    const int n =
        static_cast<int>(4 * std::numbers::pi * radius * radius / (region.dp * region.dp));
    for (int i = 0; i < n; ++i)
    {
        const double z = 1 - (2 * i + 1.0) / n;
        const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        region.walls.push_back(radius * Vec3{r * std::cos(angle), r * std::sin(angle), z});
    }
    region.fill({-radius, -radius, -radius}, {radius, radius, radius});
    return region;
}

/// The inside of a box from the origin to `size`; without `has_lid` it is open above, and its
/// lattice is filled up to `level`. In 2D the plane at y = 0. The first node is at `first`.
inline VolumeRegion box_region(const Vec3& size, const Vec3& first, bool is_2d = false,
                               bool has_lid = true, double level = 1e9)
{
    VolumeRegion region;
    region.is_2d = is_2d;
    const double dp = region.dp;
    region.closest = [=](const Vec3& p)
    {
        Vec3 best{1e9, 1e9, 1e9};
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {0.0, size[axis]})
            {
                if (is_2d && axis == 1) continue;
                if (!has_lid && axis == 2 && side > 0) continue;
                Vec3 q{std::clamp(p.x, 0.0, size.x), is_2d ? p.y : std::clamp(p.y, 0.0, size.y),
                       std::clamp(p.z, 0.0, size.z)};
                q[axis] = side;
                if (norm(q - p) < norm(best - p)) best = q;
            }
        return best;
    };
    region.depth = [=, closest = region.closest](const Vec3& p)
    {
        for (int axis = 0; axis < 3; ++axis)
            if (!(is_2d && axis == 1) && (p[axis] < 0 || p[axis] > size[axis]))
                return -norm(closest(p) - p);
        return norm(closest(p) - p);
    };
    const auto count = [&](double length) { return static_cast<int>(std::lround(length / dp)); };
    const int n_x = count(size.x);
    const int n_y = is_2d ? 0 : count(size.y);
    const int n_z = count(size.z);
    for (int i = 0; i <= n_x; ++i)
        for (int j = 0; j <= n_y; ++j)
            for (int k = 0; k <= n_z; ++k)
            {
                const bool is_side = i == 0 || i == n_x || (!is_2d && (j == 0 || j == n_y));
                if (!is_side && k != 0 && (k != n_z || !has_lid)) continue;
                region.walls.push_back(
                    {size.x * i / n_x, is_2d ? 0.0 : size.y * j / n_y, size.z * k / n_z});
            }
    region.fill(first, {size.x, size.y, std::min(size.z, level)});
    return region;
}

struct Evenness
{
    double mean = 0;
    double std = 0; ///< over the mean
};

/// Of the Shepard sums at particles nearer than 2.6 dp to the wall and deeper than `below` under
/// it.
inline Evenness evenness(const VolumeRegion& region, double highest = 1e9)
{
    ShepardOptions options;
    options.dp = region.dp;
    options.is_2d = region.is_2d;
    const auto all = shepard_sums(region.moving, region.surroundings(), options, 1);
    std::vector<double> sums;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (region.depth(region.moving[i]) < 2.6 * region.dp && region.moving[i].z < highest)
            sums.push_back(all[i]);
    Evenness e;
    const auto n = static_cast<double>(sums.size());
    e.mean = std::accumulate(sums.begin(), sums.end(), 0.0) / n;
    for (const double s : sums) e.std += (s - e.mean) * (s - e.mean) / n;
    e.std = std::sqrt(e.std) / e.mean;
    return e;
}

} // namespace fppg::test
