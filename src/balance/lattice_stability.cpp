#include "balance/lattice_stability.h"

#include "core/principal_axes.h"
#include "relax/kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace fppg
{
namespace
{

/// rho c^2 / P at the bottom of water of depth H, with the usual speed of sound c = 20 sqrt(g H).
/// From 50 to 4,000 the eigenvalues are the same.
constexpr double stiffness = 400;
constexpr int waves_2d = 16; ///< along each reciprocal vector
constexpr int waves_3d = 10;
constexpr double ratio_step = 0.02;
constexpr double least_ratio = 0.48;
constexpr double most_ratio_2d = 1.02;
constexpr double most_ratio_3d = 0.8;
/// In 2D, in place of an eigenvalue across the plane.
constexpr double across_plane = 1e6;

/// The first and second derivative of a kernel whose sum over all particles is about 1, over dp.
struct Slopes
{
    double first = 0, second = 0;
};

Slopes slopes_of(const LatticeKernel& kernel, double r)
{
    const double h = kernel.h_dp, q = r / h;
    if (kernel.is_cubic)
    {
        const double alpha = kernel.is_2d ? cubic_spline_alpha_2d(h) : cubic_spline_alpha_3d(h);
        if (q > 1) return {-0.75 * alpha / h * (2 - q) * (2 - q), 1.5 * alpha / (h * h) * (2 - q)};
        return {alpha / h * (2.25 * q - 3) * q, alpha / (h * h) * (4.5 * q - 3)};
    }
    const double alpha = kernel.is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h);
    const double s = 1 - q / 2;
    return {alpha / h * q * wendland_slope(q), alpha / (h * h) * 5 * s * s * (2 * q - 1)};
}

/// Three vectors that span a lattice; in 2D the second is across the plane.
using Basis = std::array<Vec3, 3>;

Basis basis_of(const LatticeKernel& kernel, const std::optional<LayeredLattice>& lattice)
{
    if (!lattice) return {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const double ratio = lattice->ratio;
    const double step = kernel.is_2d ? std::sqrt(1 / ratio) : std::cbrt(1 / ratio);
    if (kernel.is_2d) return {Vec3{step, 0, 0}, Vec3{0, 1, 0}, Vec3{step / 2, 0, ratio * step}};
    return {Vec3{step, 0, 0}, Vec3{0, step, 0}, Vec3{step / 2, step / 2, ratio * step}};
}

struct Neighbour
{
    std::array<int, 3> steps{}; ///< along the basis
    std::array<Vec3, 3> force;  ///< rows of the second derivatives of the potential
    Vec3 slope;                 ///< of the kernel
};

std::vector<Neighbour> neighbours_of(const LatticeKernel& kernel, const Basis& basis)
{
    // Layers are nearer to one another than dp/2 in no lattice.
    const int n = static_cast<int>(std::ceil(4 * kernel.h_dp)) + 1, across = kernel.is_2d ? 0 : n;
    std::vector<Neighbour> out;
    // Nested because a lattice has three directions.
    for (int a = -n; a <= n; ++a)
        for (int b = -across; b <= across; ++b)
            for (int c = -n; c <= n; ++c)
            {
                const Vec3 to = double(a) * basis[0] + double(b) * basis[1] + double(c) * basis[2];
                const double r = norm(to);
                if (r == 0 || r >= 2 * kernel.h_dp) continue;
                const Vec3 along = to / r;
                const Slopes slopes = slopes_of(kernel, r);
                Neighbour near{{a, b, c}, {}, slopes.first * along};
                for (int k = 0; k < 3; ++k)
                {
                    near.force[k] = 2 * (slopes.second - slopes.first / r) * along[k] * along;
                    near.force[k][k] += 2 * slopes.first / r;
                }
                out.push_back(near);
            }
    return out;
}

/// wave  of a period: of the phases along the basis
double least_eigenvalue(const std::vector<Neighbour>& neighbours, const Vec3& wave, bool is_2d)
{
    std::array<Vec3, 3> rows{};
    Vec3 density;
    for (const Neighbour& near : neighbours)
    {
        const double phase =
            2 * std::numbers::pi *
            (wave.x * near.steps[0] + wave.y * near.steps[1] + wave.z * near.steps[2]);
        const double share = 1 - std::cos(phase);
        for (int k = 0; k < 3; ++k) rows[k] = rows[k] + share * near.force[k];
        density = density + std::sin(phase) * near.slope;
    }
    for (int k = 0; k < 3; ++k) rows[k] = rows[k] + stiffness * density[k] * density;
    if (is_2d) rows[1] = {0, across_plane, 0};
    const Vec3 values = principal_axes(rows).values;
    return std::min({values.x, values.y, values.z});
}

} // namespace

double lattice_stability(const LatticeKernel& kernel, const std::optional<LayeredLattice>& lattice)
{
    const std::vector<Neighbour> neighbours = neighbours_of(kernel, basis_of(kernel, lattice));
    const int n = kernel.is_2d ? waves_2d : waves_3d;
    double least = std::numeric_limits<double>::infinity();
    // Nested because waves have three directions; opposite ones are alike.
    for (int a = 0; a <= n / 2; ++a)
        for (int b = 0; b < (kernel.is_2d ? 1 : n); ++b)
            for (int c = 0; c < n; ++c)
            {
                if (a == 0 && b == 0 && c == 0) continue;
                const Vec3 wave = Vec3{double(a), double(b), double(c)} / n;
                double springs = 0;
                for (int k = 0; k < 3; ++k)
                    springs +=
                        (1 - std::cos(2 * std::numbers::pi * wave[k])) / (kernel.is_2d ? 4 : 6);
                least = std::min(least, least_eigenvalue(neighbours, wave, kernel.is_2d) / springs);
            }
    return least;
}

std::optional<LayeredLattice> most_stable_lattice(const LatticeKernel& kernel)
{
    const double last = kernel.is_2d ? most_ratio_2d : most_ratio_3d;
    std::vector<double> stability;
    for (int k = 0; least_ratio + k * ratio_step < last + ratio_step / 2; ++k)
        stability.push_back(
            lattice_stability(kernel, LayeredLattice{least_ratio + k * ratio_step}));
    double most = lattice_stability(kernel, {});
    std::optional<LayeredLattice> out;
    for (std::size_t k = 1; k + 1 < stability.size(); ++k)
    {
        const double here = std::min({stability[k - 1], stability[k], stability[k + 1]});
        if (here <= most) continue;
        most = here;
        out = LayeredLattice{least_ratio + static_cast<double>(k) * ratio_step};
    }
    return out;
}

} // namespace fppg
