#include "walls/stacked_shells.h"

#include "offset/wall_depth.h"
#include "scene/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace fppg
{
namespace
{

/// A shell has this share of its surface among the layers of another one.
constexpr double nearly_all = 0.7;
/// Nearer to the surface of the other one, dp, it is the same surface.
constexpr double same_dp = 0.25;
constexpr std::size_t most_samples = 200;

struct Shell
{
    std::size_t step = 0;
    const FittedDraw* draw = nullptr;
    Box3 box;
    std::vector<Vec3> samples;
};

/// Places inside facets: one on a rim may be beyond the rim of the other surface.
std::vector<Vec3> samples_of(const SurfaceMesh& mesh, const LatticeGrid& grid)
{
    std::vector<Vec3> out;
    const std::size_t stride = mesh.facets.size() / most_samples + 1;
    for (std::size_t f = 0; f < mesh.facets.size(); f += stride)
    {
        Vec3 middle;
        for (const std::uint32_t v : mesh.facets[f]) middle = middle + mesh.vertices[v] / 3;
        for (const std::uint32_t v : mesh.facets[f])
            out.push_back(0.4 * mesh.vertices[v] + 0.6 * middle);
    }
    if (grid.is_2d)
        for (Vec3& p : out) p.y = grid.origin.y;
    return out;
}

bool is_among_layers(const Shell& shell, const Shell& of, const LatticeGrid& grid)
{
    const std::vector<FittedBody>& layers = of.draw->layers;
    double deepest = 0;
    for (const FittedBody& layer : layers) deepest = std::max(deepest, layer.depth);
    const double reach = deepest + grid.dp;
    if (!of.box.has(shell.box.min, reach) || !of.box.has(shell.box.max, reach)) return false;
    const WallDepth& wall = *layers.front().wall;
    const auto within = std::count_if(shell.samples.begin(), shell.samples.end(),
                                      [&](const Vec3& p)
                                      {
                                          const DepthPlace place = wall.at(p);
                                          return !place.is_beyond_rim &&
                                                 place.depth > same_dp * grid.dp &&
                                                 place.depth < deepest + 0.5 * grid.dp;
                                      });
    return static_cast<double>(within) > nearly_all * static_cast<double>(shell.samples.size());
}

} // namespace

void warn_of_stacked_shells(const Scene& scene, std::vector<FittedStep>& steps)
{
    std::vector<Shell> shells;
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (const FittedDraw& draw : steps[i].draws)
        {
            if (draw.body.is_solid || draw.layers.empty() || draw.layers.front().wall == nullptr)
                continue;
            Shell shell{i, &draw, {}, samples_of(draw.body.mesh, scene.def->grid)};
            for (const Vec3& p : shell.samples) shell.box.add(p);
            if (!shell.samples.empty()) shells.push_back(std::move(shell));
        }
    std::set<int> lines;
    for (const Shell& shell : shells)
    {
        const auto holds = [&](const Shell& of)
        {
            return &of != &shell && of.draw->body.mk == shell.draw->body.mk &&
                   is_among_layers(shell, of, scene.def->grid);
        };
        const auto found = std::find_if(shells.begin(), shells.end(), holds);
        if (found == shells.end() || !lines.insert(shell.draw->body.line).second) continue;
        steps[shell.step].warnings.push_back(fmt::format(
            "{}: this surface stands among the layers of <{}> of line {}, as where a wall is "
            "thickened shell by shell: layers do that here, so draw the wall's surface alone.",
            place_of(*scene.def, scene.steps[shell.step].draw->source), found->draw->body.name,
            found->draw->body.line));
    }
}

} // namespace fppg
