#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "fppg/vec.h"

namespace fppg
{

/// Points in cubic cells that can be added one by one, found by open hashing of the cells. Others
/// have tasks that this one is too slow or too large for: ChartGrid compares a front particle with
/// 16 neighbours at once, NeighbourList keeps lists over the steps of a relaxation, CellGrid walks
/// through files that are larger than memory.
class PointGrid
{
public:
    /// cell  the edge of a cell, metres; queries should reach no farther than about one cell
    PointGrid(double cell, std::size_t expected) : cell_(cell)
    {
        std::size_t size = 64;
        // Mostly several points share a cell; with more cells the slots grow.
        while (size < expected / 4) size *= 2;
        slots_.resize(size);
        points_.reserve(expected);
        next_.reserve(expected);
    }

    std::uint32_t add(const Vec3& p)
    {
        const auto index = static_cast<std::uint32_t>(points_.size());
        points_.push_back(p);
        Slot& slot = find(index_of(p.x), index_of(p.y), index_of(p.z));
        next_.push_back(slot.first);
        const bool is_new = slot.first == none;
        slot.first = index;
        if (is_new && ++used_ * 2 > slots_.size()) grow();
        return index;
    }

    /// Calls visit(index, squared distance) for the points within `radius`, in an order that
    /// depends on the points and the order of adding only.
    template <typename Visit>
    void for_each_near(const Vec3& p, double radius, const Visit& visit) const
    {
        find_near(p, radius,
                  [&](std::uint32_t at, double squared)
                  {
                      visit(at, squared);
                      return false;
                  });
    }

    /// Whether a point lies nearer than `radius`.
    bool has_nearer(const Vec3& p, double radius) const
    {
        return find_near(p, radius,
                         [&](std::uint32_t, double squared) { return squared < radius * radius; });
    }

    /// The nearest point, if one is within `radius`.
    std::optional<std::uint32_t> nearest(const Vec3& p, double radius) const
    {
        std::optional<std::uint32_t> out;
        double least = std::numeric_limits<double>::infinity();
        for_each_near(p, radius,
                      [&](std::uint32_t at, double squared)
                      {
                          if (squared >= least) return;
                          least = squared;
                          out = at;
                      });
        return out;
    }

    const std::vector<Vec3>& points() const { return points_; }

private:
    /// Until `is_it` is true for one.
    template <typename IsIt>
    bool find_near(const Vec3& p, double radius, const IsIt& is_it) const
    {
        const std::int64_t i1 = index_of(p.x + radius), j1 = index_of(p.y + radius),
                           k1 = index_of(p.z + radius);
        // Nested because the cells around a place are walked along three axes.
        for (std::int64_t k = index_of(p.z - radius); k <= k1; ++k)
            for (std::int64_t j = index_of(p.y - radius); j <= j1; ++j)
                for (std::int64_t i = index_of(p.x - radius); i <= i1; ++i)
                    for (std::uint32_t at = first_of(i, j, k); at != none; at = next_[at])
                    {
                        const Vec3 away = points_[at] - p;
                        const double squared = dot(away, away);
                        if (squared <= radius * radius && is_it(at, squared)) return true;
                    }
        return false;
    }

    static constexpr std::uint32_t none = 0xFFFFFFFF;
    struct Slot
    {
        std::int64_t i = 0, j = 0, k = 0;
        std::uint32_t first = none;
    };

    /// Points beyond the range of integers share the last cell.
    std::int64_t index_of(double x) const
    {
        return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_), -4e18, 4e18));
    }

    std::size_t place(std::int64_t i, std::int64_t j, std::int64_t k) const
    {
        std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15 +
                          static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4F +
                          static_cast<std::uint64_t>(k) * 0x165667B19E3779F9;
        h ^= h >> 32;
        h *= 0xD6E8FEB86659FD93;
        h ^= h >> 32;
        std::size_t at = h & (slots_.size() - 1);
        while (slots_[at].first != none &&
               (slots_[at].i != i || slots_[at].j != j || slots_[at].k != k))
            at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    std::uint32_t first_of(std::int64_t i, std::int64_t j, std::int64_t k) const
    {
        return slots_[place(i, j, k)].first;
    }
    Slot& find(std::int64_t i, std::int64_t j, std::int64_t k)
    {
        Slot& slot = slots_[place(i, j, k)];
        slot.i = i;
        slot.j = j;
        slot.k = k;
        return slot;
    }
    void grow()
    {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.first != none) slots_[place(slot.i, slot.j, slot.k)] = slot;
    }

    double cell_;
    std::vector<Slot> slots_;
    std::size_t used_ = 0;
    std::vector<Vec3> points_;
    std::vector<std::uint32_t> next_; ///< the next point of the same cell
};

/// A grid of points, in their order.
inline PointGrid grid_of(std::span<const Vec3> points, double cell)
{
    PointGrid out(cell, points.size());
    for (const Vec3& p : points) out.add(p);
    return out;
}

} // namespace fppg
