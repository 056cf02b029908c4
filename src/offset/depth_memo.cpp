#include "offset/depth_memo.h"

#include <bit>
#include <cstdint>

namespace fppg
{
namespace
{

/// Points that are kept, in all parts: 200 MB. Later ones are asked each time.
constexpr std::size_t most_points = std::size_t{1} << 21;

} // namespace

std::size_t DepthMemo::Hash::operator()(const Vec3& p) const
{
    std::uint64_t h = 0;
    for (const double x : {p.x, p.y, p.z})
    {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u;
        h ^= h >> 32;
    }
    return h;
}

DepthSlope DepthMemo::at(const Vec3& p) const
{
    Part& part = (*parts_)[Hash{}(p) >> 8 & (part_count - 1)];
    {
        const std::lock_guard lock(part.mutex);
        const auto found = part.known.find(p);
        if (found != part.known.end()) return found->second;
    }
    const DepthPlace place = wall_.at(p);
    const DepthSlope out{place.direction, place.depth};
    const std::lock_guard lock(part.mutex);
    if (part.known.size() < most_points / part_count) part.known.emplace(p, out);
    return out;
}

} // namespace fppg
