#pragma once

#include <numbers>

namespace fppg
{

// The quintic kernel of Wendland with continuous second derivatives (C2): W = alpha_d w(q) with
// q = r / h and support 2 h. Source: Wendland (1995); the FPPG paper, equations 16 and 17. There q
// is called the dimension and alpha_3 is printed as 21 / (6 pi h^3); q is the distance over h, and
// the integral over the support is 1 for the factors below only.

/// Shape of the kernel, 1 at q = 0; q not negative.
template <typename Real>
constexpr Real wendland(Real q)
{
    if (q >= Real(2)) return 0;
    const Real s = 1 - q / 2;
    return s * s * s * s * (2 * q + 1);
}

/// (dw/dq) / q, which has no singularity: the gradient of W is alpha_d wendland_slope(q) / h^2
/// times the vector from the other particle.
template <typename Real>
constexpr Real wendland_slope(Real q)
{
    if (q >= Real(2)) return 0;
    const Real s = 1 - q / 2;
    return -5 * s * s * s;
}

/// alpha_d in the plane: the integral of w over the disc of radius 2 is 4 pi / 7.
constexpr double wendland_alpha_2d(double h)
{
    return 7 / (4 * std::numbers::pi * h * h);
}

/// alpha_d in space: the integral of w over the ball of radius 2 is 16 pi / 21.
constexpr double wendland_alpha_3d(double h)
{
    return 21 / (16 * std::numbers::pi * h * h * h);
}

/// The same for the cubic spline of Monaghan, W = alpha_d (1 - 3/2 q^2 + 3/4 q^3) up to q = 1 and
/// alpha_d / 4 (2 - q)^3 up to 2.
constexpr double cubic_spline_alpha_2d(double h)
{
    return 10 / (7 * std::numbers::pi * h * h);
}

constexpr double cubic_spline_alpha_3d(double h)
{
    return 1 / (std::numbers::pi * h * h * h);
}

} // namespace fppg
