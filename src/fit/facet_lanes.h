#pragma once

#include "fppg/vec.h"

#include "core/lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace fppg
{

/// Four points beside one another along z.
struct PointsAlongZ
{
    double x = 0, y = 0;
    DoubleLanes z{};

    FPPG_LANES DoubleLanes along(const Vec3& way, const Vec3& from) const
    {
        return way.x * (x - from.x) + way.y * (y - from.y) + way.z * (z - from.z);
    }
};

/// One facet made ready for the distances of many points. The squared distance is right to
/// rounding; facets lower than 1e-8 of their longest side count as their three sides.
class FacetDistance
{
public:
    explicit FacetDistance(const Vec3* corners)
    {
        for (std::size_t s = 0; s < 3; ++s)
        {
            corners_[s] = corners[s];
            sides_[s] = corners[(s + 1) % 3] - corners[s];
            const double squared = dot(sides_[s], sides_[s]);
            side_inverse_[s] = squared > 0 ? 1 / squared : 0;
        }
        normal_ = cross(sides_[0], sides_[1]);
        const double squared = dot(normal_, normal_);
        const double longest = std::max(
            {dot(sides_[0], sides_[0]), dot(sides_[1], sides_[1]), dot(sides_[2], sides_[2])});
        if (!(squared > 1e-16 * longest * longest)) return;
        inverse_ = 1 / squared;
        for (std::size_t s = 0; s < 3; ++s) inwards_[s] = cross(normal_, sides_[s]);
    }

    /// From where to where along z points with an x and a y may be within a reach of the plane of
    /// the facet; no bounds where it is steep.
    std::array<double, 2> within_plane(double x, double y, double reach) const
    {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        constexpr double steep = 1e-3, room = 1 + 1e-9;
        const double squared = dot(normal_, normal_);
        if (!(inverse_ > 0) || normal_.z * normal_.z < steep * steep * squared)
            return {-infinity, infinity};
        const Vec3& c = corners_[0];
        const double middle = (normal_.x * (x - c.x) + normal_.y * (y - c.y)) / normal_.z;
        const double half = room * reach * std::sqrt(squared) / std::abs(normal_.z);
        return {c.z - middle - half, c.z - middle + half};
    }

    /// The squared distances to the facet, or those of `limit` where they are not below.
    FPPG_LANES DoubleLanes squared(const PointsAlongZ& p, const DoubleLanes& limit) const
    {
        const DoubleLanes height = p.along(normal_, corners_[0]);
        const DoubleLanes to_plane = height * height * inverse_; // 0: the facet is but its sides
        if (!is_any_set(to_plane < limit)) return limit;
        const DoubleLanes ab = p.along(inwards_[0], corners_[0]);
        const DoubleLanes bc = p.along(inwards_[1], corners_[1]);
        const DoubleLanes ca = p.along(inwards_[2], corners_[0]);
        const DoubleMask is_above =
            inverse_ > 0 ? (ab >= 0.0) & (bc >= 0.0) & (ca >= 0.0) : DoubleMask{};
        DoubleLanes best = is_above ? smaller(to_plane, limit) : limit;
        // The nearest point lies on a side that the point is beyond.
        const std::array<DoubleMask, 3> is_beyond{~is_above & ~(ab > 0.0), ~is_above & ~(bc > 0.0),
                                                  ~is_above & ~(ca > 0.0)};
        for (std::size_t s = 0; s < 3; ++s)
            if (is_any_set(is_beyond[s])) best = is_beyond[s] ? smaller(best, to_side(p, s)) : best;
        return best;
    }

private:
    FPPG_LANES DoubleLanes to_side(const PointsAlongZ& p, std::size_t s) const
    {
        const DoubleLanes share =
            smaller(larger(p.along(sides_[s], corners_[s]) * side_inverse_[s], DoubleLanes{}),
                    DoubleLanes{} + 1);
        const DoubleLanes x = (p.x - corners_[s].x) - share * sides_[s].x;
        const DoubleLanes y = (p.y - corners_[s].y) - share * sides_[s].y;
        const DoubleLanes z = (p.z - corners_[s].z) - share * sides_[s].z;
        return x * x + y * y + z * z;
    }

    std::array<Vec3, 3> corners_, sides_, inwards_{};
    std::array<double, 3> side_inverse_;
    Vec3 normal_;        ///< not of unit length
    double inverse_ = 0; ///< of its squared length; 0 where the facet is but its sides
};

} // namespace fppg
