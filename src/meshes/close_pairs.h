#pragma once

#include "fppg/vec.h"

#include "core/raw_array.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// All pairs of points that are near each other. Points are sorted along rows of cubic cells as
/// long as the reach, so that those near a cell lie in nine stretches, which move on with it.
/// PointGrid is for points that come one by one.
///
/// cost  0.3 to 0.8 microseconds a point with one to ten others near it; 40 bytes
class ClosePairs
{
public:
    /// points   all finite
    /// reach    metres, above 0
    ClosePairs(const std::vector<Vec3>& points, double reach, int threads);

    /// Points are worked through in so many chunks.
    std::size_t chunks() const
    {
        return (points_.size() + points_per_chunk - 1) / points_per_chunk;
    }

    /// Calls visit(i, j, squared distance) for every point i of a chunk and every other point j
    /// within reach: over all chunks twice for each pair.
    template <typename Visit>
    void for_each_pair_of(std::size_t chunk, const Visit& visit) const
    {
        const std::size_t begin = chunk * points_per_chunk;
        const std::size_t end = std::min(begin + points_per_chunk, points_.size());
        std::array<Stretch, 9> near;
        for (std::size_t row = 0; row < near.size(); ++row)
        {
            const auto first = std::lower_bound(keys_.begin(), keys_.end(), first_key(begin, row));
            near[row].begin = near[row].end = static_cast<std::size_t>(first - keys_.begin());
        }
        for (std::size_t at = begin; at < end; ++at)
        {
            if (at == begin || keys_[at] != keys_[at - 1])
                for (std::size_t row = 0; row < near.size(); ++row)
                    move_on(first_key(at, row), near[row]);
            const Place& own = points_[at];
            for (const Stretch& stretch : near)
                for (std::size_t k = stretch.begin; k < stretch.end; ++k)
                {
                    const Vec3 away = points_[k].at - own.at;
                    const double squared = dot(away, away);
                    if (squared <= reach_ * reach_ && k != at)
                        visit(own.index, points_[k].index, squared);
                }
        }
    }

private:
    static constexpr std::size_t points_per_chunk = 2048;

    struct Place
    {
        Vec3 at;
        std::uint32_t index = 0; ///< in the order given
    };
    /// Of sorted points: those of three cells next to each other in a row.
    struct Stretch
    {
        std::size_t begin = 0, end = 0;
    };

    /// The key of the first of three cells, in one of the nine rows around a point.
    std::uint64_t first_key(std::size_t at, std::size_t row) const
    {
        return keys_[at] + (row / 3) * row_of_[0] + (row % 3) * row_of_[1] - row_of_[0] -
               row_of_[1] - 1;
    }

    void move_on(std::uint64_t first, Stretch& stretch) const
    {
        while (stretch.begin < keys_.size() && keys_[stretch.begin] < first) ++stretch.begin;
        stretch.end = std::max(stretch.end, stretch.begin);
        while (stretch.end < keys_.size() && keys_[stretch.end] <= first + 2) ++stretch.end;
    }

    double reach_;
    std::array<std::uint64_t, 2> row_of_{}; ///< keys from a cell to the next along x and y
    RawArray<std::uint64_t> keys_;          ///< of the cells, ascending; those along z by 1 apart
    RawArray<Place> points_;                ///< in the order of the keys
};

} // namespace fppg
