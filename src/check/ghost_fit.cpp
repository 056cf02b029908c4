#include "check/ghost_fit.h"

#include <limits>
#include <numbers>

namespace fppg
{

namespace
{

constexpr std::size_t most_rows = 4;
using MomentMatrix = std::array<std::array<double, most_rows>, most_rows>;

double infinity_norm(const MomentMatrix& a, std::size_t n)
{
    double most = 0;
    for (std::size_t row = 0; row < n; ++row)
    {
        double sum = 0;
        for (std::size_t column = 0; column < n; ++column) sum += std::abs(a[row][column]);
        most = std::max(most, sum);
    }
    return most;
}

/// Turns a matrix into its inverse by elimination with pivots.
///
/// returns  the determinant; at 0 the matrix is left as no inverse
double invert(MomentMatrix& a, std::size_t n)
{
    MomentMatrix inverse{};
    for (std::size_t i = 0; i < n; ++i) inverse[i][i] = 1;
    double determinant = 1;
    for (std::size_t c = 0; c < n; ++c)
    {
        std::size_t pivot = c;
        for (std::size_t r = c + 1; r < n; ++r)
            if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
        if (a[pivot][c] == 0) return 0;
        if (pivot != c)
        {
            std::swap(a[pivot], a[c]);
            std::swap(inverse[pivot], inverse[c]);
            determinant = -determinant;
        }
        determinant *= a[c][c];
        const double factor = 1 / a[c][c];
        for (std::size_t k = 0; k < n; ++k)
        {
            a[c][k] *= factor;
            inverse[c][k] *= factor;
        }
        for (std::size_t r = 0; r < n; ++r)
        {
            const double part = a[r][c];
            if (r == c || part == 0) continue;
            for (std::size_t k = 0; k < n; ++k)
            {
                a[r][k] -= part * a[c][k];
                inverse[r][k] -= part * inverse[c][k];
            }
        }
    }
    a = inverse;
    return determinant;
}

} // namespace

std::vector<Vec3> periodic_ways(const CheckSetup& setup)
{
    std::vector<Vec3> ways{{}};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (!setup.is_periodic[axis]) continue;
        const std::size_t known = ways.size();
        for (std::size_t k = 0; k < known; ++k)
        {
            ways.push_back(ways[k] + setup.periodic[axis]);
            ways.push_back(ways[k] - setup.periodic[axis]);
        }
    }
    return ways;
}

GhostFit fit_at_ghost(const FluidAround& fluid, const Vec3& ghost, const CheckSetup& setup)
{
    const double h = setup.h;
    // Wendland (1995), quintic: 7/(4 pi h^2) in 2D, 21/(16 pi h^3) in 3D.
    const double scale =
        setup.is_2d ? 7 / (4 * std::numbers::pi * h * h) : 21 / (16 * std::numbers::pi * h * h * h);
    const std::size_t n = setup.is_2d ? 3 : 4;
    MomentMatrix a{};
    fluid.find_near(ghost, 2 * h,
                    [&](const Vec3& to, double squared, bool)
                    {
                        const double q = std::sqrt(squared) / h;
                        const double u = std::max(0.0, 1 - q / 2);
                        const double kernel = setup.volume * scale * u * u * u * u * (2 * q + 1);
                        const double slope = -5 * setup.volume * scale * u * u * u / (h * h);
                        const double away[3] = {-to.x, setup.is_2d ? -to.z : -to.y, -to.z};
                        for (std::size_t row = 0; row < n; ++row)
                        {
                            const double weight = row == 0 ? kernel : slope * away[row - 1];
                            a[row][0] += weight;
                            for (std::size_t k = 1; k < n; ++k) a[row][k] += away[k - 1] * weight;
                        }
                        return false;
                    });
    GhostFit fit;
    fit.kernel_sum = a[0][0];
    const double norm_of_matrix = infinity_norm(a, n);
    fit.determinant = invert(a, n);
    fit.condition = std::abs(fit.determinant) < 1e-3
                        ? std::numeric_limits<double>::infinity()
                        : setup.dp * setup.dp * norm_of_matrix * infinity_norm(a, n);
    return fit;
}

} // namespace fppg
