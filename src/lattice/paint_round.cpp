// Spheres, cylinders, ellipsoids and waves.
#include "fppg/error.h"

#include "lattice/paint_free.h"
#include "lattice/painting.h"
#include "lattice/round_shapes.h"
#include "lattice/wave_region.h"

#include <fmt/format.h>

namespace fppg
{

void paint(Painting& painting, const Brush& brush, const SphereOp& op)
{
    if (brush.state->off_lattice)
        paint_free_sphere(painting, brush, op);
    else
        painting.canvas.paint(brush, sphere_region(op, *brush.state, painting.grid()));
}

void paint(Painting& painting, const Brush& brush, const CylinderOp& op)
{
    if (brush.state->off_lattice)
        paint_free_cylinder(painting, brush, op);
    else
        painting.canvas.paint(brush, cylinder_region(op, *brush.state, painting.grid()));
}

void paint(Painting& painting, const Brush& brush, const EllipsoidOp& op)
{
    if (brush.state->off_lattice)
        throw CaseError(painting.def.file, brush.source->line,
                        fmt::format("<{}>: an ellipsoid is not possible with setfrdrawmode "
                                    "(GenCase refuses it too)",
                                    brush.source->command));
    painting.canvas.paint(brush, ellipsoid_region(op, *brush.state, painting.grid()));
}

void paint(Painting& painting, const Brush& brush, const WaveOp& op)
{
    painting.canvas.paint(brush, wave_region(op, painting.grid()));
}

} // namespace fppg
