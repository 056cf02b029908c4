#pragma once

#include "fppg/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Blocks of the lattice, a few nodes a side, that have a wall particle in or beside them.
class NearBlocks
{
public:
    /// side   of a block, nodes
    /// reach  how many blocks beyond that of the particle count
    NearBlocks(const std::vector<Vec3>& points, const LatticeGrid& grid, std::uint32_t side,
               int reach)
        : side_(side)
    {
        std::vector<std::array<std::int64_t, 3>> cores;
        for (const Vec3& p : points)
        {
            std::array<std::int64_t, 3> block{};
            for (int axis = 0; axis < 3; ++axis)
                block[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(
                    std::floor((p[axis] - grid.origin[axis]) / grid.dp / side));
            if (cores.empty() || cores.back() != block) cores.push_back(block);
        }
        std::sort(cores.begin(), cores.end());
        cores.erase(std::unique(cores.begin(), cores.end()), cores.end());
        // Nested because the blocks around one are walked along three axes.
        for (const auto& c : cores)
            for (std::int64_t x = c[0] - reach; x <= c[0] + reach; ++x)
                for (std::int64_t y = c[1] - reach; y <= c[1] + reach; ++y)
                    for (std::int64_t z = c[2] - reach; z <= c[2] + reach; ++z)
                        if (x >= 0 && y >= 0 && z >= 0) keys_.push_back(key(x, y, z));
        std::sort(keys_.begin(), keys_.end());
        keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    }

    /// Calls visit(z begin, z end) for the stretches of a column that lie in blocks.
    template <typename Visit>
    void for_each_stretch(std::uint32_t x, const Run& run, const Visit& visit) const
    {
        const auto first = key(x / side_, run.y / side_, run.z_begin / side_);
        for (auto at = std::lower_bound(keys_.begin(), keys_.end(), first); at != keys_.end(); ++at)
        {
            if (*at >> 21 != first >> 21) break;
            const auto begin = static_cast<std::uint32_t>(*at & 0x1FFFFF) * side_;
            if (begin >= run.z_end) break;
            visit(std::max(begin, run.z_begin), std::min(begin + side_, run.z_end));
        }
    }

private:
    static std::uint64_t key(std::uint64_t x, std::uint64_t y, std::uint64_t z)
    {
        return x << 42 | y << 21 | z;
    }
    template <typename A>
    static std::uint64_t key(A x, A y, A z)
    {
        return key(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                   static_cast<std::uint64_t>(z));
    }

    std::uint32_t side_;
    std::vector<std::uint64_t> keys_;
};

} // namespace fppg
