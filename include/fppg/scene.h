#pragma once

#include "fppg/case_def.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace fppg
{

class MeshLibrary;

/// A solid and what is drawn into it later, as they are when the scene is made.
struct HollowedSolid
{
    BooleanDef boolean; ///< the solid less all others
    std::vector<DrawOp> parts;
    std::vector<const SourceRef*> by; ///< the draws into it, in the case
};

/// Parts of a case that are drawn as one: those of a `<fppg><boolean>`, where the last of them
/// stands, or a solid less what is drawn into it later, in the solid's place.
struct Combination
{
    const BooleanDef* boolean = nullptr;
    /// The place and the state of the whole; no command. The state is that of the first part that
    /// stays in the result.
    DrawOp whole;
    std::vector<const DrawOp*> parts;
    std::vector<MkValue> mks; ///< per part, what its particles get
    std::vector<char> stays;  ///< per part, whether its solid stays in the result
    std::shared_ptr<const HollowedSolid> hollowed; ///< what `boolean` and `parts` are of; or null
};

/// A command of a case, or a combination.
struct SceneStep
{
    const DrawOp* draw = nullptr;                   ///< of a combination its `whole`
    std::shared_ptr<const Combination> combination; ///< null: a command
    bool is_part = false; ///< of a combination, which is drawn in its place

    /// What is drawn by itself at this step; null for edits, outputs, resets, parts, combinations.
    const Shape* shape() const;
    const Edit* edit() const;
};

/// What a case draws, in order, as all stages see it: Booleans stand behind their last part, and
/// mesh files are read once for all.
struct Scene
{
    const CaseDef* def = nullptr;
    std::vector<SceneStep> steps;
    std::size_t first_remaining = 0; ///< step behind the last `<resetdraw>`
    std::shared_ptr<MeshLibrary> meshes;
    /// The nodes that the floods of fills may reach, one set each in the order of the commands,
    /// slabs from 0 on; a set without slabs, or none, is no limit.
    std::vector<SpanSet> fill_limits;

    /// What nothing forgets: the steps behind the last `<resetdraw>`.
    std::span<const SceneStep> remaining() const
    {
        return std::span(steps).subspan(first_remaining);
    }
};

/// The scene of a case.
///
/// def  must outlive the scene
Scene make_scene(const CaseDef& def);

} // namespace fppg
