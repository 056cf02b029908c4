#include "meshes/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

bool overlap(const Box3& a, const Box3& b)
{
    for (int axis = 0; axis < 3; ++axis)
        if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
    return true;
}

/// Boxes of many sizes; some are points, some are one twice.
std::vector<Box3> some_boxes(std::size_t count, std::mt19937& random)
{
    std::uniform_real_distribution<double> place(0, 1), size(0, 0.3);
    std::vector<Box3> boxes;
    for (std::size_t i = 0; i < count; ++i)
    {
        if (i % 9 == 8)
        {
            boxes.push_back(boxes[i / 2]);
            continue;
        }
        const Vec3 low{place(random), place(random), place(random)};
        Box3 box;
        box.add(low);
        if (i % 7 != 6) box.add(low + Vec3{size(random), size(random), size(random)});
        boxes.push_back(box);
    }
    return boxes;
}

TEST(BoxTree, FindsEveryPairOnce)
{
    std::mt19937 random(7);
    for (const std::size_t count : {0u, 1u, 2u, 5u, 17u, 64u, 65u, 700u})
    {
        const std::vector<Box3> boxes = some_boxes(count, random);
        const BoxTree tree(boxes, 2);
        Pairs expected, found;
        for (std::uint32_t i = 0; i < count; ++i)
            for (std::uint32_t k = i + 1; k < count; ++k)
                if (overlap(boxes[i], boxes[k])) expected.emplace(i, k);
        for (std::size_t group = 0; group < tree.groups(); ++group)
            tree.for_each_pair_of(group, [&](std::uint32_t a, std::uint32_t b)
                                  { found.emplace(std::min(a, b), std::max(a, b)); });
        EXPECT_EQ(found, expected) << count;
    }
}

TEST(BoxTree, FindsWhatOverlapsABox)
{
    std::mt19937 random(8);
    const std::vector<Box3> boxes = some_boxes(300, random);
    const BoxTree tree(boxes, 2);
    for (const Box3& box : some_boxes(50, random))
    {
        std::multiset<std::uint32_t> expected, found;
        for (std::uint32_t i = 0; i < boxes.size(); ++i)
            if (overlap(boxes[i], box)) expected.insert(i);
        tree.for_each_overlap(box, [&](std::uint32_t i) { found.insert(i); });
        EXPECT_EQ(found, expected);
    }
}

} // namespace
} // namespace fppg
