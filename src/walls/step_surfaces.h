#pragma once

#include "fppg/scene.h"

#include "scene/surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

namespace fppg
{

/// A surface of a step, in the coordinates of the case.
struct StepSurface
{
    ShapeMesh shape;
    /// Of a combination, per facet the mk of the part whose solid lies behind it; else empty.
    std::vector<std::uint16_t> facet_mk;
};

/// Whether one side of a surface may stand for all of it: where all facets have one mk, as a side
/// does not keep theirs.
///
/// facet_mk  StepSurface::facet_mk
inline bool may_have_sides(const std::vector<std::uint16_t>& facet_mk)
{
    return std::adjacent_find(facet_mk.begin(), facet_mk.end(), std::not_equal_to<>()) ==
           facet_mk.end();
}

/// The true surfaces that a step of a scene leaves: those of its shape, with all parts of
/// setmknextauto as one body, or that of its combination. None for all other steps.
///
/// thickens  plates, as walls are fitted to them (fitted_surfaces())
/// throws    IoError, GeometryError with the place of the draw
std::vector<StepSurface> step_surfaces(const Scene& scene, const SceneStep& step, int threads,
                                       bool thickens = false);

/// Whether a step draws boundary particles as a shape or a combination.
inline bool draws_bound(const SceneStep& step)
{
    const DrawState& state = *step.draw->state;
    return (step.combination || step.shape() != nullptr) && state.mk.kind == MkKind::Bound &&
           state.draw_points;
}

/// Whether sheets of a step get layers by FitSettings::sheet_depths_dp where fluid is on one side.
/// Shells of `<layers vdp>` are all that such a wall has, and between layers of DBC that move fast
/// fluid comes in.
///
/// fast  mks_of_fast_walls()
inline bool may_layer_sheets(const SceneStep& step, const std::set<std::uint16_t>& fast)
{
    const DrawOp& draw = step.combination ? *step.combination->parts[0] : *step.draw;
    return draw.surface == nullptr && !fast.contains(draw.state->mk.mk);
}

/// Whether a facet lies across an axis.
///
/// normal  of any length
inline bool lies_across(const Vec3& normal, int axis)
{
    constexpr double off_axis = 1e-8;
    return std::abs(normal[axis]) > (1 - off_axis) * norm(normal);
}

} // namespace fppg
