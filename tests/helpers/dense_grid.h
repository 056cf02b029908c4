#pragma once

#include "fppg/lattice.h"

#include "nodes/snap.h"
#include "nodes/spans.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fppg::test
{

/// Every node of a lattice with its value, the plain form of what runs and spans say in short.
template <typename Value>
struct Dense
{
    explicit Dense(const LatticeGrid& g)
        : grid(g), values(static_cast<std::size_t>(g.n[0]) * g.n[1] * g.n[2], Value{})
    {
    }

    Value& at(std::int64_t x, std::int64_t y, std::int64_t z)
    {
        return values[static_cast<std::size_t>((x * grid.n[1] + y) * grid.n[2] + z)];
    }
    const Value& at(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return const_cast<Dense&>(*this).at(x, y, z);
    }
    bool operator==(const Dense& other) const { return values == other.values; }

    LatticeGrid grid;
    std::vector<Value> values;
};

/// The mk of a covered node has this bit in the dense form.
inline constexpr std::uint16_t covered = 0x8000;

inline std::uint16_t dense_mk(const Run& run)
{
    return static_cast<std::uint16_t>(run.is_covered ? run.mk | covered : run.mk);
}

using DenseMks = Dense<std::uint16_t>;
using DenseSet = Dense<char>;

template <typename Body>
void for_each_node(const LatticeGrid& grid, const Body& body)
{
    for (std::int64_t x = 0; x < grid.n[0]; ++x)
        for (std::int64_t y = 0; y < grid.n[1]; ++y)
            for (std::int64_t z = 0; z < grid.n[2]; ++z) body(Node{x, y, z});
}

/// The nodes for which holds(node) is true.
template <typename Predicate>
DenseSet where(const LatticeGrid& grid, const Predicate& holds)
{
    DenseSet out(grid);
    for_each_node(grid, [&](const Node& n) { out.at(n.x, n.y, n.z) = holds(n) ? 1 : 0; });
    return out;
}

inline void add(DenseSet& set, std::size_t x, const Spans& spans)
{
    for (const Span& s : spans)
        for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
            set.at(static_cast<std::int64_t>(x), s.y, z) = 1;
}

inline DenseSet dense(const LatticeGrid& grid, const std::vector<Spans>& slabs)
{
    DenseSet out(grid);
    for (std::size_t x = 0; x < slabs.size(); ++x) add(out, x, slabs[x]);
    return out;
}

inline DenseSet dense(const LatticeGrid& grid, const SlabRegion& region)
{
    DenseSet out(grid);
    for (std::uint32_t x = region.x_begin; x < region.x_end; ++x)
    {
        Spans spans;
        region.emit(x, spans);
        add(out, x, spans);
    }
    return out;
}

inline DenseMks dense(const RunField& field)
{
    DenseMks out(field.grid);
    for (std::size_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& r : field.slabs[x])
            for (std::uint32_t z = r.z_begin; z < r.z_end; ++z)
                out.at(static_cast<std::int64_t>(x), r.y, z) = dense_mk(r);
    return out;
}

inline RunField runs_of(const DenseMks& nodes)
{
    RunField field;
    field.grid = nodes.grid;
    field.slabs.resize(nodes.grid.n[0]);
    for_each_node(nodes.grid,
                  [&](const Node& n)
                  {
                      const std::uint16_t mk = nodes.at(n.x, n.y, n.z);
                      if (mk == 0) return;
                      auto& runs = field.slabs[static_cast<std::size_t>(n.x)];
                      const auto y = static_cast<std::uint32_t>(n.y);
                      const auto z = static_cast<std::uint32_t>(n.z);
                      if (!runs.empty() && runs.back().y == y && runs.back().z_end == z &&
                          dense_mk(runs.back()) == mk)
                          ++runs.back().z_end;
                      else
                          runs.push_back({y, z, z + 1, static_cast<std::uint16_t>(mk & ~covered),
                                          (mk & covered) != 0});
                  });
    return field;
}

/// How many nodes two sets differ in, and the first of them; empty when they are equal.
inline std::string difference(const DenseSet& found, const DenseSet& expected)
{
    std::size_t count = 0;
    std::string first;
    for_each_node(found.grid,
                  [&](const Node& n)
                  {
                      if (found.at(n.x, n.y, n.z) == expected.at(n.x, n.y, n.z)) return;
                      if (count++ == 0)
                          first = std::string(found.at(n.x, n.y, n.z) ? "extra" : "missing") +
                                  " (" + std::to_string(n.x) + ", " + std::to_string(n.y) + ", " +
                                  std::to_string(n.z) + ")";
                  });
    return count == 0 ? "" : std::to_string(count) + " nodes differ, the first is " + first;
}

/// Random numbers that are the same on every machine.
class Dice
{
public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}

    /// A whole number in [low, high].
    std::int64_t whole(std::int64_t low, std::int64_t high)
    {
        return low +
               static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }
    /// A number in [low, high).
    double real(double low, double high)
    {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    template <typename Value, std::size_t N>
    Value one_of(const Value (&values)[N])
    {
        return values[static_cast<std::size_t>(whole(0, N - 1))];
    }
    bool coin() { return whole(0, 1) == 1; }

private:
    std::mt19937_64 engine_;
};

/// A small lattice, half of them stretched; its place and spacing are no round numbers in binary.
inline LatticeGrid any_grid(Dice& dice)
{
    LatticeGrid grid;
    grid.dp = dice.one_of({0.1, 0.05, 1.0, 0.013, 0.3});
    grid.origin = {dice.real(-2, 2), dice.coin() ? 0 : dice.real(-50, 50), -0.1};
    for (auto& n : grid.n) n = static_cast<std::uint32_t>(dice.whole(1, 18));
    if (dice.coin())
        grid.stretch = {dice.real(0.95, 1.05), dice.real(0.95, 1.05), dice.real(0.95, 1.05)};
    return grid;
}

/// A node in or near the lattice, up to `beyond` steps outside it.
inline Node any_node(Dice& dice, const LatticeGrid& grid, std::int64_t beyond)
{
    return {dice.whole(-beyond, grid.n[0] - 1 + beyond),
            dice.whole(-beyond, grid.n[1] - 1 + beyond),
            dice.whole(-beyond, grid.n[2] - 1 + beyond)};
}

} // namespace fppg::test
