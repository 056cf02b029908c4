#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <vector>

namespace fppg
{

/// Of points those farthest along 26 directions: the fastest one of a rigid body is nearly as fast
/// as the fastest of them.
class FarthestPoints
{
public:
    void add(const Vec3& p)
    {
        std::size_t way = 0;
        if (points_.empty()) points_.assign(26, p);
        for (const double x : {-1.0, 0.0, 1.0})
            for (const double y : {-1.0, 0.0, 1.0})
                for (const double z : {-1.0, 0.0, 1.0})
                {
                    const Vec3 along{x, y, z};
                    if (along == Vec3{}) continue;
                    if (dot(p, along) > dot(points_[way], along)) points_[way] = p;
                    ++way;
                }
    }
    /// 26, or none where there is no point.
    const std::vector<Vec3>& points() const { return points_; }

private:
    std::vector<Vec3> points_;
};

} // namespace fppg
