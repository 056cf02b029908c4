#pragma once

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
    BoxTree(std::vector<Box3> boxes, int threads);

    /// Calls visit(index) for every box that has a point in common with `box`, in the tree's order.
    template <typename Visit>
    void for_each_overlap(const Box3& box, const Visit& visit) const
    {
        if (boxes_.empty()) return;
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
            for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i)
                if (overlap(boxes_[order_[i]], box)) visit(order_[i]);
        }
    }

private:
    static bool overlap(const Box3& a, const Box3& b)
    {
        return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y &&
               b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z;
    }
    std::size_t begin_of(std::size_t leaf) const { return boxes_.size() * leaf / first_leaf_; }

    std::vector<Box3> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Box3> nodes_;      ///< a heap from 1; the leaves start at first_leaf_
    std::uint32_t first_leaf_ = 1; ///< and number of leaves, a power of two
};

} // namespace fppg
