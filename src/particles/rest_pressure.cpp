#include "particles/rest_pressure.h"

#include "relax/kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

/// (dW/dq) / q without alpha of the cubic spline, (1 - 1.5 q^2 + 0.75 q^3) within q = 1.
double cubic_slope(double q)
{
    if (q >= 2) return 0;
    return q < 1 ? -3 + 2.25 * q : -0.75 * (2 - q) * (2 - q) / q;
}

} // namespace

double lattice_slope_sum(bool is_cubic, double h_dp, bool is_2d)
{
    const double cubic_alpha = is_2d ? 10 / (7 * std::numbers::pi * h_dp * h_dp)
                                     : 1 / (std::numbers::pi * h_dp * h_dp * h_dp);
    const double alpha = is_cubic ? cubic_alpha
                         : is_2d  ? wendland_alpha_2d(h_dp)
                                  : wendland_alpha_3d(h_dp);
    const int reach = static_cast<int>(2 * h_dp);
    double sum = 0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = is_2d ? 0 : -reach; y <= (is_2d ? 0 : reach); ++y)
            for (int z = -reach; z <= reach; ++z)
            {
                const double q = std::sqrt(x * x + y * y + z * z) / h_dp;
                if (q > 0) sum -= (is_cubic ? cubic_slope(q) : wendland_slope(q)) * z * z;
            }
    return alpha * sum / (h_dp * h_dp);
}

RestPressure::RestPressure(const CaseDef& def, double b)
    : b_(b),
      power_(2 / def.constants.gamma),
      rise_(def.constants.rhop0 * norm(def.constants.gravity) /
            (def.fluid_fullness *
             lattice_slope_sum(def.solver.kernel == 1, def.h / def.grid.dp, def.grid.is_2d) * b))
{
}

double RestPressure::at(double depth) const
{
    if (depth <= 0) return 0;
    // Newton's method for u = 1 + P / B, from the pressure of water that is not compressed.
    constexpr int steps = 5;
    double u = 1 + rise_ * depth;
    for (int step = 0; step < steps; ++step)
    {
        const double off = (u - 1) - rise_ * depth * std::pow(u, power_);
        u -= off / (1 - power_ * (u - 1) / u);
    }
    return b_ * (u - 1);
}

double RestPressure::depth_of(double pressure) const
{
    const double p = std::max(0.0, pressure) / b_;
    return p * std::pow(1 + p, -power_) / rise_;
}

} // namespace fppg
