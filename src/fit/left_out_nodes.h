#pragma once

#include "fit/near_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

namespace fppg
{

inline constexpr std::uint32_t half_dp = distance_units / 2;

/// How many nodes stand in each range of distances, 0.00026 dp wide.
using DistanceCounts = std::vector<std::uint64_t>;

constexpr std::size_t distance_range(std::uint32_t distance)
{
    return distance >> 18U;
}

inline constexpr std::size_t distance_ranges = distance_range(distance_units) + 1;

/// The nodes near the wall on one side of it: which of them are left out. They are counted by
/// ranges of distances first; of the range in which the last of them is, all are then looked at.
class LeftOutNodes
{
public:
    /// Nodes nearer than this are always left out.
    explicit LeftOutNodes(std::uint32_t always_below) : always_below_(always_below) {}

    static std::uint64_t key(std::uint32_t distance, std::uint32_t hash)
    {
        return std::uint64_t{distance} << 32U | hash;
    }
    bool is_always_left_out(std::uint32_t distance) const { return distance < always_below_; }

    /// Leaves out `wanted` nodes, or as near to that as may be; what is still to be settled are the
    /// nodes of one range.
    ///
    /// always  how many are always left out
    /// counts  of the others
    void leave_out(double wanted, std::uint64_t always, const DistanceCounts& counts)
    {
        const std::uint64_t all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
        const double more = std::clamp(std::floor(wanted + 0.5) - static_cast<double>(always), 0.0,
                                       static_cast<double>(all));
        rest_ = static_cast<std::uint64_t>(more);
        below_ = rest_ == 0 ? 0 : UINT64_MAX;
        if (rest_ == 0 || rest_ == all) return;
        std::size_t range = 0;
        for (; counts[range] <= rest_; ++range) rest_ -= counts[range];
        range_ = range;
    }
    bool is_to_settle(std::uint32_t distance) const
    {
        return range_ && !is_always_left_out(distance) && distance_range(distance) == *range_;
    }
    /// keys  of all nodes that are to be settled, in any order
    void settle(std::vector<std::uint64_t> keys)
    {
        if (!range_) return;
        const auto last = keys.begin() + static_cast<std::ptrdiff_t>(rest_);
        std::nth_element(keys.begin(), last, keys.end());
        below_ = *last;
        range_.reset();
    }
    /// Leaves out all nodes nearer than the distance.
    void leave_out_below(std::uint32_t distance) { below_ = key(distance, 0); }

    bool is_left_out(std::uint32_t distance, std::uint32_t hash) const
    {
        return is_always_left_out(distance) || key(distance, hash) < below_;
    }
    /// In dp; the distance that all nodes which stay have at least.
    double clearance() const
    {
        const auto distance =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(below_ >> 32, distance_units));
        return std::max(distance, std::min(always_below_, half_dp)) /
               static_cast<double>(distance_units);
    }

private:
    std::uint32_t always_below_;
    std::uint64_t below_ = 0;          ///< keys below this are left out
    std::optional<std::size_t> range_; ///< to be settled
    std::uint64_t rest_ = 0;           ///< that are left out of it
};

} // namespace fppg
