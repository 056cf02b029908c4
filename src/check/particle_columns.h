#pragma once

#include "fppg/vec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Particles in columns along z, in a column by z: a search reads little more than what it finds,
/// however thin or empty the domain is. It never changes, so many threads may search it.
class ParticleColumns
{
public:
    /// chosen  indices of `positions`, which must be finite
    /// width   of a column, metres; wider where there would be many more columns than particles
    ParticleColumns(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& chosen,
                    double width, int threads);

    /// Calls stop(index, way from p to the particle, squared distance) for the particles within
    /// `radius` of p until it returns true; whether it did.
    template <typename Stop>
    bool find_near(const Vec3& p, double radius, const Stop& stop) const
    {
        if (points_.empty()) return false;
        const std::int64_t x1 = column(p.x + radius, 0);
        const std::int64_t y0 = column(p.y - radius, 1), y1 = column(p.y + radius, 1);
        for (std::int64_t x = column(p.x - radius, 0); x <= x1; ++x)
            for (std::int64_t y = y0; y <= y1; ++y)
            {
                const auto at = static_cast<std::size_t>(x * n_[1] + y);
                const auto end = points_.begin() + begins_[at + 1];
                auto it = std::lower_bound(points_.begin() + begins_[at], end, p.z - radius,
                                           [](const Vec3& q, double z) { return q.z < z; });
                for (; it != end && it->z <= p.z + radius; ++it)
                {
                    const Vec3 way = *it - p;
                    const double squared = dot(way, way);
                    if (squared <= radius * radius &&
                        stop(indices_[static_cast<std::size_t>(it - points_.begin())], way,
                             squared))
                        return true;
                }
            }
        return false;
    }

private:
    /// Clamped to the columns that there are.
    std::int64_t column(double place, int axis) const
    {
        const double at = std::floor((place - least_[axis]) / width_);
        return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(n_[axis] - 1)));
    }

    double width_ = 1;
    Vec3 least_;
    std::int64_t n_[2] = {1, 1};
    std::vector<std::uint32_t> begins_;  ///< per column, and the end
    std::vector<Vec3> points_;           ///< by column, then z
    std::vector<std::uint32_t> indices_; ///< of the same
};

} // namespace fppg
