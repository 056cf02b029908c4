#pragma once

#include "core/parallel.h"
#include "relax/cell_rows.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// For every active point the others within a radius and a skin. Lists stay valid until a point
/// has moved by half the skin.
///
/// Rows come in the order of a Morton curve; each holds one point and its neighbours, in an order
/// that depends on the points alone. Fastest when the points themselves are stored along such a
/// curve (morton_order()). Costs 20 bytes per point and 4 per neighbour.
class NeighbourList
{
public:
    /// radius, skin  in the unit of the points; their sum above 0
    NeighbourList(float radius, float skin) : reach_(radius + skin), skin_(skin) {}

    /// Makes the lists anew.
    ///
    /// is_active(i)  whether point i needs a list; called from several threads, as keep is
    /// keep(i, j)    whether j counts as a neighbour of i, asked for pairs within radius + skin
    template <typename IsActive, typename Keep>
    void build(const PointArrays& points, int threads, const IsActive& is_active, const Keep& keep)
    {
        rows_.sort(points, reach_, threads);
        lists_.resize((rows_.size() + rows_per_chunk - 1) / rows_per_chunk);
        ends_.resize(rows_.size());
        parallel_for(lists_.size(), threads,
                     [&](std::size_t chunk) { fill_chunk(chunk, is_active, keep); });
        rows_.forget_cells();
    }

    /// Whether a point has moved by half the skin since build(), or their number has changed.
    bool is_outdated(const PointArrays& points, int threads) const
    {
        return rows_.has_moved(points, 0.5f * skin_, threads);
    }

    std::size_t rows() const { return rows_.size(); }
    /// The point that a row belongs to.
    std::uint32_t point(std::size_t row) const { return rows_.point(row); }
    /// Its neighbours; empty if it is not active. Behind them this many more indices can be read.
    std::span<const std::uint32_t> neighbours(std::size_t row) const
    {
        const std::uint32_t begin = row % rows_per_chunk == 0 ? 0 : ends_[row - 1];
        return {lists_[row / rows_per_chunk].data() + begin, ends_[row] - begin};
    }

    static constexpr std::size_t readable_behind = 7;

    /// Rows that make a good chunk for parallel_for(): their lists lie together.
    static constexpr std::size_t rows_per_chunk = 1024;

private:
    template <typename IsActive, typename Keep>
    void fill_chunk(std::size_t chunk, const IsActive& is_active, const Keep& keep)
    {
        CellRows::Scratch& scratch = CellRows::scratch_of_thread();
        scratch.list.clear();
        const std::size_t begin = chunk * rows_per_chunk;
        const std::size_t end = std::min(begin + rows_per_chunk, rows_.size());
        std::size_t cell = rows_.cell_of_row(begin);
        bool is_gathered = false;
        for (std::size_t row = begin; row < end; ++row)
        {
            if (row == rows_.cell_begin(cell + 1))
            {
                ++cell;
                is_gathered = false;
            }
            const std::uint32_t i = rows_.point(row);
            if (is_active(i))
            {
                if (!is_gathered) rows_.gather(cell, scratch);
                is_gathered = true;
                rows_.find_near(row, reach_, scratch);
                for (const std::uint32_t j : scratch.found)
                    if (keep(i, j)) scratch.list.push_back(j);
            }
            ends_[row] = static_cast<std::uint32_t>(scratch.list.size());
        }
        scratch.list.resize(scratch.list.size() + readable_behind, 0);
        lists_[chunk].assign(scratch.list.begin(), scratch.list.end());
    }

    float reach_;
    float skin_;
    CellRows rows_;
    std::vector<std::uint32_t> ends_;               ///< per row, within its chunk's list
    std::vector<std::vector<std::uint32_t>> lists_; ///< per chunk
};

} // namespace fppg
