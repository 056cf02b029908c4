#include "scene/hollowed_solids.h"

#include "fppg/combination.h"
#include "fppg/error.h"

#include "meshes/open_edges.h"
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

/// A step that draws a filled body, and those that are drawn into it.
struct Solid
{
    std::size_t step = 0;
    Box3 box;
    bool is_closed = false;
    std::vector<std::size_t> drawn_into{};
};

/// What a step fills, by its true shape; an empty box: nothing. Surfaces with open edges, whose
/// inside is a guess, cannot be cut exactly.
Solid solid_of(const Scene& scene, std::size_t index)
{
    const SceneStep& step = scene.steps[index];
    const DrawState& state = *step.draw->state;
    const auto* file = shape_as<MeshFileOp>(*step.draw);
    Solid out{index, {}, true};
    if (!state.draw_points || state.pattern || state.mk_next_auto || state.off_lattice ||
        state.mode == DrawMode::Wire || (file != nullptr && file->advanced))
        return out;
    try
    {
        for (const ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::Drawn, 1))
        {
            if (!shape.is_solid) continue;
            for (const Vec3& v : shape.soup.vertices) out.box.add(v);
            out.is_closed = out.is_closed && open_edge_count(shape.soup) == 0;
        }
    }
    catch (const Error&)
    {
        out.box = {}; // drawing it says what is wrong
    }
    return out;
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
    const auto is_fitted = [&](const SceneStep& step)
    {
        const MkValue& mk = step.draw->state->mk;
        return step.shape() != nullptr && mk.kind == MkKind::Bound &&
               fit_settings(def.fit, mk.mk) != nullptr;
    };
    const auto may_hollow = [&](const SceneStep& step)
    {
        const DrawState& state = *step.draw->state;
        return step.shape() != nullptr && state.mk.kind != MkKind::Bound && state.clips.empty() &&
               !def.solver.inout.fluids.contains(state.mk.mk);
    };
    // Meshes are not looked at where nothing is drawn behind them.
    std::size_t end = scene.steps.size();
    while (end > scene.first_remaining && !may_hollow(scene.steps[end - 1])) --end;
    std::vector<Solid> solids;
    for (std::size_t i = scene.first_remaining; i < end; ++i)
    {
        const bool is_bound = is_fitted(scene.steps[i]);
        if (!is_bound && (solids.empty() || !may_hollow(scene.steps[i]))) continue;
        Solid here = solid_of(scene, i);
        if (here.box.is_empty() || !here.is_closed) continue;
        if (is_bound)
        {
            solids.push_back(std::move(here));
            continue;
        }
        const bool is_void = scene.steps[i].draw->state->mk.kind == MkKind::Void;
        for (Solid& solid : solids)
            if (overlap(solid.box, here.box, is_void ? void_reach_dp : fluid_reach_dp, def.grid))
                solid.drawn_into.push_back(i);
    }
    for (const Solid& solid : solids)
    {
        if (solid.drawn_into.empty()) continue;
        std::shared_ptr<const Combination> combination =
            difference(scene, solid.step, solid.drawn_into);
        const DrawOp* whole = &combination->whole;
        scene.steps[solid.step] = {whole, std::move(combination), false};
    }
}

} // namespace fppg
