#pragma once

#include "fppg/check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace fppg
{

/// Where fluid can come besides the fluid of the case: nodes of a lattice, as runs along z.
class FillNodes
{
public:
    struct NodeRun
    {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    Vec3 origin;
    double dp = 1;
    std::array<std::int64_t, 3> n{};      ///< the slabs beyond open sides included
    std::array<std::int64_t, 3> beyond{}; ///< nodes of these slabs, before and behind, of each axis
    std::vector<std::uint64_t> begins; ///< of the runs of each column (x * n[1] + y), and the end
    std::vector<NodeRun> runs;

    std::uint64_t size() const
    {
        std::uint64_t count = 0;
        for (const NodeRun& r : runs) count += r.end - r.begin;
        return count;
    }

    /// Calls stop(way from p to the node, squared distance) for the nodes within `radius` of p
    /// until it returns true; whether it did.
    template <typename Stop>
    bool find_near(const Vec3& p, double radius, const Stop& stop) const
    {
        if (runs.empty()) return false;
        const std::int64_t x1 = last(p.x + radius, 0), y0 = first(p.y - radius, 1),
                           y1 = last(p.y + radius, 1);
        // Nested because a place has columns around it, these runs, and those nodes.
        for (std::int64_t x = first(p.x - radius, 0); x <= x1; ++x)
            for (std::int64_t y = y0; y <= y1; ++y)
            {
                Vec3 way{origin.x + static_cast<double>(x) * dp - p.x,
                         origin.y + static_cast<double>(y) * dp - p.y, 0};
                const double left = radius * radius - dot(way, way);
                if (left < 0) continue;
                const std::int64_t z0 = first(p.z - std::sqrt(left), 2),
                                   z1 = last(p.z + std::sqrt(left), 2);
                const auto column = static_cast<std::size_t>(x * n[1] + y);
                for (std::uint64_t r = run_from(column, z0);
                     r < begins[column + 1] && runs[r].begin <= z1; ++r)
                    for (std::int64_t z = std::max<std::int64_t>(z0, runs[r].begin),
                                      end = std::min<std::int64_t>(z1 + 1, runs[r].end);
                         z < end; ++z)
                    {
                        way.z = origin.z + static_cast<double>(z) * dp - p.z;
                        if (stop(way, dot(way, way))) return true;
                    }
            }
        return false;
    }

    /// Of a column.
    std::pair<std::int64_t, std::int64_t> xy_of(std::size_t column) const
    {
        const auto c = static_cast<std::int64_t>(column);
        return {c / n[1], c % n[1]};
    }
    /// Beyond which side of the box a run lies: 0 to 5 for x, y and z, before and behind; -1 in the
    /// box.
    int side_of(std::size_t column, const NodeRun& run) const
    {
        const auto [x, y] = xy_of(column);
        const std::int64_t at[3] = {x, y, run.begin};
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto a = static_cast<std::size_t>(axis);
            if (at[a] < beyond[a]) return 2 * axis;
            if (at[a] >= n[a] - beyond[a]) return 2 * axis + 1;
        }
        return -1;
    }

    /// Calls visit(run, column) for the runs in the four columns beside one that have nodes at
    /// heights of a run of it.
    template <typename Visit>
    void for_each_beside(std::size_t column, const NodeRun& of, const Visit& visit) const
    {
        const auto [x, y] = xy_of(column);
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
        {
            if (x + dx < 0 || x + dx >= n[0] || y + dy < 0 || y + dy >= n[1]) continue;
            const auto beside = static_cast<std::size_t>((x + dx) * n[1] + y + dy);
            for (std::uint64_t r = run_from(beside, of.begin);
                 r < begins[beside + 1] && runs[r].begin < of.end; ++r)
                visit(r, beside);
        }
    }

    /// The first run of a column that ends above node z.
    std::uint64_t run_from(std::size_t column, std::int64_t z) const
    {
        const auto end = runs.begin() + static_cast<std::ptrdiff_t>(begins[column + 1]);
        const auto it =
            std::partition_point(runs.begin() + static_cast<std::ptrdiff_t>(begins[column]), end,
                                 [z](const NodeRun& r) { return r.end <= z; });
        return static_cast<std::uint64_t>(it - runs.begin());
    }
    /// The first node at or above a place along an axis, and the last at or below, of the lattice.
    std::int64_t first(double place, int axis) const
    {
        const double at = std::ceil((place - origin[axis]) / dp - 1e-9);
        return static_cast<std::int64_t>(
            std::clamp(at, 0.0, static_cast<double>(n[at_axis(axis)])));
    }
    std::int64_t last(double place, int axis) const
    {
        const double at = std::floor((place - origin[axis]) / dp + 1e-9);
        return static_cast<std::int64_t>(
            std::clamp(at, -1.0, static_cast<double>(n[at_axis(axis)] - 1)));
    }

private:
    static std::size_t at_axis(int axis) { return static_cast<std::size_t>(axis); }
};

/// Where fluid can come, by the rules of check_particles().
///
/// walls, fluid  indices of the particles, which have finite places
/// returns       no nodes where the box of all boundary particles has too many columns
FillNodes fill_cavity(const CheckParticles& particles, const CheckSetup& setup,
                      const std::vector<std::uint32_t>& walls,
                      const std::vector<std::uint32_t>& fluid, int threads);

} // namespace fppg
