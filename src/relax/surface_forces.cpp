#include "relax/surface_forces.h"

#include "relax/kernel.h"

#include <cmath>

namespace fppg
{

namespace
{

constexpr float push_reach = 0.8f;
constexpr float push_strength = 4;
/// Keeps the direction of the push finite where two particles coincide.
constexpr float least_distance = 1e-4f;
constexpr float no_neighbour = 1e30f;

} // namespace

SurfaceForces::SurfaceForces(float h) : half_inverse_h_(0.5f / h), factor_(5 / (h * h)) {}

void SurfaceForces::compute(const NeighbourList& list, std::size_t begin, std::size_t end,
                            const PointArrays& points, PointArrays& forces,
                            std::vector<float>& nearest_squared) const
{
    const float* xs = points.x.data();
    const float* ys = points.y.data();
    const float* zs = points.z.data();
    const float half_inverse_h = half_inverse_h_;
    const float factor = factor_;
    for (std::size_t row = begin; row < end; ++row)
    {
        const auto neighbours = list.neighbours(row);
        const std::uint32_t* indices = neighbours.data();
        const std::size_t n = neighbours.size();
        const std::uint32_t i = list.point(row);
        const float x = xs[i];
        const float y = ys[i];
        const float z = zs[i];
        float fx = 0;
        float fy = 0;
        float fz = 0;
        float nearest = no_neighbour;
#pragma omp simd reduction(+ : fx, fy, fz) reduction(min : nearest)
        for (std::size_t k = 0; k < n; ++k)
        {
            const std::uint32_t j = indices[k];
            const float dx = x - xs[j];
            const float dy = y - ys[j];
            const float dz = z - zs[j];
            const float squared = dx * dx + dy * dy + dz * dz;
            const float r = std::sqrt(squared);
            const float s = 1 - r * half_inverse_h;
            const float t = 1 - r * (1 / push_reach);
            const float kernel = s > 0 ? factor * s * s * s : 0;
            const float push = t > 0 ? push_strength * t : 0;
            const float f = kernel + push / (r > least_distance ? r : least_distance);
            fx += f * dx;
            fy += f * dy;
            fz += f * dz;
            nearest = squared < nearest ? squared : nearest;
        }
        forces.x[i] = fx;
        forces.y[i] = fy;
        forces.z[i] = fz;
        nearest_squared[i] = nearest;
    }
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
                    const double r = std::hypot(x, y);
                    if (r == 0 || r >= 2 * h) continue;
                    const double s = 1 - r / (2 * h);
                    const double across = wendland_slope(r / h) / (h * h);
                    const double bend = 15 * s * s * r / (2 * h * h * h) / (r * r);
                    const double weight = 1 - std::cos(unit * (p * i + q * j));
                    xx += weight * (across + bend * x * x);
                    xy += weight * bend * x * y;
                    yy += weight * (across + bend * y * y);
                }
            largest = std::max(largest, 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
        }
    return largest;
}

} // namespace fppg
