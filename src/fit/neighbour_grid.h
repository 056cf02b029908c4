#pragma once

#include "fppg/vec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace fppg
{

/// Three cell numbers in one word; cells 2^21 apart share a key, which costs time, not correctness.
inline std::uint64_t cell_key(std::int64_t i, std::int64_t j, std::int64_t k)
{
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (static_cast<std::uint64_t>(i) & mask) << 42 |
           (static_cast<std::uint64_t>(j) & mask) << 21 | (static_cast<std::uint64_t>(k) & mask);
}

/// Numbers the keys that it is given in the order of their coming: an open-addressed table.
class KeyTable
{
public:
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    void clear()
    {
        slots_.assign(64, {0, none});
        shift_ = 58;
        count_ = 0;
    }
    std::uint32_t size() const { return count_; }

    std::uint32_t find(std::uint64_t key) const
    {
        for (std::size_t s = first_slot(key);; s = (s + 1) & (slots_.size() - 1))
        {
            if (slots_[s].value == none || slots_[s].key == key) return slots_[s].value;
        }
    }

    std::uint32_t find_or_add(std::uint64_t key)
    {
        if (2 * (count_ + std::size_t{1}) > slots_.size()) grow();
        std::size_t s = first_slot(key);
        while (slots_[s].value != none && slots_[s].key != key) s = (s + 1) & (slots_.size() - 1);
        if (slots_[s].value == none) slots_[s] = {key, count_++};
        return slots_[s].value;
    }

private:
    struct Slot
    {
        std::uint64_t key;
        std::uint32_t value;
    };

    std::size_t first_slot(std::uint64_t key) const
    {
        return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> shift_);
    }

    void grow()
    {
        std::vector<Slot> old(2 * slots_.size(), {0, none});
        old.swap(slots_);
        --shift_;
        for (const Slot& slot : old)
        {
            if (slot.value == none) continue;
            std::size_t s = first_slot(slot.key);
            while (slots_[s].value != none) s = (s + 1) & (slots_.size() - 1);
            slots_[s] = slot;
        }
    }

    std::vector<Slot> slots_ = std::vector<Slot>(64, {0, none});
    int shift_ = 58; ///< 64 less the binary logarithm of the number of slots
    std::uint32_t count_ = 0;
};

/// Points sorted into cells, for "who is nearer than r": points come one by one, none leaves.
class NeighbourGrid
{
public:
    /// reach   metres: the largest radius that is asked for
    /// origin  a point amid the points to come
    void start(double reach, const Vec3& origin = {})
    {
        scale_ = 0.5 / reach;
        origin_ = origin;
        points_.clear();
        table_.clear();
        heads_.clear();
        blocks_.clear();
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }

    /// Points are numbered from 0 as they come.
    void add(const Vec3& point)
    {
        const Vec3 p = (point - origin_) * scale_;
        const std::uint32_t cell =
            table_.find_or_add(cell_key(cell_of(p.x), cell_of(p.y), cell_of(p.z)));
        if (cell == heads_.size()) heads_.push_back(KeyTable::none);
        if (heads_[cell] == KeyTable::none || blocks_[heads_[cell]].count == Block::capacity)
        {
            blocks_.emplace_back();
            blocks_.back().next = heads_[cell];
            heads_[cell] = static_cast<std::uint32_t>(blocks_.size() - 1);
        }
        Block& block = blocks_[heads_[cell]];
        block.x[block.count] = static_cast<float>(p.x);
        block.y[block.count] = static_cast<float>(p.y);
        block.z[block.count] = static_cast<float>(p.z);
        block.index[block.count++] = size();
        points_.push_back(point);
    }

    /// Calls body(index, offset from p, distance squared) for every point nearer than `radius`, at
    /// most the reach, to p; in an order that depends only on the points and the order of adding.
    template <typename Body>
    void for_each_near(const Vec3& point, double radius, const Body& body) const
    {
        const double limit = radius * radius;
        const Vec3 p = (point - origin_) * scale_;
        const double r = radius * scale_;
        // Blocks hold floats, which choose with some room; the offset handed on is exact.
        const auto room = static_cast<float>(1.001 * r * r);
        const auto range = [&](double x) { return std::pair{cell_of(x - r), cell_of(x + r)}; };
        const auto [x0, x1] = range(p.x);
        const auto [y0, y1] = range(p.y);
        const auto [z0, z1] = range(p.z);
        // Nested because the cells around a place are walked along three axes.
        for (auto i = x0; i <= x1; ++i)
            for (auto j = y0; j <= y1; ++j)
                for (auto k = z0; k <= z1; ++k)
                {
                    const std::uint32_t cell = table_.find(cell_key(i, j, k));
                    if (cell == KeyTable::none) continue;
                    for (std::uint32_t b = heads_[cell]; b != KeyTable::none; b = blocks_[b].next)
                        scan(blocks_[b], p, room,
                             [&](std::uint32_t index)
                             {
                                 const Vec3 d = points_[index] - point;
                                 const double squared = dot(d, d);
                                 if (squared < limit) body(index, d, squared);
                             });
                }
    }

private:
    struct Block
    {
        static constexpr std::uint32_t capacity = 16;
        std::array<float, capacity> x{}, y{}, z{}; ///< in cells from the origin
        std::array<std::uint32_t, capacity> index{};
        std::uint32_t count = 0;
        std::uint32_t next = 0;
    };

    template <typename Body>
    static void scan(const Block& block, const Vec3& p, float room, const Body& body)
    {
        const auto px = static_cast<float>(p.x);
        const auto py = static_cast<float>(p.y);
        const auto pz = static_cast<float>(p.z);
        std::array<float, Block::capacity> squared;
        for (std::size_t n = 0; n < Block::capacity; ++n)
        {
            const float dx = block.x[n] - px;
            const float dy = block.y[n] - py;
            const float dz = block.z[n] - pz;
            squared[n] = dx * dx + dy * dy + dz * dz;
        }
        for (std::uint32_t n = 0; n < block.count; ++n)
            if (squared[n] < room) body(block.index[n]);
    }

    static std::int64_t cell_of(double x)
    {
        // Truncation after a shift that makes all coordinates positive: faster than floor().
        return static_cast<std::int64_t>(x + 1048576.0);
    }

    double scale_ = 1;
    Vec3 origin_;
    std::vector<Vec3> points_;
    KeyTable table_;
    std::vector<std::uint32_t> heads_;
    std::vector<Block> blocks_;
};

} // namespace fppg
