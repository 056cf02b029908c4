#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"

#include "nodes/spans.h"
#include "shapes/shape.h"

#include <optional>
#include <string>
#include <vector>

/// What each kind of shape answers, a file a kind. A kind leaves out what it cannot answer: without
/// surfaces_of() no particles stand on it, without add_cells() it is in no shape file, without
/// nodes_of() the lattice stage paints it in a way of its own.
///
/// bounds_of    the box around it; of files and waves empty
/// is_body      whether it is drawn as something that has a thickness
/// surfaces_of  its true surfaces
/// nodes_of     the nodes that GenCase draws
/// add_cells    its lines and faces in shape files
/// body_of      the exact integrals over what it bounds; else why_not says why there are none
namespace fppg::kinds
{

/// The lines and faces of a shape as shape files show them. setnormalinvert turns faces over.
struct CellList
{
    void add_line(const Vec3& from, const Vec3& to) { cells.push_back({from, to}); }
    void add_face(ShapeCell corners);
    /// Turned over, a face of a sphere or cylinder keeps its first corner.
    void add_round_face(ShapeCell corners);
    /// A triangle or quad of a polyhedron or mesh: in wire mode its sides; a triangle that snapping
    /// leaves with two places is a line, with one it goes.
    void add_flat_face(ShapeCell corners);

    const ShapeContext& context;
    std::vector<ShapeCell> cells{};
};

// points.cpp
Box3 bounds_of(const PointsOp& points, double dp);
Box3 bounds_of(const LinesOp& lines, double dp);
void add_cells(const LinesOp& lines, CellList& out);

// polyhedron.cpp
Box3 bounds_of(const PolyhedronOp& polyhedron, double dp);
bool is_body(const PolyhedronOp& polyhedron, DrawMode mode);
std::vector<ShapeMesh> surfaces_of(const PolyhedronOp& polyhedron, const ShapeContext& context);
void add_cells(const PolyhedronOp& polyhedron, CellList& out);
std::optional<ExactBody> body_of(const PolyhedronOp& polyhedron, const ShapeContext& context,
                                 std::string& why_not);

// sphere.cpp
Box3 bounds_of(const SphereOp& sphere, double dp);
bool is_body(const SphereOp& sphere, DrawMode mode);
std::vector<ShapeMesh> surfaces_of(const SphereOp& sphere, const ShapeContext& context);
/// Tested one by one, not faceted (rule R1): with C the real place of the snapped centre, r =
/// floor(R / dp + 0.5) * dp and d = |C - x|: face |d - r| < width, solid d <= R, full either.
/// `layers_dp` draws faces of radius R + layer * dp instead (rule R4). The arithmetic is GenCase's
/// (v5.4.354: 9 sets of 216 spheres, most with nodes exactly at a limit, none different).
SlabRegion nodes_of(const SphereOp& sphere, const DrawState& state, const LatticeGrid& grid);
void add_cells(const SphereOp& sphere, CellList& out);
std::optional<ExactBody> body_of(const SphereOp& sphere, const ShapeContext& context,
                                 std::string& why_not);

// cylinder.cpp
Box3 bounds_of(const CylinderOp& cylinder, double dp);
bool is_body(const CylinderOp& cylinder, DrawMode mode);
std::vector<ShapeMesh> surfaces_of(const CylinderOp& cylinder, const ShapeContext& context);
/// Rule R2: A, B real places of the snapped ends, V = B - A, va = V . x - V . A, vb = V . x - V .
/// B, d the distance from the axis, r = floor(R / dp + 0.5) * dp: tube |d - r| < width with va >= 0
/// >= vb; covers |va| / |V| < width or |vb| / |V| < width, and d <= R; interior d <= R with va >= 0
/// >= vb. The arithmetic is GenCase's (v5.4.354: 27 sets of 216 oblique cylinders and ties, none
/// different).
SlabRegion nodes_of(const CylinderOp& cylinder, const DrawState& state, const LatticeGrid& grid);
void add_cells(const CylinderOp& cylinder, CellList& out);
std::optional<ExactBody> body_of(const CylinderOp& cylinder, const ShapeContext& context,
                                 std::string& why_not);

// ellipsoid.cpp
Box3 bounds_of(const EllipsoidOp& ellipsoid, double dp);
bool is_body(const EllipsoidOp& ellipsoid, DrawMode mode);
std::vector<ShapeMesh> surfaces_of(const EllipsoidOp& ellipsoid, const ShapeContext& context);
/// An ellipsoid of revolution by the sum s of the distances to its snapped foci (rule R3): face
/// |s - S0| < width with S0 = floor(R / dp + 0.5), full s < S0 + width, solid s <= R / dp. The
/// width is that of spheres, ctesphere; GenCase reads cteellipsoid and uses it nowhere.
SlabRegion nodes_of(const EllipsoidOp& ellipsoid, const DrawState& state, const LatticeGrid& grid);
std::optional<ExactBody> body_of(const EllipsoidOp& ellipsoid, const ShapeContext& context,
                                 std::string& why_not);

// solid_shape.cpp: what the solid itself answers.
Box3 bounds_of(const SolidOp& solid, double dp);
bool is_body(const SolidOp& solid, DrawMode mode);
std::vector<ShapeMesh> surfaces_of(const SolidOp& solid, const ShapeContext& context);
SlabRegion nodes_of(const SolidOp& solid, const DrawState& state, const LatticeGrid& grid);
void add_cells(const SolidOp& solid, CellList& out);
std::optional<ExactBody> body_of(const SolidOp& solid, const ShapeContext& context,
                                 std::string& why_not);

// wave.cpp
Box3 bounds_of(const WaveOp& wave, double dp);
/// A solitary wave: the nodes of the snapped box, its limits included, that lie strictly below the
/// surface at their x, in every draw mode (rule R6, found by experiment with GenCase v5.4.354).
/// Crest and bed are moved, turned and scaled as points; depth and height stay. So is the corner,
/// but the far corner twice: its size counts from the corner's node, and the matrix acts on that
/// sum again, so that a move makes the box larger. A box with a negative size afterwards has no
/// nodes (60 boxes under one to three moves, turns and scales in v5.4.354 and 400 in v5.0; sizes of
/// whole and a half dp: 40 in v5.0).
SlabRegion nodes_of(const WaveOp& wave, const DrawState& state, const LatticeGrid& grid);

// mesh_shape.cpp
Box3 bounds_of(const MeshFileOp& file, double dp);
bool is_body(const MeshFileOp& file, DrawMode mode);
std::vector<ShapeMesh> surfaces_of(const MeshFileOp& file, const ShapeContext& context);
/// Quads stay whole, those of a bathymetry only if they are flat; a polyline begins with a line of
/// no length.
void add_cells(const MeshFileOp& file, CellList& out);
std::optional<ExactBody> body_of(const MeshFileOp& file, const ShapeContext& context,
                                 std::string& why_not);

// Helpers of several kinds.

/// Exchanges the sides of all facets.
void flip(TriangleSoup& soup);
/// The body of a closed surface; else why_not says why there is none.
std::optional<ExactBody> body_of_closed(const TriangleSoup& soup, std::string& why_not);
/// The box around a ball, stretched: half sizes along the axes.
void add_ball(Box3& box, const Vec3& center, const Vec3& half);

} // namespace fppg::kinds
