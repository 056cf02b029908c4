#include "walls/fast_walls.h"

#include "fppg/moving_parts.h"

#include "particles/farthest_points.h"
#include "particles/motion_path.h"
#include "scene/surfaces.h"
#include "walls/step_surfaces.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace fppg
{
namespace
{

constexpr double slow = 1.0 / 30; ///< of the speed of sound
constexpr int looks = 1000;       ///< at a motion
constexpr double end_without_time_max = 10;

Box3 box_around(const BoxLimits& limits)
{
    Box3 out;
    if (const auto* box = std::get_if<BoxRegion>(&limits))
        for (const Vec3& p : {box->corner0, box->corner1}) out.add(p);
    else
        for (const Vec3& p : std::get<PolyhedronOp>(limits).vertices) out.add(p);
    return out;
}

/// Of the fluid along gravity, metres: of a fill as far as it may go in the domain.
double depth_of_fluid(const Scene& scene, const std::vector<Box3>& fluid, const Vec3& up)
{
    const CaseDef& def = *scene.def;
    Box3 all;
    const auto add = [&](Box3 box)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            box.min[axis] = std::max(box.min[axis], def.case_pos_min[axis]);
            box.max[axis] = std::min(box.max[axis], def.case_pos_max[axis]);
        }
        if (box.is_empty()) return;
        for (const Vec3& p : {box.min, box.max}) all.add(p);
    };
    for (const Box3& box : fluid) add(box);
    const Box3 domain{def.case_pos_min, def.case_pos_max};
    for (const SceneStep& step : scene.steps)
    {
        if (step.combination || step.draw->state->mk.kind != MkKind::Fluid) continue;
        const auto* edit = std::get_if<Edit>(&step.draw->what);
        if (edit == nullptr) continue;
        if (std::holds_alternative<CavityFillOp>(*edit)) add(domain);
        if (const auto* fill = std::get_if<FillOp>(edit))
            add(fill->region ? box_around(*fill->region) : domain);
    }
    if (all.is_empty()) return 0;
    double depth = 0;
    for (int axis = 0; axis < 3; ++axis)
        depth += std::abs(up[axis]) * (all.max[axis] - all.min[axis]);
    return depth;
}

/// As the constants of the case will have it, or a little more.
double speed_of_sound(const Scene& scene, const std::vector<Box3>& fluid)
{
    const ConstantsDef& given = scene.def->constants;
    if (given.speed_sound) return *given.speed_sound;
    if (given.speed_system) return given.coef_sound * *given.speed_system;
    const double g = norm(given.gravity);
    if (!(g > 0)) return 0;
    const double depth =
        given.hswl ? *given.hswl : depth_of_fluid(scene, fluid, given.gravity / -g);
    return given.coef_sound * std::sqrt(g * depth);
}

FarthestPoints points_of_walls(const Scene& scene, std::uint16_t mk, int threads)
{
    FarthestPoints out;
    for (const SceneStep& step : scene.steps)
    {
        if (!draws_bound(step) || step.draw->state->mk.mk != mk) continue;
        for (const StepSurface& surface : step_surfaces(scene, step, threads))
            for (const Vec3& p : surface.shape.soup.vertices) out.add(p);
    }
    return out;
}

} // namespace

std::set<std::uint16_t> mks_of_fast_walls(const Scene& scene, const std::vector<Box3>& fluid,
                                          int threads)
{
    const CaseDef& def = *scene.def;
    std::set<std::uint16_t> out;
    for (const FloatingDef& floating : def.floatings)
        for (const std::uint16_t mkbound : floating.mkbound)
            if (!floating.mass_body)
                out.insert(static_cast<std::uint16_t>(mkbound + def.mk_bound_first));
    const std::set<int> moving = moving_mkbound(def.motion);
    if (moving.empty()) return out;
    const double allowed = slow * speed_of_sound(scene, fluid);
    const double step = time_max(def.execution, end_without_time_max) / looks;
    FarthestPoints corners;
    for (const Vec3& p : Box3{def.case_pos_min, def.case_pos_max}.corners()) corners.add(p);
    for_each_moving(def.motion,
                    [&](const Element& object, const MotionChain& chain)
                    {
                        const auto mkbound = static_cast<int>(number_or(object, "ref", -1));
                        if (!moving.contains(mkbound) || !(step > 0)) return;
                        const auto mk = static_cast<std::uint16_t>(mkbound + def.mk_bound_first);
                        const std::vector<Transform> places = places_over(chain, step, looks);
                        const auto is_fast = [&](const FarthestPoints& points)
                        { return top_speed(places, step, points.points()).speed > allowed; };
                        // The meshes are asked where it matters that what turns is smaller.
                        if (is_fast(corners) && is_fast(points_of_walls(scene, mk, threads)))
                            out.insert(mk);
                    });
    return out;
}

} // namespace fppg
