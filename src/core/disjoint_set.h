#pragma once

#include "core/raw_array.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace fppg
{

/// Sets of the numbers 0 to n - 1 without common members, each at first a set of its own.
template <typename Number>
class DisjointSets
{
public:
    struct Unset
    {
    };

    explicit DisjointSets(std::size_t n) : DisjointSets(n, Unset{}) { separate(0, n); }
    /// Each stretch of numbers has to be separated before it is used, where threads share the work.
    DisjointSets(std::size_t n, Unset) : parent_(n) {}

    /// Makes each of the numbers [begin, end) a set of its own.
    void separate(std::size_t begin, std::size_t end)
    {
        for (std::size_t i = begin; i < end; ++i) parent_[i] = static_cast<Number>(i);
    }
    /// The number that stands for the set of another. Shortens the way there.
    Number find(Number i)
    {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// As find; changes nothing, so that threads may ask at once.
    Number first_of(Number i) const
    {
        while (parent_[i] != i) i = parent_[i];
        return i;
    }
    /// The smaller number stands for both sets.
    void join(Number a, Number b)
    {
        a = find(a);
        b = find(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    RawArray<Number> parent_;
};

using DisjointSet = DisjointSets<std::uint32_t>;

} // namespace fppg
