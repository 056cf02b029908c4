#pragma once

#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "lattice/canvas.h"
#include "lattice/draw_checks.h"
#include "shapes/plane_shapes.h"

#include <set>
#include <vector>

namespace fppg
{

/// What the draws of a case share while they are painted in order.
struct Painting
{
    Painting(const Scene& drawn, int threads, LatticeReport& said)
        : scene(drawn),
          def(*drawn.def),
          report(said),
          checks(*drawn.def, said.warnings),
          canvas(*drawn.def, threads)
    {
    }

    const LatticeGrid& grid() const { return def.grid; }

    const Scene& scene;
    const CaseDef& def;
    LatticeReport& report;
    DrawChecks checks;
    Canvas canvas;
    std::set<const MeshFile*> used; ///< mesh files that the report tells of
    std::size_t floods = 0;         ///< fills that were painted
};

// A file a kind of draw. Each paints one draw over what is there; clips, pattern and mk are the
// brush's. Kinds of shapes without a function here are painted by their nodes alone.

// paint_polyhedron.cpp
void paint(Painting& painting, const Brush& brush, const PointsOp& op);
void paint(Painting& painting, const Brush& brush, const LinesOp& op);
void paint(Painting& painting, const Brush& brush, const PolyhedronOp& op);
/// Nodes by their distance to triangles, which the report counts.
void paint_triangles(Painting& painting, const Brush& brush,
                     std::vector<SnappedTriangle> triangles);
/// The inside of a polyhedron with the constants of setdpctes.
SlabRegion solid_of(const PolyhedronOp& polyhedron, const DrawState& state,
                    const LatticeGrid& grid);

// paint_round.cpp
void paint(Painting& painting, const Brush& brush, const SphereOp& op);
void paint(Painting& painting, const Brush& brush, const CylinderOp& op);

// paint_mesh.cpp
void paint(Painting& painting, const Brush& brush, const MeshFileOp& op);

// paint_fill.cpp
void paint(Painting& painting, const Brush& brush, const FillOp& op);
void paint(Painting& painting, const Brush& brush, const CavityFillOp& op);
void paint(Painting& painting, const Brush& brush, const RedrawOp& op);
void paint(Painting& painting, const Brush& brush, const RedrawNearOp& op);

} // namespace fppg
