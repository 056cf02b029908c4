#pragma once

#include "fppg/case_def.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace fppg
{

/// Which sides of a box are meant, in GenCase's order.
enum BoxSide
{
    BoxBottom,
    BoxTop,
    BoxLeft,
    BoxRight,
    BoxFront,
    BoxBack,
};

/// A box from a corner over a size that may be negative, its sides cut as rule S3 says. `sides` are
/// drawn; with `is_solid` it is filled as a prism of four corners (rule S4).
///
/// layers_dp  for every value the drawn sides move outwards by value * dp and the box with them
///            (rule S7); one polyhedron per value. Empty: the box itself
std::vector<PolyhedronOp> make_box(const Vec3& corner, const Vec3& size,
                                   const std::array<bool, 6>& sides, bool is_solid,
                                   const std::vector<double>& layers_dp, double dp);

/// A prism: the first half of the points is its bottom, the second its top. Faces: bottom, top,
/// sides; filled when the bottom is counter-clockwise seen from the top (rules S2, S10).
PolyhedronOp make_prism(const std::vector<Vec3>& points);

/// A pyramid: apex, then the base counter-clockwise seen from it. Faces: base, sides (rules S2,
/// S10).
PolyhedronOp make_pyramid(const std::vector<Vec3>& points);

/// Triangles (0, i, i + 1).
PolyhedronOp make_fan(const std::vector<Vec3>& points);
/// Triangles (i, i + 1, i + 2), every other one the other way round (its sides in wire mode are
/// drawn in this order: 6 strips under setmknextauto).
PolyhedronOp make_strip(const std::vector<Vec3>& points);
/// One polygon, cut by least perimeter.
PolyhedronOp make_polygon(const std::vector<Vec3>& points);
/// The prism between the plane y = 0 and the points of a closed polygon. Faces: the polygon in the
/// plane y = 0, the given one, sides in the order of the points (rule S9).
PolyhedronOp make_beach(const std::vector<Vec3>& points);
/// The polyline whose swept quads lie `distance` beside those of the given one, on the side of
/// direction x extrude (rule S8). Open ends lie straight beside the old ones; a corner is where the
/// shifted side that starts at it meets the plane of the shifted quad before (5 slanted polylines
/// drawn off the lattice by GenCase v5.4.354, to the last bits).
std::vector<Vec3> shifted_polyline(const std::vector<Vec3>& points, const Vec3& extrude,
                                   bool is_closed, double distance);
/// Quads that a polyline sweeps along `extrude`.
PolyhedronOp make_extrusion(const std::vector<Vec3>& points, const Vec3& extrude, bool is_closed);

/// The parts that setmknextauto tells apart: those of the inside (a box has four: two prisms and
/// the faces between them; a prism of n corners n - 2 prisms and 2 (n - 3) faces between them),
/// then triangles, and quads as one; in wire mode the sides of those triangles and quads, one by
/// one (found by experiment with GenCase v5.4.354 on boxes, prisms, pyramids, quads, strips,
/// polygons and extrusions). For a pyramid over a base that is not flat see part_between().
std::uint32_t count_parts(const PolyhedronOp& polyhedron, DrawMode mode);

/// A filled pyramid over a base that is not flat as drawn has a tetrahedron a part. The faces
/// between them do not count: they get the mk of the part behind them. Those of the last one are
/// this part, which takes no mk of its own.
std::optional<std::uint32_t> part_between(const PolyhedronOp& polyhedron, DrawMode mode);

/// What setfrdrawmode takes four corners 0, 1, 2, 3 for.
enum class QuadKind
{
    Parallelogram,   ///< within 0.05 dp
    Trapezoid,       ///< with the sides 0-1 and 3-2
    TurnedTrapezoid, ///< with the sides 1-2 and 0-3
    Other
};

/// A trapezoid is a quad whose corners of one side have the same distance to the line of the other,
/// within 0.01 dp (found by experiment with GenCase v5.4.354: limits of 0.00100 and 0.00050 at dp
/// 0.1 and 0.05 within the plane, of 0.0346 across it at a height of 0.6 and dp 0.1).
QuadKind quad_kind(const std::array<Vec3, 4>& corners, double dp);

/// Whether a quad counts as one: its last corner is not farther than 0.1 dp from the plane of the
/// others (GenCase v5.4.354: peaks of 0.05 to 0.28 dp on quads of one and two dp, two dps).
bool is_flat_quad(const std::array<Vec3, 4>& corners, double dp);

/// Hides faces of a polyhedron, numbers from 1; any number switches its filling off, also one that
/// names no face (rule S10).
void hide_faces(PolyhedronOp& polyhedron, const std::vector<int>& numbers);

/// The region of `fillprism`: strictly behind the planes through three snapped corners of each
/// face. With the corners of the bottom 0 .. n-1 and of the top n .. 2n-1 they are 0, 1, 2, then n,
/// n+2, n+1, then i, n+i+1, i+1 of every side; the corners in this order decide on nodes in a
/// plane. Found by experiment: 180 random prisms of three to five corners, level and tilted,
/// upright and slanted, 23800 nodes of GenCase v5.0, none different; v5.4 agrees on twelve of them.
PolyhedronOp prism_limits(const std::vector<Vec3>& points);

/// Cuts the faces that go by least perimeter by the corners as they stand, before a matrix moves
/// them (polygon_cut.h).
void cut_faces(PolyhedronOp& polyhedron);

/// The triangles that the bottom of a prism is cut into, as indices of its vertices, in the order
/// that its corners go around; as cut_faces() left them, else by the corners as they stand.
std::vector<std::array<std::size_t, 3>> bottom_triangles(const PolyhedronOp& prism);

/// Calls part(t) for every triangle t of the bottom of a prism, and after it side(t, i, j) for each
/// of its sides, from its corner i to j, that is one of another triangle too, the last side first.
template <typename Part, typename Side>
void for_each_part_and_side(const std::vector<std::array<std::size_t, 3>>& cut, const Part& part,
                            const Side& side)
{
    const auto has = [](const std::array<std::size_t, 3>& t, std::size_t corner)
    { return std::find(t.begin(), t.end(), corner) != t.end(); };
    for (std::size_t n = 0; n < cut.size(); ++n)
    {
        const auto& t = cut[n];
        part(n);
        for (std::size_t k = 3; k-- > 0;)
        {
            const std::size_t i = t[k];
            const std::size_t j = t[(k + 1) % 3];
            for (const auto& other : cut)
                if (&other != &t && has(other, i) && has(other, j)) side(n, i, j);
        }
    }
}

/// The triangles of one face of a polyhedron, as indices into its vertices.
std::vector<std::array<std::size_t, 3>> face_triangles(const PolyhedronOp& polyhedron,
                                                       const PolyhedronFace& face);

/// Applies a transform to all vertices.
void transform_polyhedron(PolyhedronOp& polyhedron, const Transform& transform);

/// Whether a map turns the axes into axes without mirroring, so that a box bounds a fill as it does
/// without the map.
bool keeps_boxes(const Transform& t);

/// The region of a box under a map, for fills and redraws: strictly behind the planes of its six
/// sides, each through three of its snapped corners; the corners in this order decide on nodes in
/// a plane. A map that mirrors leaves nothing, as all planes then face inwards. Found by
/// experiment: 160 boxes under random turns and scales, 64700 nodes in them and 11000 in their
/// planes by GenCase v5.0, none different; v5.4 agrees on a recorded case.
PolyhedronOp turned_box(const Vec3& corner0, const Vec3& corner1, const Transform& t);

} // namespace fppg
