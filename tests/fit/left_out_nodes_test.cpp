#include "fit/left_out_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace fppg
{
namespace
{

struct Node
{
    std::uint32_t distance = 0;
    std::uint32_t hash = 0;
};

/// Many at the same distances, as beside walls along the lattice.
std::vector<Node> some_nodes(std::size_t count, std::uint32_t steps)
{
    std::mt19937 random(7);
    std::vector<Node> nodes(count);
    for (Node& node : nodes)
    {
        const auto step = static_cast<std::uint32_t>(random() % (steps + 1));
        node = {distance_units / steps * step, static_cast<std::uint32_t>(random())};
    }
    return nodes;
}

LeftOutNodes choose(const std::vector<Node>& nodes, std::uint32_t always_below, double wanted)
{
    LeftOutNodes side(always_below);
    std::uint64_t always = 0;
    DistanceCounts counts(distance_ranges);
    for (const Node& node : nodes)
        if (side.is_always_left_out(node.distance))
            ++always;
        else
            ++counts[distance_range(node.distance)];
    side.leave_out(wanted, always, counts);
    std::vector<std::uint64_t> keys;
    for (const Node& node : nodes)
        if (side.is_to_settle(node.distance))
            keys.push_back(LeftOutNodes::key(node.distance, node.hash));
    side.settle(std::move(keys));
    return side;
}

TEST(LeftOutNodes, AreTheNearestByDistanceAndThenByRank)
{
    constexpr std::uint32_t always_below = distance_units / 5 * 2;
    for (const std::uint32_t steps : {4U, 1000U, 1000000U})
    {
        std::vector<Node> nodes = some_nodes(5000, steps);
        std::sort(nodes.begin(), nodes.end(),
                  [](const Node& a, const Node& b) {
                      return LeftOutNodes::key(a.distance, a.hash) <
                             LeftOutNodes::key(b.distance, b.hash);
                  });
        const auto always = static_cast<std::size_t>(
            std::count_if(nodes.begin(), nodes.end(),
                          [](const Node& node) { return node.distance < always_below; }));
        for (const std::size_t wanted : {std::size_t{0}, always, always + 1, std::size_t{3000},
                                         std::size_t{4999}, std::size_t{5000}, std::size_t{9000}})
        {
            const LeftOutNodes side = choose(nodes, always_below, static_cast<double>(wanted));
            const std::size_t expected = std::clamp(wanted, always, nodes.size());
            for (std::size_t i = 0; i < nodes.size(); ++i)
                ASSERT_EQ(side.is_left_out(nodes[i].distance, nodes[i].hash), i < expected)
                    << steps << " steps, " << wanted << " wanted, node " << i;
        }
    }
}

} // namespace
} // namespace fppg
