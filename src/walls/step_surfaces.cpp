#include "walls/step_surfaces.h"

#include "fppg/boolean.h"

#include "walls/boolean_wall.h"
#include "walls/thickened.h"

#include <fmt/format.h>

#include <utility>

namespace fppg
{

std::vector<StepSurface> step_surfaces(const Scene& scene, const SceneStep& step, int threads,
                                       bool thickens)
{
    if (!step.combination && step.shape() == nullptr) return {};
    if (!step.combination) mesh_of(scene, *step.draw, threads); // says what is wrong with the file
    std::vector<BooleanWallPart> parts;
    if (step.combination) parts = boolean_parts(scene, *step.combination, PartsAs::One, threads);
    try
    {
        if (!step.combination)
        {
            std::vector<StepSurface> out;
            for (ShapeMesh& shape : surfaces_of(scene, *step.draw, PartsAs::One, threads))
            {
                if (thickens && shape.is_solid) thicken(scene.def->grid, threads, shape);
                out.push_back({std::move(shape), {}});
            }
            return out;
        }
        CombinedParts combined = combine_parts(std::move(parts), step.combination->boolean->tree,
                                               scene.def->grid.dp, threads);
        if (thickens && !combined.parts[0].is_surface)
            thicken(scene.def->grid, threads, combined.result.mesh);
        return {{shape_of(combined), mks_of_facets(combined)}};
    }
    catch (const GeometryError& e)
    {
        if (is_hollowed_away(step.combination.get(), e)) return {};
        throw GeometryError(
            fmt::format("{}: {}", place_of(*scene.def, step.draw->source), e.what()));
    }
}

} // namespace fppg
