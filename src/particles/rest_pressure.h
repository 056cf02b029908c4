#pragma once

#include "fppg/case_def.h"

namespace fppg
{

/// The pressure of fluid at rest, whose particles stand on the lattice of the case, by depth: that
/// at which the solver's own sums of forces come to gravity.
///
/// Such particles are dp apart at every depth, while their density, and so the volume that the
/// solver gives them, follows the pressure; and the kernel's sums over the lattice are not exact.
/// So a column of the true hydrostatic pressure falls: by 0.007 g at h = 1.73 dp and a speed of
/// sound of 20 sqrt(g H). With C the lattice's sum of the kernel's slope, 1 in the limit, sums of
/// m (P_i + P_j) / (rho_i rho_j) grad W come to gravity where
///     P (rho0 / rho)^2 = rho0 g depth / C,    rho = rho0 (1 + P/B)^(1/gamma).
class RestPressure
{
public:
    /// b  of the equation of state, Pa; above 0
    RestPressure(const CaseDef& def, double b);

    /// Pa at a depth in metres below the level; 0 above.
    double at(double depth) const;
    /// Its inverse.
    double depth_of(double pressure) const;

private:
    double b_;
    double power_; ///< 2 / gamma
    double rise_;  ///< of P / B with depth at the level, 1/m
};

/// C for the kernel of the case, its h and dp, and its dimensions.
double lattice_slope_sum(bool is_cubic, double h_dp, bool is_2d);

} // namespace fppg
