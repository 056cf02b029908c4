#include "fppg/scene.h"

#include "fppg/combination.h"

#include "meshes/mesh_library.h"
#include "scene/hollowed_solids.h"

#include <algorithm>
#include <utility>

namespace fppg
{
namespace
{

std::shared_ptr<const Combination> combination_of(const BooleanDef& boolean, const CaseDef& def)
{
    auto out = std::make_shared<Combination>();
    out->boolean = &boolean;
    for (const BooleanDef::Part& part : boolean.parts)
    {
        const DrawOp& draw = def.ops[part.op];
        out->parts.push_back(&draw);
        out->mks.push_back(draw.state->mk);
        if (boolean.mk)
            out->mks.back() = {MkKind::Bound, *boolean.mk,
                               static_cast<std::uint16_t>(*boolean.mk - def.mk_bound_first)};
    }
    out->stays = staying_parts(boolean.tree, boolean.parts.size());
    const auto first = static_cast<std::size_t>(std::find(out->stays.begin(), out->stays.end(), 1) -
                                                out->stays.begin());
    auto state = std::make_shared<DrawState>(*out->parts[first]->state);
    state->mk = out->mks[first];
    out->whole.source = {boolean.line, "boolean", boolean.name};
    out->whole.state = std::move(state);
    return out;
}

std::size_t last_part(const BooleanDef& boolean)
{
    std::size_t last = 0;
    for (const BooleanDef::Part& part : boolean.parts) last = std::max(last, part.op);
    return last;
}

} // namespace

const Shape* SceneStep::shape() const
{
    return combination || is_part ? nullptr : std::get_if<Shape>(&draw->what);
}

const Edit* SceneStep::edit() const
{
    return combination ? nullptr : std::get_if<Edit>(&draw->what);
}

Scene make_scene(const CaseDef& def)
{
    std::vector<char> is_part(def.ops.size(), 0);
    std::vector<std::pair<std::size_t, const BooleanDef*>> drawn; // by their last part
    for (const BooleanDef& boolean : def.booleans)
    {
        if (!boolean.is_drawn) continue;
        for (const BooleanDef::Part& part : boolean.parts) is_part[part.op] = 1;
        drawn.emplace_back(last_part(boolean), &boolean);
    }
    std::stable_sort(drawn.begin(), drawn.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Scene scene;
    scene.def = &def;
    scene.meshes = def.meshes ? def.meshes : std::make_shared<MeshLibrary>(def.file);
    scene.steps.reserve(def.ops.size() + drawn.size());
    auto next = drawn.begin();
    for (std::size_t i = 0; i < def.ops.size(); ++i)
    {
        scene.steps.push_back({&def.ops[i], nullptr, is_part[i] != 0});
        if (std::holds_alternative<ResetOp>(def.ops[i].what))
            scene.first_remaining = scene.steps.size();
        for (; next != drawn.end() && next->first == i; ++next)
        {
            std::shared_ptr<const Combination> combination = combination_of(*next->second, def);
            const DrawOp* whole = &combination->whole;
            scene.steps.push_back({whole, std::move(combination), false});
        }
    }
    hollow_solids(scene);
    return scene;
}

} // namespace fppg
