#include "particles/roofs.h"

#include "meshes/point_grid.h"

#include <cmath>
#include <queue>
#include <tuple>

namespace fppg
{
namespace
{

class RoofLevels
{
public:
    RoofLevels(const RunField& field, const OffLatticeParticles& off_lattice,
               const std::function<Vec3(const Vec3&)>& place, const DepthMeter& meter,
               std::vector<std::vector<std::uint32_t>>& top)
        : field_(field),
          meter_(meter),
          top_(top),
          walls_(2 * field.grid.dp, 0),
          roofed_(field.slabs.size())
    {
        const Box3 water = box_of_water();
        if (water.is_empty()) return;
        for (std::size_t i = 0; i < off_lattice.size(); ++i)
        {
            if (!off_lattice.is_of_wall(i)) continue;
            const Vec3 p = place(off_lattice.positions[i]);
            if (water.has(p, reach_dp * field.grid.dp)) walls_.add(p);
        }
    }

    void run()
    {
        bool has_roofs = false;
        for (std::uint32_t x = 0; x < field_.slabs.size(); ++x)
        {
            roofed_[x].assign(field_.slabs[x].size(), 0);
            for (std::uint32_t i = 0; i < field_.slabs[x].size(); ++i)
            {
                if (!is_water(x, i)) continue;
                const std::size_t last = top_of_column(x, i);
                // GenCase adds a step below a wall.
                top_[x][i] = field_.slabs[x][last].z_end - field_.slabs[x][i].z_end;
                roofed_[x][i] = is_roofed(x, last);
                has_roofs = has_roofs || roofed_[x][i];
            }
        }
        if (!has_roofs) return;
        for (std::uint32_t x = 0; x < field_.slabs.size(); ++x)
            for (std::uint32_t i = 0; i < field_.slabs[x].size(); ++i)
                if (is_water(x, i)) open_.push({level(x, i), x, i});
        while (!open_.empty())
        {
            const auto [high, x, i] = open_.top();
            open_.pop();
            if (high != level(x, i)) continue;
            const std::uint32_t y = field_.slabs[x][i].y;
            raise_beside(x, i, x, y + 1);
            if (y > 0) raise_beside(x, i, x, y - 1);
            if (x + 1 < field_.slabs.size()) raise_beside(x, i, x + 1, y);
            if (x > 0) raise_beside(x, i, x - 1, y);
        }
    }

private:
    /// A wall so near above a column is its roof, dp.
    static constexpr double reach_dp = 2.2;

    Box3 box_of_water() const
    {
        Box3 box;
        for (std::uint32_t x = 0; x < field_.slabs.size(); ++x)
            for (std::uint32_t i = 0; i < field_.slabs[x].size(); ++i)
            {
                if (!is_water(x, i)) continue;
                const Run& run = field_.slabs[x][i];
                for (const std::uint32_t z : {run.z_begin, run.z_end - 1})
                    box.add(field_.grid.place({static_cast<double>(x), static_cast<double>(run.y),
                                               static_cast<double>(z)}));
            }
        return box;
    }

    bool is_water(std::uint32_t x, std::uint32_t i) const
    {
        return meter_.is_fluid(field_.slabs[x][i].mk);
    }
    /// The node at the surface above a run.
    std::uint32_t level(std::uint32_t x, std::uint32_t i) const
    {
        return field_.slabs[x][i].z_end - 1 + top_[x][i];
    }

    /// The highest run of the water column of a run.
    std::size_t top_of_column(std::uint32_t x, std::size_t i) const
    {
        const std::vector<Run>& runs = field_.slabs[x];
        while (i + 1 < runs.size() && runs[i + 1].y == runs[i].y &&
               runs[i + 1].z_begin == runs[i].z_end &&
               is_water(x, static_cast<std::uint32_t>(i + 1)))
            ++i;
        return i;
    }

    /// Whether a wall is above a run that ends its column.
    bool is_roofed(std::uint32_t x, std::size_t last) const
    {
        const std::vector<Run>& runs = field_.slabs[x];
        constexpr std::uint32_t reach = 2; // nodes
        const std::uint32_t end = runs[last].z_end;
        if (last + 1 < runs.size() && runs[last + 1].y == runs[last].y &&
            runs[last + 1].z_begin < end + reach && !meter_.is_fluid(runs[last + 1].mk))
            return true;
        const double dp = field_.grid.dp;
        const Vec3 at =
            field_.grid.place({static_cast<double>(x), static_cast<double>(runs[last].y),
                               static_cast<double>(end - 1)});
        bool found = false;
        walls_.for_each_near(
            at, reach_dp * dp,
            [&](std::uint32_t w, double)
            {
                const Vec3 away = walls_.points()[w] - at;
                found = found ||
                        (away.z > 0.3 * dp && away.x * away.x + away.y * away.y < away.z * away.z);
            });
        return found;
    }

    /// Raises roofed water in a column beside a run.
    void raise_beside(std::uint32_t x, std::uint32_t i, std::uint32_t to_x, std::uint32_t y)
    {
        const Run& from = field_.slabs[x][i];
        const std::uint32_t high = level(x, i);
        const std::vector<Run>& runs = field_.slabs[to_x];
        auto run = std::lower_bound(runs.begin(), runs.end(), std::pair(y, from.z_begin),
                                    [](const Run& r, const auto& v)
                                    { return std::pair(r.y, r.z_end - 1) < v; });
        for (; run != runs.end() && run->y == y && run->z_begin < from.z_end; ++run)
        {
            const auto at = static_cast<std::uint32_t>(run - runs.begin());
            if (!roofed_[to_x][at] || level(to_x, at) >= high) continue;
            top_[to_x][at] = high - (run->z_end - 1);
            open_.push({high, to_x, at});
            raise_column(to_x, at, high);
        }
    }

    /// The water above and below a run in its column has the same level.
    void raise_column(std::uint32_t x, std::uint32_t i, std::uint32_t high)
    {
        const std::vector<Run>& runs = field_.slabs[x];
        const auto raise = [&](std::uint32_t at)
        {
            if (level(x, at) >= high) return;
            top_[x][at] = high - (runs[at].z_end - 1);
            open_.push({high, x, at});
        };
        const auto touch = [&](std::uint32_t lower)
        {
            return runs[lower].y == runs[lower + 1].y &&
                   runs[lower].z_end == runs[lower + 1].z_begin && is_water(x, lower) &&
                   is_water(x, lower + 1);
        };
        for (std::uint32_t at = i; at + 1 < runs.size() && touch(at); ++at) raise(at + 1);
        for (std::uint32_t at = i; at > 0 && touch(at - 1); --at) raise(at - 1);
    }

    struct Open
    {
        std::uint32_t level = 0;
        std::uint32_t x = 0;
        std::uint32_t run = 0;
        bool operator<(const Open& other) const
        {
            // The highest first; ties do not matter, as all runs end at the same levels.
            return std::tuple(level, other.x, other.run) < std::tuple(other.level, x, run);
        }
    };

    const RunField& field_;
    const DepthMeter& meter_;
    std::vector<std::vector<std::uint32_t>>& top_;
    PointGrid walls_;
    std::vector<std::vector<char>> roofed_;
    std::priority_queue<Open> open_;
};

} // namespace

void raise_roofed_depths(const RunField& field, const OffLatticeParticles& off_lattice,
                         const std::function<Vec3(const Vec3&)>& place, const DepthMeter& meter,
                         std::vector<std::vector<std::uint32_t>>& top)
{
    RoofLevels(field, off_lattice, place, meter, top).run();
}

} // namespace fppg
