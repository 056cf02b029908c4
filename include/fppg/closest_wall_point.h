#pragma once

#include "fppg/vec.h"

#include <functional>
#include <limits>
#include <type_traits>
#include <utility>

namespace fppg
{

/// The point of all walls that is nearest to a given one; metres. Called from several threads at
/// once. Made from f(point), or from f(point, within), which need not look farther than
/// `within`, metres: where no wall is so near it may return one that is farther, or a point at
/// infinity. Empty unless made from one of these.
class ClosestWallPoint
{
public:
    ClosestWallPoint() = default;
    template <typename F>
    requires std::is_invocable_r_v<Vec3, const F&, const Vec3&, double> ClosestWallPoint(F find)
        : find_(std::move(find))
    {
    }
    template <typename F>
    requires(std::is_invocable_r_v<Vec3, const F&, const Vec3&> &&
             !std::is_invocable_v<const F&, const Vec3&, double>) ClosestWallPoint(F find)
        : find_([find = std::move(find)](const Vec3& point, double) { return find(point); })
    {
    }

    explicit operator bool() const { return static_cast<bool>(find_); }
    Vec3 operator()(const Vec3& point,
                    double within = std::numeric_limits<double>::infinity()) const
    {
        return find_(point, within);
    }

private:
    std::function<Vec3(const Vec3&, double)> find_;
};

} // namespace fppg
