#include "nodes/domain.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{

void expect_near(const Box3& bounds, const LatticeGrid& grid)
{
    constexpr double most = 2147483648.0; // dp
    for (int axis = 0; axis < 3; ++axis)
    {
        if (axis == 1 && grid.is_2d) continue;
        const double low = (bounds.min[axis] - grid.origin[axis]) / grid.step(axis);
        const double high = (bounds.max[axis] - grid.origin[axis]) / grid.step(axis);
        if (!(std::abs(low) + 3 < most && std::abs(high) + 3 < most))
            throw GeometryError(fmt::format(
                "the mesh reaches from {:.6g} to {:.6g} m along {}, more than 2^31 dp of {:.6g} m",
                bounds.min[axis], bounds.max[axis], "xyz"[axis], grid.dp));
    }
}

} // namespace fppg
