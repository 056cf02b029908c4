#pragma once

#include "fppg/vec.h"

#include <array>

namespace fppg
{

/// The eigenvalues of a symmetric matrix of 3 x 3 numbers, each with its eigenvector.
struct PrincipalAxes
{
    Vec3 values;
    std::array<Vec3, 3> axes; ///< of length 1, at right angles to one another
};

/// By Jacobi's rotations, to rounding; in no order.
///
/// rows  of the matrix
PrincipalAxes principal_axes(std::array<Vec3, 3> rows);

} // namespace fppg
