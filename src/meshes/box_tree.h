#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fppg/vec.h"

namespace fppg
{

/// A binary tree of axis-aligned boxes in double, for candidate pairs where every one counts.
/// Boxes are sorted along a Morton curve of their centres; the tree halves that order, so it is the
/// same for any number of threads.
class BoxTree
{
public:
    /// boxes  none empty, all finite
    BoxTree(const std::vector<Box3>& boxes, int threads);

    /// Calls visit(index) for every box that has a point in common with `box`, in the tree's order.
    template <typename Visit>
    void for_each_overlap(const Box3& box, const Visit& visit) const
    {
        for_each_place(box, 0, [&](std::size_t i) { visit(order_[i]); });
    }

    /// Groups of up to 16 boxes next to each other, [0, groups()).
    std::size_t groups() const { return boxes_.empty() ? 0 : first_group_; }

    /// Calls visit(index, other) for every pair of boxes that have a point in common, once over all
    /// groups: in the group of the one that comes first in the tree. An eighth of the time of
    /// for_each_overlap() for each box.
    template <typename Visit>
    void for_each_pair_of(std::size_t group, const Visit& visit) const
    {
        const std::size_t leaves = first_leaf_ / first_group_;
        const std::size_t begin = begin_of(group * leaves);
        const std::size_t end = begin_of((group + 1) * leaves);
        std::vector<std::size_t> near;
        for_each_place(nodes_[first_group_ + group], begin,
                       [&](std::size_t i) { near.push_back(i); });
        for (std::size_t i = begin; i < end; ++i)
            for (const std::size_t k : near)
                if (k > i && overlap(boxes_[i], boxes_[k])) visit(order_[i], order_[k]);
    }

private:
    /// The places in the tree, from `first` on, of what has a point in common with `box`.
    template <typename Visit>
    void for_each_place(const Box3& box, std::size_t first, const Visit& visit) const
    {
        std::uint32_t stack[64];
        int depth = 0;
        stack[depth++] = 1;
        while (depth > 0)
        {
            const std::uint32_t node = stack[--depth];
            if (!overlap(nodes_[node], box)) continue;
            if (node < first_leaf_)
            {
                stack[depth++] = 2 * node + 1;
                stack[depth++] = 2 * node;
                continue;
            }
            const std::size_t leaf = node - first_leaf_;
            for (std::size_t i = std::max(first, begin_of(leaf)); i < begin_of(leaf + 1); ++i)
                if (overlap(boxes_[i], box)) visit(i);
        }
    }

    static bool overlap(const Box3& a, const Box3& b)
    {
        return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y &&
               b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z;
    }
    std::size_t begin_of(std::size_t leaf) const { return boxes_.size() * leaf / first_leaf_; }

    std::vector<Box3> boxes_; ///< in the order of the tree
    std::vector<std::uint32_t> order_;
    std::vector<Box3> nodes_;       ///< a heap from 1; the leaves start at first_leaf_
    std::uint32_t first_leaf_ = 1;  ///< and number of leaves, a power of two
    std::uint32_t first_group_ = 1; ///< the node of the first group, and number of groups
};

} // namespace fppg
