#include "scene/hollowed_solids.h"

#include "fppg/combination.h"
#include "fppg/error.h"

#include "scene/surfaces.h"

#include <algorithm>
#include <utility>

namespace fppg
{
namespace
{

/// What reaches into a solid by less does not hollow it, dp: voids, fluid.
constexpr double void_reach_dp = 1e-3;
constexpr double fluid_reach_dp = 0.5 + 1e-6;

/// A step that draws a filled body.
struct Solid
{
    std::size_t step = 0;
    Box3 box;
};

/// The box of the filled body that a step draws; empty: it draws none.
Box3 box_of_solid(const Scene& scene, const SceneStep& step)
{
    const DrawState& state = *step.draw->state;
    const auto* file = shape_as<MeshFileOp>(*step.draw);
    Box3 box;
    if (step.shape() == nullptr || !state.draw_points || state.pattern || state.mk_next_auto ||
        state.off_lattice || state.mode == DrawMode::Wire || (file != nullptr && file->advanced))
        return box;
    try
    {
        for (const ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::Drawn, 1))
            for (const Vec3& v : shape.soup.vertices)
                if (shape.is_solid) box.add(v);
    }
    catch (const Error&)
    {
        return {}; // drawing it says what is wrong
    }
    return box;
}

bool overlap(const Box3& a, const Box3& b, double reach_dp, const LatticeGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double common =
            std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]);
        if (!(grid.is_2d && axis == 1) && !(common > reach_dp * grid.dp)) return false;
    }
    return true;
}

std::shared_ptr<const Combination> difference(const Scene& scene, std::size_t solid,
                                              const std::vector<std::size_t>& by)
{
    auto hollowed = std::make_shared<HollowedSolid>();
    auto out = std::make_shared<Combination>();
    hollowed->parts.push_back(*scene.steps[solid].draw);
    for (const std::size_t step : by)
    {
        hollowed->parts.push_back(*scene.steps[step].draw);
        hollowed->by.push_back(&scene.steps[step].draw->source);
    }
    const DrawOp& first = hollowed->parts.front();
    out->whole.source = first.source;
    out->whole.state = first.state;
    hollowed->boolean.line = first.source.line;
    hollowed->boolean.tree.op = BooleanOp::Difference;
    for (const DrawOp& part : hollowed->parts)
    {
        const auto index = static_cast<std::uint32_t>(out->parts.size());
        hollowed->boolean.tree.operands.push_back({BooleanOp::Part, index, {}});
        hollowed->boolean.parts.emplace_back();
        out->parts.push_back(&part);
        out->mks.push_back(first.state->mk); // the cavity moves with the solid
        out->stays.push_back(index == 0 ? 1 : 0);
    }
    out->boolean = &hollowed->boolean;
    out->hollowed = std::move(hollowed);
    return out;
}

} // namespace

void hollow_solids(Scene& scene)
{
    const CaseDef& def = *scene.def;
    if (def.fit.is_empty()) return;
    std::vector<Solid> solids;
    std::vector<std::vector<std::size_t>> drawn_into; // each solid
    for (std::size_t i = scene.first_remaining; i < scene.steps.size(); ++i)
    {
        const SceneStep& step = scene.steps[i];
        const MkValue& mk = step.draw->state->mk;
        const bool is_bound = mk.kind == MkKind::Bound;
        if (mk.kind == MkKind::Fluid && def.solver.inout.fluids.contains(mk.mk)) continue;
        if (is_bound ? fit_settings(def.fit, mk.mk) == nullptr
                     : solids.empty() || !step.draw->state->clips.empty())
            continue;
        const Box3 box = box_of_solid(scene, step);
        if (box.is_empty()) continue;
        if (is_bound)
        {
            solids.push_back({i, box});
            drawn_into.emplace_back();
            continue;
        }
        const double reach = mk.kind == MkKind::Void ? void_reach_dp : fluid_reach_dp;
        for (std::size_t s = 0; s < solids.size(); ++s)
            if (overlap(solids[s].box, box, reach, def.grid)) drawn_into[s].push_back(i);
    }
    for (std::size_t s = 0; s < solids.size(); ++s)
    {
        if (drawn_into[s].empty()) continue;
        std::shared_ptr<const Combination> combination =
            difference(scene, solids[s].step, drawn_into[s]);
        const DrawOp* whole = &combination->whole;
        scene.steps[solids[s].step] = {whole, std::move(combination), false};
    }
}

} // namespace fppg
