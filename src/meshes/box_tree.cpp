#include "meshes/box_tree.h"

#include "core/morton.h"
#include "core/parallel.h"

#include <limits>

namespace fppg
{

namespace
{

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
    RawArray<Keyed> keys(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const Vec3 at = middle_of(boxes_[i]) - all.min;
            const auto cell = [&](int axis)
            {
                const double extent = all.max[axis] - all.min[axis];
                const double share = extent > 0 ? at[axis] / extent : 0;
                return static_cast<std::int64_t>(share * (most_morton_cells - 1));
            };
            keys[i] = {morton_key(cell(0), cell(1), cell(2)), static_cast<std::uint32_t>(i)};
        },
        4096);
    sort_by_key(keys, n, std::numeric_limits<std::uint64_t>::max() >> 1, threads);
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
