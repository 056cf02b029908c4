#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "lattice/paint_scene.h"
#include "walls/fit_walls.h"

namespace fppg
{

RunField draw_scene(const Scene& scene, int threads, const LatticeProgress& progress,
                    LatticeReport& report)
{
    return paint_scene(scene, fit_walls(scene, threads, progress), threads, progress, report);
}

} // namespace fppg
