#include "batch/wall_geometry.h"

#include "fppg/scene.h"

#include "walls/step_surfaces.h"

namespace fppg
{

TriangleSoup wall_geometry(const std::string& path, const CaseOptions& options, int threads)
{
    const CaseDef def = read_case(path, options);
    const Scene scene = make_scene(def);
    TriangleSoup out;
    for (const SceneStep& step : scene.remaining())
    {
        const DrawState& state = *step.draw->state;
        if (state.mk.kind != MkKind::Bound || !state.draw_points) continue;
        for (const StepSurface& surface : step_surfaces(scene, step, threads))
        {
            const std::vector<Vec3>& vertices = surface.shape.soup.vertices;
            out.vertices.insert(out.vertices.end(), vertices.begin(), vertices.end());
        }
    }
    return out;
}

} // namespace fppg
