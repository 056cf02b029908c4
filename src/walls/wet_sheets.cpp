#include "walls/wet_sheets.h"

#include "core/parallel.h"
#include "nodes/run_at.h"
#include "offset/wall_depth.h"

#include <algorithm>
#include <array>
#include <vector>

namespace fppg
{
namespace
{

/// How far beyond the deepest layer fluid is looked for, dp: fills keep a step off it.
constexpr std::array<double, 2> beyond_dp{1, 1.5};
/// Of the particles of the deepest layer, with fluid beyond them.
constexpr double few = 0.05;
/// Of the particles of a thickened shell that have fluid before them, with fluid behind it as well.
constexpr double most_flooded = 0.5;
/// From the first layer of a thickened shell to its sides, dp.
constexpr double to_front_dp = 0.5;
constexpr double to_back_dp = 1.5;

class WetSheets
{
public:
    WetSheets(const RunField& field, std::uint16_t first)
        : field_(field), first_(first), deepest_(bodies().size(), 0)
    {
        for (const FittedBody& body : bodies())
            if (is_asked(body)) deepest_[body.owner] = std::max(deepest_[body.owner], body.layer);
    }

    std::set<std::uint32_t> steps(int threads) const
    {
        const WallParticles& all = field_.walls.particles;
        std::vector<std::uint32_t> found;
        for (std::uint32_t i = 0; i < all.size(); ++i)
            if (const FittedBody& body = bodies()[all.bodies[i]];
                is_asked(body) &&
                body.layer == (owner(body).is_thickened ? 0 : deepest_[body.owner]))
                found.push_back(i);
        std::vector<Sides> sides(found.size());
        parallel_for(
            found.size(), threads, [&](std::size_t k) { sides[k] = sides_of(found[k]); }, 1024);
        std::vector<std::array<double, 2>> counts(bodies().size());
        for (std::size_t k = 0; k < found.size(); ++k)
            if (sides[k].counts)
                ++counts[bodies()[all.bodies[found[k]]].owner][sides[k].is_wet ? 1 : 0];
        std::set<std::uint32_t> out;
        for (std::size_t b = 0; b < bodies().size(); ++b)
            if (counts[b][1] >
                (bodies()[b].is_thickened ? most_flooded : few) * (counts[b][0] + counts[b][1]))
                out.insert(bodies()[b].layered_step);
        return out;
    }

private:
    struct Sides
    {
        bool counts = true;
        bool is_wet = false; ///< behind the sheet
    };

    const std::vector<FittedBody>& bodies() const { return field_.walls.bodies; }
    const FittedBody& owner(const FittedBody& layer) const { return bodies()[layer.owner]; }
    bool is_asked(const FittedBody& body) const
    {
        return body.is_layer() && body.wall != nullptr && owner(body).layered_step != no_index;
    }

    Sides sides_of(std::uint32_t particle) const
    {
        const FittedBody& body = bodies()[field_.walls.particles.bodies[particle]];
        const Vec3& p = field_.walls.particles.positions[particle];
        const Vec3 way = field_.grid.dp * body.wall->at(p).direction;
        const auto has_fluid = [&](const Vec3& from, double sense)
        {
            return std::any_of(
                beyond_dp.begin(), beyond_dp.end(),
                [&](double beyond)
                { return has_fluid_near(field_, from + (sense * beyond) * way, first_); });
        };
        if (!owner(body).is_thickened) return {true, has_fluid_behind(*body.wall, p, way)};
        return {has_fluid(p - to_front_dp * way, -1), has_fluid(p + to_back_dp * way, 1)};
    }

    /// Not what is before the other side of a thin closed shell.
    bool has_fluid_behind(const WallDepth& wall, const Vec3& p, const Vec3& way) const
    {
        return std::any_of(beyond_dp.begin(), beyond_dp.end(),
                           [&](double beyond)
                           {
                               const Vec3 q = p + beyond * way;
                               return wall.at(q).depth > 0 && has_fluid_near(field_, q, first_);
                           });
    }

    const RunField& field_;
    std::uint16_t first_;      ///< absolute mk of the first boundary
    std::vector<int> deepest_; ///< layer, per body
};

} // namespace

std::set<std::uint32_t> wet_sheets(const RunField& field, std::uint16_t first, int threads)
{
    return WetSheets(field, first).steps(threads);
}

} // namespace fppg
