#pragma once

#include "offset/wall_depth.h"

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace fppg
{

/// How deep a point is, and which way the depth grows.
struct DepthSlope
{
    Vec3 direction; ///< unit
    double depth = 0;
};

/// Asks a wall for depths, once for each point; may be asked from many threads. The finding of
/// creases asks three times for the same ones, and each costs a search for the nearest facet.
class DepthMemo
{
public:
    /// wall  must outlive the object
    explicit DepthMemo(const WallDepth& wall) : wall_(wall) {}

    DepthSlope at(const Vec3& p) const;

private:
    struct Hash
    {
        std::size_t operator()(const Vec3& p) const;
    };
    /// A part of the points with its lock.
    struct Part
    {
        std::mutex mutex;
        std::unordered_map<Vec3, DepthSlope, Hash> known;
    };
    static constexpr std::size_t part_count = 64;

    const WallDepth& wall_;
    std::unique_ptr<std::array<Part, part_count>> parts_ =
        std::make_unique<std::array<Part, part_count>>();
};

} // namespace fppg
