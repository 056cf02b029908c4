#pragma once

#include "core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// Points as one array an axis; float, relative to an origin amid them and in units of about their
/// spacing, so that differences keep four digits over 1000 spacings.
struct PointArrays
{
    std::vector<float> x, y, z;

    std::size_t size() const { return x.size(); }
    void resize(std::size_t n)
    {
        x.resize(n);
        y.resize(n);
        z.resize(n);
    }
};

/// A point as one register of four, the last of them 0.
using PackedPoint = float __attribute__((vector_size(16)));

/// The points along a Z-shaped (Morton) curve over cells of side `cell`: entry k is the index of
/// the k-th point. Points of one cell keep their order.
///
/// cost  about 20 ns per point and thread, 24 bytes per point while it runs
std::vector<std::uint32_t> morton_order(const PointArrays& points, float cell, int threads);

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
        sort_into_cells(points, threads);
        lists_.resize((order_.size() + rows_per_chunk - 1) / rows_per_chunk);
        ends_.resize(order_.size());
        parallel_for(lists_.size(), threads,
                     [&](std::size_t chunk) { fill_chunk(chunk, is_active, keep); });
        forget_cells();
    }

    /// Whether a point has moved by half the skin since build(), or their number has changed.
    bool is_outdated(const PointArrays& points, int threads) const;

    std::size_t rows() const { return order_.size(); }
    /// The point that a row belongs to.
    std::uint32_t point(std::size_t row) const { return order_[row]; }
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
    /// What one thread needs while it fills chunks.
    struct Scratch
    {
        std::vector<float> x, y, z; ///< of the points around a cell
        std::vector<std::uint32_t> indices;
        std::size_t count = 0; ///< of these; room for eight more is behind them
        std::vector<std::uint32_t> found;
        std::vector<std::uint32_t> list;
    };
    /// A cube of 4 x 4 x 4 cells: which of them hold points, and the first of those.
    struct Block
    {
        std::uint64_t key = 0;
        std::uint64_t mask = 0; ///< 0: an empty slot of the table
        std::uint32_t first_cell = 0;
    };

    void sort_into_cells(const PointArrays& points, int threads);
    void forget_cells();
    void make_block_table();
    const Block* find_block(std::uint64_t key) const;
    std::size_t cell_of_row(std::size_t row) const;
    static Scratch& scratch_of_thread();
    /// Copies the points of a cell and the 26 around it.
    void gather(std::size_t cell, Scratch& scratch) const;
    void copy_rows(std::size_t begin, std::size_t end, Scratch& scratch) const;
    /// Finds those of the copied points that are within reach of a row's, which is not counted.
    void find_near(std::size_t row, Scratch& scratch) const;

    template <typename IsActive, typename Keep>
    void fill_chunk(std::size_t chunk, const IsActive& is_active, const Keep& keep)
    {
        Scratch& scratch = scratch_of_thread();
        scratch.list.clear();
        const std::size_t begin = chunk * rows_per_chunk;
        const std::size_t end = std::min(begin + rows_per_chunk, order_.size());
        std::size_t cell = cell_of_row(begin);
        bool is_gathered = false;
        for (std::size_t row = begin; row < end; ++row)
        {
            if (row == cell_begin_[cell + 1])
            {
                ++cell;
                is_gathered = false;
            }
            const std::uint32_t i = order_[row];
            if (is_active(i))
            {
                if (!is_gathered) gather(cell, scratch);
                is_gathered = true;
                find_near(row, scratch);
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
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> ends_;               ///< per row, within its chunk's list
    std::vector<std::vector<std::uint32_t>> lists_; ///< per chunk
    PointArrays built_at_;                          ///< where the points of the rows were
    // Only while the lists are made:
    std::vector<std::uint64_t> cell_keys_;
    std::vector<std::uint32_t> cell_begin_;
    std::vector<Block> table_;
    int table_shift_ = 0;
};

} // namespace fppg
