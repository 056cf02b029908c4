#pragma once

#include "fppg/lattice.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Where fluid nodes are near, a bit a block of nodes.
class FluidNear
{
public:
    FluidNear(const RunField& field, std::uint16_t bound_first)
    {
        for (int axis = 0; axis < 3; ++axis)
            count_[static_cast<std::size_t>(axis)] =
                field.grid.n[static_cast<std::size_t>(axis)] / side + 1;
        words_ = count_[2] / 64 + 1;
        bits_.assign(std::size_t{count_[0]} * count_[1] * words_, 0);
        for (std::size_t x = 0; x < field.slabs.size(); ++x)
            for (const Run& run : field.slabs[x])
                if (!run.is_covered && run.mk < bound_first) mark(x, run);
    }

    bool is_empty() const { return is_empty_; }

    bool has(std::size_t x, std::uint32_t y, std::uint32_t z) const
    {
        const std::size_t bit = z / side;
        return (bits_[word_of(x / side, y / side) + bit / 64] >> (bit % 64) & 1) != 0;
    }

private:
    static constexpr std::uint32_t side = 4;
    /// Nodes from a cell to the fluid that it is beside.
    static constexpr std::size_t reach = 2;

    std::size_t word_of(std::size_t x, std::size_t y) const { return (x * count_[1] + y) * words_; }

    void mark(std::size_t x, const Run& run)
    {
        is_empty_ = false;
        const auto first = [](std::size_t at) { return at < reach ? 0 : (at - reach) / side; };
        const auto last = [&](std::size_t at, std::size_t axis)
        { return std::min<std::size_t>(count_[axis] - 1, (at + reach) / side); };
        for (std::size_t i = first(x); i <= last(x, 0); ++i)
            for (std::size_t j = first(run.y); j <= last(run.y, 1); ++j)
                for (std::size_t k = first(run.z_begin); k <= last(run.z_end - 1, 2); ++k)
                    bits_[word_of(i, j) + k / 64] |= std::uint64_t{1} << (k % 64);
    }

    std::array<std::uint32_t, 3> count_{};
    std::size_t words_ = 0;
    std::vector<std::uint64_t> bits_;
    bool is_empty_ = true;
};

} // namespace fppg
