// Points, lines and what planes bound.
#include "lattice/paint_off_lattice.h"
#include "lattice/painting.h"
#include "nodes/snap.h"
#include "shapes/plane_shapes.h"
#include "shapes/polyhedra.h"
#include "shapes/solids.h"

#include <utility>
#include <vector>

namespace fppg
{
namespace
{

using NodeSegments = std::vector<std::pair<Node, Node>>;

void paint_segments(Painting& painting, const Brush& brush, const NodeSegments& segments)
{
    painting.canvas.paint(brush,
                          lines_region(segments, painting.grid(), brush.state->constants.line));
}

/// The sides of the visible triangles and quads, in this order: so the wire of a solid box
/// shows the cut between its two prisms (rule S4).
NodeSegments wire_of(const PolyhedronOp& op, const LatticeGrid& grid)
{
    NodeSegments segments;
    PolyhedronOp one = op;
    for (const PolyhedronFace& face : op.faces)
    {
        if (!face.is_visible) continue;
        if (face.triangles.empty() && face.cut.empty())
        {
            const std::vector<std::uint32_t>& v = face.vertices;
            for (std::size_t i = 0; i < v.size(); ++i)
                segments.emplace_back(snap(op.vertices[v[i]], grid),
                                      snap(op.vertices[v[(i + 1) % v.size()]], grid));
            continue;
        }
        one.faces = {face};
        for (const SnappedTriangle& t : snapped_triangles(one, grid, true))
            segments.insert(segments.end(), {{t.a, t.b}, {t.b, t.c}, {t.c, t.a}});
    }
    return segments;
}

bool fills(const PolyhedronOp& op, DrawMode mode)
{
    return mode != DrawMode::Face && op.solid != SolidKind::None;
}

/// The parts of the faces: those cut as given are one each, of others every triangle is.
std::vector<SlabRegion> face_parts(const PolyhedronOp& op, const DrawConstants& c,
                                   const LatticeGrid& grid)
{
    std::vector<SlabRegion> parts;
    const auto add = [&](std::vector<SnappedTriangle> triangles)
    {
        parts.push_back(
            triangles_region(std::move(triangles), grid, c.triangle_weight, c.triangle_limits));
    };
    PolyhedronOp face = op;
    for (const PolyhedronFace& f : op.faces)
    {
        if (!f.is_visible) continue;
        face.faces = {f};
        const std::vector<SnappedTriangle> triangles = snapped_triangles(face, grid, true);
        if (f.triangles.empty() && f.cut.empty())
            add(triangles);
        else
            for (const SnappedTriangle& t : triangles) add({t});
    }
    return parts;
}

/// One part of a polyhedron, for setmknextauto. The inside of a <drawfigure> comes after its faces,
/// that of other shapes before them.
SlabRegion part_of(const PolyhedronOp& op, const DrawState& state, const LatticeGrid& grid)
{
    std::vector<SlabRegion> parts;
    const auto append = [&](std::vector<SlabRegion> more)
    {
        for (SlabRegion& region : more) parts.push_back(std::move(region));
    };
    const DrawConstants& c = state.constants;
    const bool is_filled = fills(op, state.mode);
    const bool fills_last = is_filled && op.solid == SolidKind::Faces;
    const auto append_inside = [&]
    { append(solid_parts(op, grid, c.triangle_weight, c.triangle_limits)); };
    if (is_filled && !fills_last) append_inside();
    if (!is_filled || state.mode != DrawMode::Solid) append(face_parts(op, c, grid));
    if (fills_last) append_inside();
    return parts.at(op.part);
}

} // namespace

void paint(Painting& painting, const Brush& brush, const PointsOp& op)
{
    if (brush.state->off_lattice)
    {
        paint_off_lattice_points(painting, brush, op.points);
        return;
    }
    // Clips keep or drop a point where it is, not its node (8 points at two planes, GenCase v5.0).
    std::vector<Vec3> kept = op.points;
    for (const ClipPlane& plane : brush.state->clips)
        std::erase_if(kept, [clip = Clip(plane)](const Vec3& p) { return !clip.keeps(p); });
    Brush unclipped = brush;
    unclipped.is_clipped = false;
    painting.canvas.paint(unclipped, points_region(kept, painting.grid()));
}

void paint(Painting& painting, const Brush& brush, const LinesOp& op)
{
    if (brush.state->off_lattice)
    {
        paint_off_lattice_lines(painting, brush, op.segments);
        return;
    }
    NodeSegments segments;
    for (const auto& [from, to] : op.segments)
        segments.emplace_back(snap(from, painting.grid()), snap(to, painting.grid()));
    paint_segments(painting, brush, segments);
}

void paint(Painting& painting, const Brush& brush, const PolyhedronOp& op)
{
    const DrawState& state = *brush.state;
    if (state.off_lattice)
    {
        paint_off_lattice_polyhedron(painting, brush, op);
        return;
    }
    if (state.mode == DrawMode::Wire)
    {
        NodeSegments segments = wire_of(op, painting.grid());
        if (op.part_count > 0) segments = {segments.at(op.part)};
        paint_segments(painting, brush, segments);
        return;
    }
    if (op.part_count > 0)
    {
        painting.canvas.paint(brush, part_of(op, state, painting.grid()));
        return;
    }
    const bool is_filled = fills(op, state.mode);
    if (state.mode == DrawMode::Full || !is_filled)
        paint_triangles(painting, brush, snapped_triangles(op, painting.grid(), true));
    if (is_filled) painting.canvas.paint(brush, solid_of(op, state, painting.grid()));
}

void paint_triangles(Painting& painting, const Brush& brush, std::vector<SnappedTriangle> triangles)
{
    painting.report.triangles += triangles.size();
    for (const SnappedTriangle& t : triangles)
        painting.report.triangles_ignored += t.a == t.b && t.b == t.c;
    const DrawConstants& c = brush.state->constants;
    painting.canvas.paint(brush, triangles_region(std::move(triangles), painting.grid(),
                                                  c.triangle_weight, c.triangle_limits));
}

SlabRegion solid_of(const PolyhedronOp& polyhedron, const DrawState& state, const LatticeGrid& grid)
{
    return solid_region(polyhedron, grid, state.constants.triangle_weight,
                        state.constants.triangle_limits);
}

} // namespace fppg
