#include "offset/quadric.h"

#include "core/principal_axes.h"

#include <algorithm>

namespace fppg
{
void Quadric::add_plane(const Vec3& normal, double offset)
{
    for (int i = 0; i < 3; ++i)
        matrix_[static_cast<std::size_t>(i)] =
            matrix_[static_cast<std::size_t>(i)] + normal[i] * normal;
    right_ = right_ + offset * normal;
}

Vec3 Quadric::least_point(double least_share) const
{
    const PrincipalAxes found = principal_axes(matrix_);
    const double largest = std::max({found.values.x, found.values.y, found.values.z});
    Vec3 out;
    for (int i = 0; i < 3; ++i)
    {
        const double value = found.values[i];
        if (!(value > least_share * largest)) continue;
        const Vec3& way = found.axes[static_cast<std::size_t>(i)];
        out = out + (dot(way, right_) / value) * way;
    }
    return out;
}

} // namespace fppg
