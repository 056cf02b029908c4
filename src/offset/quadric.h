#pragma once

#include "fppg/vec.h"

#include <array>

namespace fppg
{

/// The sum of squared distances to some planes.
class Quadric
{
public:
    /// The plane normal . x = offset, of unit normal.
    void add_plane(const Vec3& normal, double offset);
    /// The point of least sum, and of all of these the one nearest to the origin. Directions in
    /// which the planes turn by less than about 18 degrees count as flat.
    ///
    /// least_share  eigenvalues below this share of the largest are taken for zero
    Vec3 least_point(double least_share = 0.025) const;

private:
    std::array<Vec3, 3> matrix_{};
    Vec3 right_;
};

} // namespace fppg
