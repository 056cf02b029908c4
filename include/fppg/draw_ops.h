#pragma once

#include "fppg/mesh_reading.h"
#include "fppg/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// What the commands of a case say: shapes that are drawn, edits of nodes, outputs.
namespace fppg
{

/// What a node, a draw or a filter is about. Void: nothing comes out.
enum class MkKind : std::uint8_t
{
    Void,
    Bound,
    Fluid,
};

/// The mk that a draw paints with.
struct MkValue
{
    MkKind kind = MkKind::Void;
    std::uint16_t mk = 0;      ///< absolute; 0 for void
    std::uint16_t mk_type = 0; ///< mkbound or mkfluid
    bool operator==(const MkValue&) const = default;
};

/// `setdrawmode`; solid is GenCase's default (semantics: section 2).
enum class DrawMode : std::uint8_t
{
    Wire,
    Face,
    Solid,
    Full,
};

/// `setdpctes`: how near to a primitive a node must lie to be taken, in dp (rule P7), and the
/// facets of round shapes in shape files.
struct DrawConstants
{
    double line = 0.6;
    double triangle_weight = 0.6; ///< distance from the triangle's plane
    double triangle_limits = 0.6; ///< distance beyond its edges, in the plane
    double sphere = 0.6;
    double ellipsoid = 0.6;
    double cylinder_tube = 0.6;
    double cylinder_cover = 0.6;
    int sphere_sides = 24;
    int cylinder_sides = 24;
    bool operator==(const DrawConstants&) const = default;
};

/// Keeps the nodes x with (x - point) . normal <= 0 (rule C1).
struct ClipPlane
{
    Vec3 point;
    Vec3 normal;
    bool operator==(const ClipPlane&) const = default;
};

/// A `<pattern>`: which nodes a draw with `setpattern` paints. Rules found by experiment with
/// GenCase v5.4.354 (48 random patterns, none different):
/// - it is anchored to node (0, 0, 0) of the lattice. Per axis q = (n - gap) mod (size * scale +
///   border), c = floor(q / scale); c >= size is border and counts as '-'. The cell is c_x + size_x
///   * (c_y + size_y * c_z)
/// - nodes of 'X' take the mk of the draw, all others that it would paint the one of setmkback*, or
///   stay as they are without one, void in fills. redrawnear and redrawnearbox do not heed it;
///   fills, which spread as without a pattern, redraw and redrawbox do
struct DrawPattern
{
    std::array<std::uint32_t, 3> size{1, 1, 1};   ///< cells along x, y, z; 1 and more
    std::array<std::uint32_t, 3> scale{1, 1, 1};  ///< nodes of a cell; 1 and more
    std::array<std::uint32_t, 3> border{0, 0, 0}; ///< nodes behind the cells
    std::array<std::uint32_t, 3> gap{0, 0, 0};    ///< below size * scale + border
    std::vector<char> cells;                      ///< 1 for 'X', 0 for '-'; x fastest, z slowest
};

/// `setshapemode`: in which forms shapes are kept for `shapeout`, and those of which mks.
struct ShapeMode
{
    bool actual = true;                            ///< as drawn
    bool snapped = false;                          ///< with vertices on the lattice
    std::array<bool, 3> kinds{false, true, false}; ///< void, bound, fluid
    bool operator==(const ShapeMode&) const = default;
};

/// Everything that a draw inherits from the commands before it.
struct DrawState
{
    MkValue mk;
    DrawMode mode = DrawMode::Solid;
    DrawConstants constants;
    std::vector<ClipPlane> clips;
    std::shared_ptr<const DrawPattern> pattern; ///< setpattern; null: every node is painted
    std::optional<MkValue> mk_back; ///< setmkback*: of the nodes that a pattern leaves out
    bool box_limit_full = false;    ///< setboxlimitmode full
    bool off_lattice = false;       ///< setfrdrawmode: particles at their true places
    bool draw_points = true;        ///< setactive drawpoints
    bool draw_shapes = true;        ///< setactive drawshapes
    ShapeMode shape_mode;           ///< setshapemode
    bool normal_invert = false;     ///< setnormalinvert
    bool mk_next_auto = false;      ///< setmknextauto: every part drawn takes the next mk
    Transform matrix;               ///< the current matrix where off_lattice, else none
    bool operator==(const DrawState&) const = default;
};

/// Where a draw stands in the definition, for messages.
struct SourceRef
{
    int line = 0;
    std::string command;
    std::string name{}; ///< fppg:name of the draw; empty without
};

/// `drawpoint`, `drawpoints`: nodes nearest to the points.
struct PointsOp
{
    std::vector<Vec3> points;
};

/// `drawline`, `drawlines`, `drawlineto`: segments, each (from, to).
struct LinesOp
{
    std::vector<std::pair<Vec3, Vec3>> segments;
};

/// A polygon of a polyhedron.
struct PolyhedronFace
{
    std::vector<std::uint32_t> vertices; ///< three or more indices into PolyhedronOp::vertices
    bool is_visible = true;              ///< false: hidden by mask or boxfill
    /// Empty: the polygon is cut into triangles (0, 1, 2), (0, 2, 3), ... (rule P5). Else these
    /// vertices are the polygon that is cut by least perimeter, and cut_offset leads from each to
    /// the one drawn (the top of a prism is cut as its bottom).
    std::vector<std::uint32_t> cut;
    std::uint32_t cut_offset = 0;
    /// Triangles that stand for the polygon whatever its shape; empty: as above.
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// How the inside of a polyhedron is found.
enum class SolidKind : std::uint8_t
{
    None,    ///< an open surface: nothing is filled
    Prism,   ///< solid_vertices: bottom polygon, then the top one, pairs in the same order
    Box,     ///< as Prism, four corners, always cut from the second to the fourth
    Pyramid, ///< solid_vertices: apex, then the base polygon
    Faces,   ///< strictly behind all faces
};

/// Everything that is bounded by planes: triangles, quads, strips, fans, polygons, polyhedra,
/// boxes, prisms, pyramids, extrusions. In solid and full mode the inside is filled (rules S1 to
/// S4).
struct PolyhedronOp
{
    std::vector<Vec3> vertices; ///< after all transforms, not snapped
    std::vector<PolyhedronFace> faces;
    SolidKind solid = SolidKind::None;
    std::vector<std::uint32_t> solid_vertices; ///< indices into `vertices`

