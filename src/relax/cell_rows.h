#pragma once

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

/// A point as one register of four; the last of them is 0 or a number of its own.
using PackedPoint = float __attribute__((vector_size(16)));

/// The points along a Z-shaped (Morton) curve over cells of side `cell`: entry k is the index of
/// the k-th point. Points of one cell keep their order.
///
/// cost  about 20 ns per point and thread, 24 bytes per point while it runs
std::vector<std::uint32_t> morton_order(const PointArrays& points, float cell, int threads);

/// Points sorted into cells for neighbour lists: a row for each, in the order of a Morton curve
/// over cells that are a little larger than `reach`, so that rounding moves no neighbour two cells
/// off.
class CellRows
{
public:
    /// What one thread needs while it makes lists.
    struct Scratch
    {
        std::vector<float> x, y, z; ///< of the points around a cell
        std::vector<std::uint32_t> indices;
        std::size_t count = 0;                ///< of these; room for eight more is behind them
        std::vector<std::uint32_t> places;    ///< 0, 1, 2 ...: of the points that were copied
        std::vector<std::uint32_t> buffer;    ///< only grows
        std::span<const std::uint32_t> found; ///< in the buffer
        std::vector<std::uint32_t> list;
    };

    void sort(const PointArrays& points, float reach, int threads);
    /// Frees what only gather() and the cells' functions need.
    void forget_cells();

    std::size_t size() const { return order_.size(); }
    /// The point that a row belongs to.
    std::uint32_t point(std::size_t row) const { return order_[row]; }
    /// Whether a point is farther than a distance from where it was sorted, or their number has
    /// changed.
    bool has_moved(const PointArrays& points, float distance, int threads) const;

    std::size_t cells() const { return cell_begin_.size() - 1; }
    std::size_t cell_begin(std::size_t cell) const { return cell_begin_[cell]; }
    std::size_t cell_of_row(std::size_t row) const;
    static Scratch& scratch_of_thread();
    /// Copies the points of a cell and the 26 around it.
    void gather(std::size_t cell, Scratch& scratch) const;
    /// Finds the points among those copied that are within reach of a row's, which is not counted.
    void find_near(std::size_t row, float reach, Scratch& scratch) const;
    /// Finds the places among those copied of the points that are within reach of one of up to
    /// eight rows.
    void find_near_any(std::span<const std::uint32_t> rows, float reach, Scratch& scratch) const;

private:
    /// A cube of 4 x 4 x 4 cells: which of them hold points, and the first of those.
    struct Block
    {
        std::uint64_t key = 0;
        std::uint64_t mask = 0; ///< 0: an empty slot of the table
        std::uint32_t first_cell = 0;
    };

    void make_block_table();
    const Block* find_block(std::uint64_t key) const;
    static void take_found(std::size_t count, Scratch& scratch)
    {
        scratch.found = {scratch.buffer.data(), count};
    }
    void copy_cells(const Block& block, std::uint64_t cells, Scratch& scratch) const;
    void copy_rows(std::size_t begin, std::size_t end, Scratch& scratch) const;

    std::vector<std::uint32_t> order_;
    PointArrays built_at_; ///< where the points of the rows were
    // Only while lists are made:
    std::vector<std::uint64_t> cell_keys_;
    std::vector<std::uint32_t> cell_begin_;
    std::vector<Block> table_;
    int table_shift_ = 0;
};

} // namespace fppg
