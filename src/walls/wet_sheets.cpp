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

} // namespace

std::set<std::uint32_t> wet_sheets(const RunField& field, std::uint16_t first, int threads)
{
    const std::vector<FittedBody>& bodies = field.walls.bodies;
    const WallParticles& all = field.walls.particles;
    const auto step_of = [&](const FittedBody& layer) { return bodies[layer.owner].layered_step; };
    std::vector<int> deepest(bodies.size(), 0);
    for (const FittedBody& body : bodies)
        if (body.is_layer() && body.wall != nullptr && step_of(body) != no_index)
            deepest[body.owner] = std::max(deepest[body.owner], body.layer);
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < all.size(); ++i)
    {
        const FittedBody& body = bodies[all.bodies[i]];
        if (body.is_layer() && body.wall != nullptr && step_of(body) != no_index &&
            body.layer == deepest[body.owner])
            found.push_back(i);
    }
    std::vector<char> is_wet(found.size());
    parallel_for(
        found.size(), threads,
        [&](std::size_t k)
        {
            const Vec3& p = all.positions[found[k]];
            const Vec3 way = bodies[all.bodies[found[k]]].wall->at(p).direction;
            is_wet[k] = std::any_of(
                beyond_dp.begin(), beyond_dp.end(),
                [&](double dp)
                { return has_fluid_near(field, p + (dp * field.grid.dp) * way, first); });
        },
        1024);
    std::vector<std::array<double, 2>> counts(bodies.size());
    for (std::size_t k = 0; k < found.size(); ++k)
        ++counts[bodies[all.bodies[found[k]]].owner][is_wet[k] != 0 ? 1 : 0];
    std::set<std::uint32_t> out;
    for (std::size_t b = 0; b < bodies.size(); ++b)
        if (counts[b][1] > few * (counts[b][0] + counts[b][1])) out.insert(bodies[b].layered_step);
    return out;
}

} // namespace fppg
