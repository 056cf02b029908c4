#pragma once

#include "core/parallel.h"
#include "fppg/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace fppg
{

/// Blocks of the lattice, a few nodes a side, that have a wall particle in or beside them.
class NearBlocks
{
public:
    /// side      of a block, nodes
    /// reach     how many blocks beyond that of the particle count
    /// is_taken  whether a point counts; empty: all do
    NearBlocks(const std::vector<Vec3>& points, const LatticeGrid& grid, std::uint32_t side,
               int reach, int threads, const std::function<bool(std::size_t)>& is_taken = {})
        : side_(side)
    {
        constexpr std::size_t chunk = 65536;
        std::vector<std::vector<std::uint64_t>> of_chunk((points.size() + chunk - 1) / chunk);
        parallel_for(of_chunk.size(), threads,
                     [&](std::size_t c)
                     {
                         const std::size_t end = std::min(points.size(), (c + 1) * chunk);
                         for (std::size_t i = c * chunk; i < end; ++i)
                             if (!is_taken || is_taken(i))
                                 add_block_of(points[i], grid, reach, of_chunk[c]);
                         sort_once(of_chunk[c]);
                     });
        for (const std::vector<std::uint64_t>& keys : of_chunk)
            keys_.insert(keys_.end(), keys.begin(), keys.end());
        sort_once(keys_);
        for (const std::uint64_t step : {key(0, 0, 1), key(0, 1, 0), key(1, 0, 0)})
        {
            std::vector<std::uint64_t> spread;
            for (const std::uint64_t k : keys_)
                for (int d = 0; d <= 2 * reach; ++d)
                    spread.push_back(k + static_cast<std::uint64_t>(d) * step);
            keys_ = std::move(spread);
            sort_once(keys_);
        }
        // Both shifts, from the lattice to the first key and from there to the first neighbour.
        const std::uint64_t off = 2 * static_cast<std::uint64_t>(reach);
        std::erase_if(keys_, [&](std::uint64_t k)
                      { return k >> 42 < off || (k >> 21 & part) < off || (k & part) < off; });
        for (std::uint64_t& k : keys_) k -= key(off, off, off);
    }

    /// Calls visit(z begin, z end) for the stretches of a column that lie in blocks.
    template <typename Visit>
    void for_each_stretch(std::uint32_t x, const Run& run, const Visit& visit) const
    {
        const auto first = key(x / side_, run.y / side_, run.z_begin / side_);
        for (auto at = std::lower_bound(keys_.begin(), keys_.end(), first); at != keys_.end(); ++at)
        {
            if (*at >> 21 != first >> 21) break;
            const auto begin = static_cast<std::uint32_t>(*at & part) * side_;
            if (begin >= run.z_end) break;
            visit(std::max(begin, run.z_begin), std::min(begin + side_, run.z_end));
        }
    }

private:
    static constexpr std::uint64_t part = 0x1FFFFF; ///< of a key, a coordinate
    static void sort_once(std::vector<std::uint64_t>& keys)
    {
        std::sort(keys.begin(), keys.end());
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    }
    /// Blocks are counted from `reach` before the lattice on, so that all near it have a key.
    void add_block_of(const Vec3& p, const LatticeGrid& grid, int reach,
                      std::vector<std::uint64_t>& keys) const
    {
        std::array<double, 3> block{};
        for (int axis = 0; axis < 3; ++axis)
            block[static_cast<std::size_t>(axis)] =
                std::floor((p[axis] - grid.origin[axis]) / grid.step(axis) / side_) + reach;
        if (std::any_of(block.begin(), block.end(), [](double b) { return b < 0; })) return;
        const std::uint64_t of_point = key(block[0], block[1], block[2]);
        if (keys.empty() || keys.back() != of_point) keys.push_back(of_point);
    }
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