    /// setmknextauto draws a polyhedron part by part, each with its own mk: the one to draw, and
    /// how many there are. Parts are, in this order, those of the inside, then the triangles or
    /// quads of the faces.
    std::uint32_t part = 0;
    std::uint32_t part_count = 0; ///< 0: all at once
};

/// `drawsphere`
struct SphereOp
{
    Vec3 center;
    double radius = 0;
    std::vector<double> layers_dp;         ///< shells at radius + layer * dp instead of the sphere
    std::vector<double> shown_layers_dp{}; ///< those of them that shape files show
    /// The boxes around the sphere or its layers as the matrix leaves them. Radii are not scaled,
    /// but nodes lie in the box of the snapped corners and one node around it (GenCase v5.0: 300
    /// spheres of random scales; otherwise it counts where ctesphere is above 1).
    std::vector<Box3> limits{};
    /// Of a sphere that is far larger than the domain the facets away from here grow with the
    /// distance; empty: all are alike.
    Box3 near{};
};

/// One of `layers vdp`: the faces of this cylinder are drawn.
struct CylinderLayer
{
    Vec3 p0;
    Vec3 p1;
    double radius = 0;
    bool is_shown = true; ///< in shape files
};

/// `drawcylinder`; faces: cover at the first point, cover at the second, tube
struct CylinderOp
{
    Vec3 p0;
    Vec3 p1;
    double radius = 0;
    std::array<bool, 3> is_visible{true, true, true};
    std::vector<CylinderLayer> layers; ///< instead of the cylinder
    /// Any mask but 0 leaves the inside empty and draws faces in every mode, also where it hides
    /// none (mask_beyond_faces).
    bool is_masked = false;
};

/// `drawellipsoid`: nodes by the sum of their distances to two foci; `radius` is that sum (R3).
struct EllipsoidOp
{
    Vec3 focus0;
    Vec3 focus1;
    double radius = 0;
};

/// A closed solid that answers for itself (shapes/solid_shape.h).
class SolidShape;

/// `drawtorus`
struct SolidOp
{
    std::shared_ptr<const SolidShape> shape; ///< not null
};

/// `drawfilestl` and the like of all mesh formats, `drawbathymetry`, and one file of `drawfilevtm`
struct MeshFileOp
{
    std::string file;      ///< as written in the case; of a VTM file: beside it
    std::string container; ///< the VTM file that names it, or empty
    MeshReading reading;   ///< what the file is, and which of its shapes are drawn
    Transform transform;   ///< scale, rotation and move of the command, then the current matrix
    /// `<clipdomain>`: the surface is cut at the domain grown by this many metres on all sides.
    std::optional<double> clip_resize;
    bool autofill = false;
    bool advanced =
        false; ///< nodes by their depth below the surface instead of its shell (rule X3)
    bool reverse = false;
    bool any_depth = false;    ///< advanced together with autofill and without limits of the depth
    double depth_min = 0;      ///< metres
    double depth_max = 0;      ///< metres; may be infinite
    bool fill_inside = false;  ///< fppg:fill="inside": the true inside instead of autofill's flood
    bool saves_points = false; ///< `<savepoints>` of drawbathymetry: a picture of its grid's nodes
    bool saves_grid = false;   ///< `<savegrid>`: one of its cells
    /// advanced, on the lattice: the files of the same VTM file and mk that are one mesh with this
    /// one; their own draws have is_drawn_before.
    std::vector<std::string> joined;
    bool is_drawn_before = false;
};

/// `drawwave`: the water below a solitary wave, from the bottom of a box up to
/// z0 + depth + h_max / cosh^2(sqrt(3 h_max / (4 depth^3)) (x - x0)) and not beyond the box.
struct WaveOp
{
    Vec3 corner;      ///< lowest corner of the box, before snapping
    Vec3 size;        ///< of the box, not negative, as drawn
    Transform matrix; ///< moves the corner's node and the size behind it to the far corner
    double depth = 0; ///< metres, above 0
    double h_max = 0; ///< height of the crest above still water, metres
    double x0 = 0;    ///< of the crest
    double z0 = 0;    ///< of the bed
};

/// Which nodes a fill may enter (rules F2, F3). `enters[k]` is for kind k; a number narrows it.
struct FillFilter
{
    std::array<bool, 3> names{false, false, false}; ///< void, bound, fluid named in modefill
    bool border = false;                            ///< the named ones are the limits instead
    std::optional<std::uint16_t> mkbound;           ///< absolute mk
    std::optional<std::uint16_t> mkfluid;           ///< absolute mk
};

/// A box by two opposite corners, before snapping.
struct BoxRegion
{
    Vec3 corner0;
    Vec3 corner1;
};

/// A box, or one that a map turns or slants, as a polyhedron.
using BoxLimits = std::variant<BoxRegion, PolyhedronOp>;

/// `fillpoint`, `fillvoidpoint`, `fillbox`, `fillfigure`, `fillprism`: a 6-connected flood.
struct FillOp
{
    Vec3 seed;
    FillFilter filter;
    std::optional<BoxLimits> region; ///< empty: the whole lattice
};

/// A filter by type, and by number where one is given.
struct MkFilter
{
    MkKind kind = MkKind::Void;
    std::optional<std::uint16_t> mk; ///< absolute
};

/// `redraw`, `redrawbox`: recolours what exists (rules D1, D2).
struct RedrawOp
{
    std::vector<MkFilter> filters;   ///< empty: every node
    std::optional<BoxLimits> region; ///< strict interior of the snapped box
};

/// `redrawnear`, `redrawnearbox` (rules D3 to D5).
struct RedrawNearOp
{
    MkFilter target;
    MkFilter border;
    int times = 1;
    /// top, bottom, right, left, back, front, seen from the border node; none set: all 26
    /// neighbours
    std::array<bool, 6> directions{};
    std::optional<BoxLimits> region;
};

/// `resetdraw`: forgets what was drawn.
struct ResetOp
{
};

enum class ShapeFormat : std::uint8_t
{
    Vtk,
    Vtp,
    Vtu,
    Stl,
};

/// `shapeout`: writes the shapes kept since the last one in every form that its state names; a form
/// that it does not name keeps its shapes.
struct ShapeOutOp
{
    std::string file; ///< may be empty
    ShapeFormat format = ShapeFormat::Vtk;
    /// savenormal: length in dp of the lines that a second file shows the normals by; 0: none.
    double normal_dp = 0;
    bool reset = true;
};

/// How much of a cavity a fill takes.
enum class FillMeasure : std::uint8_t
{
    Level,   ///< metres along `up`: nodes at or below it
    Litres,  ///< one node holds 1000 dp^3 of them, in 2D 1000 dp^2 (a metre of width)
    Percent, ///< of the nodes of the cavity
};

/// `<fppg><fill>`: the empty nodes around a seed that drawn nodes enclose, up to a level. Runs
/// after all commands. Litres and percent take whole layers, from the lowest one up, so many that
/// their nodes are as nearly as possible the number wanted.
struct CavityFillOp
{
    Vec3 seed;
    Vec3 up{0, 0, 1}; ///< of length 1; in 2D with a part in the plane
    FillMeasure measure = FillMeasure::Percent;
    double amount = 100;
    int gap_nodes = 1; ///< openings up to this many nodes wide are closed; 0: none
};

/// `cellsout`: writes the cells of the nodes as they are now.
struct CellsOutOp
{
    std::string file;                ///< may be empty
    std::optional<std::uint16_t> mk; ///< absolute; empty: all
    std::string suffix;              ///< of the file name: "_mkbound5", "_mkfluid5" or nothing
};

/// `pointsmkout`: writes the nodes of the current mk that have a face neighbour of another one.
struct PointsMkOutOp
{
    std::string file; ///< may be empty
};

/// What a draw puts into the domain.
using Shape = std::variant<PointsOp, LinesOp, PolyhedronOp, SphereOp, CylinderOp, EllipsoidOp,
                           SolidOp, MeshFileOp, WaveOp>;
/// What changes nodes that are there.
using Edit = std::variant<FillOp, CavityFillOp, RedrawOp, RedrawNearOp>;
/// Whether an edit gives nodes another mk where they are.
inline bool is_redraw(const Edit& edit)
{
    return std::holds_alternative<RedrawOp>(edit) || std::holds_alternative<RedrawNearOp>(edit);
}
/// What is written about the nodes and shapes as they are then.
using Output = std::variant<ShapeOutOp, CellsOutOp, PointsMkOutOp>;

using Command = std::variant<Shape, Edit, Output, ResetOp>;

/// One executed command.
struct DrawOp
{
    SourceRef source;
    /// Shared by the commands between two state changes.
    std::shared_ptr<const DrawState> state;
    Command what;
    std::size_t call = 0; ///< number of the command that was run; its layers and parts share it
    /// Of shells drawn by `layers vdp`: the shape itself, which those of a command share; else
    /// null.
    std::shared_ptr<const Shape> surface{};
    /// The innermost of shells that thicken a box, a sphere or a cylinder inwards; else null.
    std::shared_ptr<const Shape> inner_surface{};
    std::size_t shells = 0; ///< of `layers vdp`, instead of which the shape itself is drawn
};

/// The shape that a command draws if it is of this kind, else null.
template <typename Kind>
const Kind* shape_as(const DrawOp& draw)
{
    const auto* shape = std::get_if<Shape>(&draw.what);
    return shape != nullptr ? std::get_if<Kind>(shape) : nullptr;
}

} // namespace fppg
