#include "relax/volume_forces.h"

#include "core/lanes.h"
#include "relax/kernel.h"

#include <algorithm>
#include <array>

namespace fppg
{

namespace
{

using PairFactors = VolumeForces::PairFactors;
using PairSums = VolumeForces::PairSums;

constexpr float volume_push_reach = 0.8f;
constexpr float volume_push_strength = 5.6f; ///< in units of the kernel's factor, a dp

FPPG_LANES PairSums sum_pairs(const PointArrays& points, std::uint32_t i,
                              std::span<const std::uint32_t> near, const PairFactors& factors)
{
    Lanes x{}, y{}, z{}, weight{};
    const Lanes none{};
    NeighbourLanes(AxesGather{points.x.data(), points.y.data(), points.z.data()}, i)
        .for_each(near.data(), near.size(),
                  [&](const LaneOffsets& o)
                  {
                      const Lanes r = square_root(o.squared);
                      const Lanes half_q = r * factors.half_inverse_h;
                      const Lanes s = larger(none, 1 - half_q);
                      const Lanes s3 = s * s * s;
                      const Lanes closeness = larger(none, 1 - r * (1 / volume_push_reach));
                      const Lanes size = factors.slope * s3 + factors.push * closeness;
                      x += size * o.x;
                      y += size * o.y;
                      z += size * o.z;
                      weight += s3 * s * (4 * half_q + 1);
                  });
    return {sum_of(x), sum_of(y), sum_of(z), sum_of(weight)};
}

PairSums sum_pairs_plain(const PointArrays& points, std::uint32_t i,
                         std::span<const std::uint32_t> near, const PairFactors& factors)
{
    return sum_pairs(points, i, near, factors);
}

FPPG_AVX2 PairSums sum_pairs_avx2(const PointArrays& points, std::uint32_t i,
                                  std::span<const std::uint32_t> near, const PairFactors& factors)
{
    return sum_pairs(points, i, near, factors);
}

/// A medium beyond a wall: its force on a particle and its share of the kernel's support.
struct Beyond
{
    BandPlane plane;
    double force;
    double share;
};

double cosine(const Beyond& a, const Beyond& b)
{
    return double{a.plane.x * b.plane.x + a.plane.y * b.plane.y + a.plane.z * b.plane.z};
}

/// What lies beyond two walls at once, of shares `a` and `b`: their product where the walls are at
/// right angles (exact for a Gaussian kernel), nothing between walls that face each other, the
/// smaller where they turn little.
double overlap(double a, double b, double cosine)
{
    return cosine < 0 ? (1 + cosine) * a * b : (1 - cosine) * a * b + cosine * std::min(a, b);
}

/// Its derivative by `a`.
double overlap_slope(double a, double b, double cosine)
{
    if (cosine < 0) return (1 + cosine) * b;
    return (1 - cosine) * b + (a < b ? cosine : a > b ? 0 : cosine / 2);
}

/// Adds walls that may meet: what is beyond several counts once.
void add_walls(std::span<const Beyond> walls, VolumeForces::Result& result)
{
    double all = 0;
    for (std::size_t k = 0; k < walls.size(); ++k)
    {
        const Beyond& wall = walls[k];
        double kept = 1;
        double turn = -1;
        for (std::size_t j = 0; j < walls.size(); ++j)
        {
            if (j == k) continue;
            const double c = cosine(wall, walls[j]);
            kept *= 1 - overlap_slope(wall.share, walls[j].share, c);
            if (j < k) turn = std::max(turn, c);
        }
        all += wall.share - (k > 0 ? overlap(wall.share, all, turn) : 0);
        const auto size = static_cast<float>(wall.force * kept);
        result.x -= size * wall.plane.x;
        result.y -= size * wall.plane.y;
        result.z -= size * wall.plane.z;
    }
    result.shepard += all;
}

} // namespace

VolumeForces::VolumeForces(double h, double behind_wall, bool is_2d)
    : beyond_(h, is_2d),
      alpha_(is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h)),
      behind_wall_(behind_wall),
      factors_{static_cast<float>(0.5 / h), static_cast<float>(5 * alpha_ / (h * h)),
               static_cast<float>(double{volume_push_strength} * alpha_)},
      sum_pairs_(is_avx2_there() ? sum_pairs_avx2 : sum_pairs_plain)
{
}

VolumeForces::Result VolumeForces::on(const Band& band, std::uint32_t i,
                                      std::span<const std::uint32_t> near) const
{
    const PairSums pairs = sum_pairs_(band.points, i, near, factors_);
    Result result{pairs.x, pairs.y, pairs.z, alpha_ * (1 + static_cast<double>(pairs.weight))};
    std::array<Beyond, 3> walls;
    std::size_t count = 0;
    for_each_wall(band, i,
                  [&](const BandPlane& plane, float distance)
                  {
                      const double way = double{distance} + behind_wall_;
                      if (way >= beyond_.reach()) return;
                      walls[count++] = {plane, beyond_.force(way), beyond_.share(way)};
                  });
    add_walls(std::span(walls).first(count), result);
    return result;
}

} // namespace fppg
