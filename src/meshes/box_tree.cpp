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

BoxTree::BoxTree(const std::vector<Box3>& boxes, int threads)
{
    const std::size_t n = boxes.size();
    if (n == 0) return;
    Box3 all;
    for (const Box3& box : boxes)
    {
        all.add(box.min);
        all.add(box.max);
    }
    RawArray<Keyed> keys(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const Vec3 at = middle_of(boxes[i]) - all.min;
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
    boxes_.resize(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            order_[i] = keys[i].index;
            boxes_[i] = boxes[order_[i]];
        },
        4096);

    while (first_leaf_ * std::size_t{4} < n) first_leaf_ *= 2;
    first_group_ = std::max(first_leaf_ / 4, 1u);
    nodes_.resize(std::size_t{2} * first_leaf_);
    parallel_for(
        first_leaf_, threads,
        [&](std::size_t leaf)
        {
            for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i)
            {
                nodes_[first_leaf_ + leaf].add(boxes_[i].min);
                nodes_[first_leaf_ + leaf].add(boxes_[i].max);
            }
        },
        4096);
    for (std::size_t node = first_leaf_ - 1; node >= 1; --node)
        for (const std::size_t child : {2 * node, 2 * node + 1})
        {
            nodes_[node].add(nodes_[child].min);
            nodes_[node].add(nodes_[child].max);
        }
}

} // namespace fppg
