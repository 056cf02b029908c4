#pragma once

#include "leak/case_solids.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// What is outside of everything that is drawn, on a lattice of its own.
class ClosedHousing
{
public:
    /// Floods the space around all boundary shapes from outside, past nodes that are nearer than
    /// 0.87 of the spacing to a surface. The spacing is dp, more where the box has more than 2^24
    /// nodes.
    ///
    /// fluid    that has to be enclosed
    /// plane_y  of a case in two dimensions; the flood stays in it
    ClosedHousing(const CaseSolids& solids, const std::vector<Vec3>& fluid, double dp,
                  const double* plane_y, int threads);

    /// Whether the flood reaches none of the fluid.
    bool is_closed() const { return is_closed_; }
    /// Whether the node nearest to the point is reached from outside.
    bool is_outside(const Vec3& p) const;

private:
    Vec3 origin_;
    double spacing_ = 0;
    std::array<std::int64_t, 3> n_{0, 0, 0};
    std::vector<std::uint8_t> state_; ///< of the nodes: 0 free, 1 near a surface, 2 outside
    bool is_closed_ = false;
};

} // namespace fppg
