#include "meshes/box_tree.h"

#include "core/parallel_sort.h"

namespace fppg
{

namespace
{

/// The lowest 21 bits of v with two zeros before each: ..ba becomes ..00b00a.
std::uint64_t spread_bits(std::uint64_t v)
{
    v &= 0x1FFFFF;
    v = (v | v << 32) & 0x1F00000000FFFF;
    v = (v | v << 16) & 0x1F0000FF0000FF;
    v = (v | v << 8) & 0x100F00F00F00F00F;
    v = (v | v << 4) & 0x10C30C30C30C30C3;
    return (v | v << 2) & 0x1249249249249249;
}

Vec3 middle_of(const Box3& box)
{
    return box.min + 0.5 * (box.max - box.min);
}

} // namespace

BoxTree::BoxTree(std::vector<Box3> boxes, int threads) : boxes_(std::move(boxes))
{
    const std::size_t n = boxes_.size();
    if (n == 0) return;
    Box3 all;
    for (const Box3& box : boxes_)
    {
        all.add(box.min);
        all.add(box.max);
    }
    struct Key
    {
        std::uint64_t code;
        std::uint32_t index;
    };
    std::vector<Key> keys(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const Vec3 at = middle_of(boxes_[i]) - all.min;
            std::uint64_t code = 0;
            for (int axis = 0; axis < 3; ++axis)
            {
                const double extent = all.max[axis] - all.min[axis];
                const double share = extent > 0 ? at[axis] / extent : 0;
                code |= spread_bits(static_cast<std::uint64_t>(share * 2097151.0)) << axis;
            }
            keys[i] = {code, static_cast<std::uint32_t>(i)};
        },
        4096);
    parallel_sort(keys, threads,
                  [](const Key& a, const Key& b)
                  { return a.code != b.code ? a.code < b.code : a.index < b.index; });
    order_.resize(n);
    for (std::size_t i = 0; i < n; ++i) order_[i] = keys[i].index;

    while (first_leaf_ * std::size_t{4} < n) first_leaf_ *= 2;
    nodes_.resize(std::size_t{2} * first_leaf_);
    for (std::size_t leaf = 0; leaf < first_leaf_; ++leaf)
        for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i)
        {
            nodes_[first_leaf_ + leaf].add(boxes_[order_[i]].min);
            nodes_[first_leaf_ + leaf].add(boxes_[order_[i]].max);
        }
    for (std::size_t node = first_leaf_ - 1; node >= 1; --node)
        for (const std::size_t child : {2 * node, 2 * node + 1})
        {
            nodes_[node].add(nodes_[child].min);
            nodes_[node].add(nodes_[child].max);
        }
}

} // namespace fppg
