// Spheres and cylinders, which setfrdrawmode draws off the lattice too.
#include "lattice/paint_off_lattice.h"
#include "lattice/painting.h"
#include "shapes/kinds.h"

namespace fppg
{

void paint(Painting& painting, const Brush& brush, const SphereOp& op)
{
    if (brush.state->off_lattice)
        paint_off_lattice_sphere(painting, brush, op);
    else
        painting.canvas.paint(brush, kinds::nodes_of(op, *brush.state, painting.grid()));
}

void paint(Painting& painting, const Brush& brush, const CylinderOp& op)
{
    if (brush.state->off_lattice)
        paint_off_lattice_cylinder(painting, brush, op);
    else
        painting.canvas.paint(brush, kinds::nodes_of(op, *brush.state, painting.grid()));
}

} // namespace fppg
