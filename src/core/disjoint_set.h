#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace fppg
{

/// Sets of the numbers 0 to n - 1 without common members, each at first a set of its own.
class DisjointSet
{
public:
    explicit DisjointSet(std::size_t n) : parent_(n)
    {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    /// The number that stands for the set of another.
    std::uint32_t find(std::uint32_t i)
    {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// The smaller number stands for both sets.
    void join(std::uint32_t a, std::uint32_t b)
    {
        a = find(a);
        b = find(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

} // namespace fppg
