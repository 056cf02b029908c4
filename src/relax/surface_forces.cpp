#include "relax/surface_forces.h"

#include "core/lanes.h"
#include "relax/kernel.h"

#include <cmath>

namespace fppg
{

namespace
{

constexpr float spread_reach = 1.05f;
constexpr float spread_strength = 0.85f;
constexpr float push_reach = 0.8f;
constexpr float push_strength = 4;
/// Of the six around a particle this many are within reach of the wider push where it is crowded.
constexpr double neighbours_in_push = 4;
/// Keeps the direction of the push finite where two particles coincide.
constexpr float least_distance = 1e-4f;
constexpr float no_neighbour = 1e30f;

FPPG_LANES void compute_rows(const SurfaceForces::Rows& rows, const PackedPoint* points,
                             const SurfaceForces& of, PointArrays& forces,
                             std::vector<float>& nearest_squared)
{
    const float half_inverse_h = of.half_inverse_h();
    const float factor = of.factor();
    const Lanes none{};
    for (std::size_t row = rows.begin; row < rows.end; ++row)
    {
        const auto neighbours = rows.list.neighbours(row);
        if (neighbours.empty()) continue;
        const std::uint32_t i = rows.list.point(row);
        Lanes x{}, y{}, z{};
        Lanes nearest = lanes_of(no_neighbour);
        NeighbourLanes(PackedGather{points}, i)
            .for_each(neighbours.data(), neighbours.size(),
                      [&](const LaneOffsets& o)
                      {
                          const Lanes r = square_root(o.squared);
                          const Lanes s = larger(none, 1 - r * half_inverse_h);
                          const Lanes t = larger(none, 1 - r * (1 / push_reach));
                          const Lanes u = larger(none, 1 - r * (1 / spread_reach));
                          const Lanes f =
                              factor * (s * s * s) + (push_strength * t + spread_strength * u) /
                                                         larger(r, lanes_of(least_distance));
                          x += f * o.x;
                          y += f * o.y;
                          z += f * o.z;
                          nearest = smaller(nearest, o.squared);
                      });
        forces.x[i] = sum_of(x);
        forces.y[i] = sum_of(y);
        forces.z[i] = sum_of(z);
        nearest_squared[i] = smallest_of(nearest);
    }
}

void compute_plain(const SurfaceForces::Rows& rows, const PackedPoint* points,
                   const SurfaceForces& of, PointArrays& forces,
                   std::vector<float>& nearest_squared)
{
    compute_rows(rows, points, of, forces, nearest_squared);
}

FPPG_AVX2 void compute_avx2(const SurfaceForces::Rows& rows, const PackedPoint* points,
                            const SurfaceForces& of, PointArrays& forces,
                            std::vector<float>& nearest_squared)
{
    compute_rows(rows, points, of, forces, nearest_squared);
}

} // namespace

double SurfaceForces::stiffness_of_push()
{
    return neighbours_in_push * double{spread_strength} / double{spread_reach};
}

SurfaceForces::SurfaceForces(float h) : half_inverse_h_(0.5f / h), factor_(5 / (h * h)) {}

void SurfaceForces::compute(const Rows& rows, const PackedPoint* points, PointArrays& forces,
                            std::vector<float>& nearest_squared) const
{
    (is_avx2_there() ? compute_avx2 : compute_plain)(rows, points, *this, forces, nearest_squared);
}

double stiffest_mode(double h)
{
    // Rows of the layer, and samples of the wave vector over one cell of the reciprocal lattice.
    const double a = std::sqrt(2 / std::numbers::sqrt3);
    const double height = a * std::numbers::sqrt3 / 2;
    constexpr int samples = 48;
    const int rows = static_cast<int>(std::ceil(2 * h / height)) + 1;
    const double unit = 2 * std::numbers::pi / samples;
    double largest = 0;
    // Nested because every wave vector of a plane is summed over every neighbour in it.
    for (int p = 0; p < samples; ++p)
        for (int q = 0; q < samples; ++q)
        {
            double xx = 0;
            double xy = 0;
            double yy = 0;
            for (int i = -2 * rows; i <= 2 * rows; ++i)
                for (int j = -rows; j <= rows; ++j)
                {
                    const double x = a * (i + 0.5 * j);
                    const double y = height * j;
                    const double r = std::sqrt(x * x + y * y);
                    if (r == 0 || r >= 2 * h) continue;
                    const double s = 1 - r / (2 * h);
                    const double across = wendland_slope(r / h) / (h * h);
                    const double bend = 15 * s * s * r / (2 * h * h * h) / (r * r);
                    const double weight = 1 - std::cos(unit * (p * i + q * j));
                    xx += weight * (across + bend * x * x);
                    xy += weight * bend * x * y;
                    yy += weight * (across + bend * y * y);
                }
            const double half = 0.5 * (xx - yy);
            largest = std::max(largest, 0.5 * (xx + yy) + std::sqrt(half * half + xy * xy));
        }
    return largest;
}

} // namespace fppg
