#include "walls/stacked_shells.h"

#include "offset/wall_depth.h"
#include "scene/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

/// A shell has this share of its surface among the layers of another one.
constexpr double most = 0.7;
/// More than this: they stand for it.
constexpr double nearly_all = 0.95;
/// Nearer to the surface of the other one, dp, it is the same surface.
constexpr double same_dp = 0.25;
constexpr std::size_t most_samples = 200;

struct Shell
{
    std::size_t step = 0;
    FittedDraw* draw = nullptr;
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

/// Which share of a shell stands among the layers of another one; 0 where it reaches beyond them.
double share_among_layers(const Shell& shell, const Shell& of, const LatticeGrid& grid)
{
    const std::vector<FittedBody>& layers = of.draw->layers;
    double deepest = 0;
    for (const FittedBody& layer : layers) deepest = std::max(deepest, layer.depth);
    const double reach = deepest + grid.dp;
    if (!of.box.has(shell.box.min, reach) || !of.box.has(shell.box.max, reach)) return 0;
    const WallDepth& wall = *layers.front().wall;
    const auto within = std::count_if(shell.samples.begin(), shell.samples.end(),
                                      [&](const Vec3& p)
                                      {
                                          const DepthPlace place = wall.at(p);
                                          return !place.is_beyond_rim &&
                                                 place.depth > same_dp * grid.dp &&
                                                 place.depth < deepest + 0.5 * grid.dp;
                                      });
    return static_cast<double>(within) / static_cast<double>(shell.samples.size());
}

/// Whether something that takes walls away is drawn between two steps.
bool has_void_between(const Scene& scene, std::size_t a, std::size_t b)
{
    for (std::size_t i = std::min(a, b) + 1; i < std::max(a, b); ++i)
    {
        const SceneStep& step = scene.steps[i];
        const bool is_void = !step.combination && step.draw->state->mk.kind == MkKind::Void;
        if (is_void || std::holds_alternative<ResetOp>(step.draw->what)) return true;
    }
    return false;
}

std::vector<Shell> shells_of(const Scene& scene, std::vector<FittedStep>& steps)
{
    std::vector<Shell> shells;
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (FittedDraw& draw : steps[i].draws)
        {
            if (draw.body.is_solid || draw.layers.empty() || draw.layers.front().wall == nullptr)
                continue;
            Shell shell{i, &draw, {}, samples_of(draw.body.mesh, scene.def->grid)};
            for (const Vec3& p : shell.samples) shell.box.add(p);
            if (!shell.samples.empty()) shells.push_back(std::move(shell));
        }
    return shells;
}

} // namespace

std::set<std::uint32_t> leave_out_stacked_shells(const Scene& scene, std::vector<FittedStep>& steps)
{
    std::set<std::uint32_t> thickened;
    const std::vector<Shell> shells = shells_of(scene, steps);
    std::set<std::pair<int, bool>> said; // line, whether it is left out
    std::set<const FittedDraw*> left_out;
    const LatticeGrid& grid = scene.def->grid;
    for (const Shell& shell : shells)
    {
        double share = 0;
        const Shell* in = nullptr;
        for (const Shell& of : shells)
        {
            if (&of == &shell || of.draw->body.mk != shell.draw->body.mk ||
                has_void_between(scene, of.step, shell.step))
                continue;
            const double among = share_among_layers(shell, of, grid);
            if (among <= share || share_among_layers(of, shell, grid) > 1 - nearly_all) continue;
            share = among;
            in = &of;
        }
        if (share <= most) continue;
        if (shell.draw->body.layered_step != no_index)
        {
            for (const FittedDraw* draw : {shell.draw, in->draw})
                thickened.insert(draw->body.layered_step);
            continue;
        }
        const bool is_left_out = share > nearly_all;
        if (is_left_out) left_out.insert(shell.draw);
        if (!said.emplace(shell.draw->body.line, is_left_out).second) continue;
        steps[shell.step].warnings.push_back(fmt::format(
            "{}: this surface stands among the layers of <{}> of line {}, as where a wall is "
            "thickened shell by shell{}",
            place_of(*scene.def, scene.steps[shell.step].draw->source), in->draw->body.name,
            in->draw->body.line,
            is_left_out ? ": it is left out, as layers do that here."
                        : ": layers do that here, so draw the wall's surface alone."));
    }
    for (FittedStep& step : steps)
        std::erase_if(step.draws, [&](const FittedDraw& draw) { return left_out.contains(&draw); });
    return thickened;
}

} // namespace fppg
