#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "lattice/paint_scene.h"
#include "walls/fit_walls.h"
#include "walls/wet_sheets.h"

#include <utility>

namespace fppg
{

RunField draw_scene(const Scene& scene, int threads, const LatticeProgress& progress,
                    LatticeReport& report)
{
    LatticeReport first = report;
    RunField field =
        paint_scene(scene, fit_walls(scene, {}, threads, progress), threads, progress, first);
    const std::set<std::uint32_t> wet = wet_sheets(field, scene.def->mk_bound_first, threads);
    if (wet.empty())
    {
        report = std::move(first);
        return field;
    }
    // Where fluid comes is known only now: these have one layer.
    field = {};
    return paint_scene(scene, fit_walls(scene, wet, threads, progress), threads, progress, report);
}

} // namespace fppg
