#pragma once

#include "fppg/box_picture.h"
#include "fppg/combination.h"
#include "fppg/element.h"
#include "fppg/fit.h"
#include "fppg/initials.h"
#include "fppg/lattice.h"
#include "fppg/mesh_reading.h"
#include "fppg/normals.h"
#include "fppg/vec.h"
#include "fppg/vres.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

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

/// A polygon of a figure.
struct FigureFace
{
    std::vector<std::uint32_t> vertices; ///< three or more indices into FigureOp::vertices
    bool is_visible = true;              ///< false: hidden by mask or boxfill
    /// Empty: the polygon is cut into triangles (0, 1, 2), (0, 2, 3), ... (rule P5). Else these
    /// vertices are the polygon that is cut by least perimeter, and cut_offset leads from each to
    /// the one drawn (the top of a prism is cut as its bottom).
    std::vector<std::uint32_t> cut;
    std::uint32_t cut_offset = 0;
    /// Triangles that stand for the polygon whatever its shape; empty: as above.
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// How the inside of a figure is found.
enum class SolidKind : std::uint8_t
{
    None,    ///< an open surface: nothing is filled
    Prism,   ///< solid_vertices: bottom polygon, then the top one, pairs in the same order
    Box,     ///< as Prism, four corners, always cut from the second to the fourth
    Pyramid, ///< solid_vertices: apex, then the base polygon
    Faces,   ///< strictly behind all faces
};

/// Everything that is bounded by planes: triangles, quads, strips, fans, polygons, figures, boxes,
/// prisms, pyramids, extrusions. In solid and full mode the inside is filled (rules S1 to S4).
struct FigureOp
{
    std::vector<Vec3> vertices; ///< after all transforms, not snapped
    std::vector<FigureFace> faces;
    SolidKind solid = SolidKind::None;
    std::vector<std::uint32_t> solid_vertices; ///< indices into `vertices`

    /// setmknextauto draws a figure part by part, each with its own mk: the one to draw, and how
    /// many there are. Parts are, in this order, those of the inside, then the triangles or quads
    /// of the faces.
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

/// `drawfilestl`, `drawfileply`, `drawfilevtk`, `drawfilecsv`, `drawbathymetry`, and one file of
/// `drawfilevtm`
struct MeshFileOp
{
    std::string file;      ///< as written in the case; of a VTM file: beside it
    std::string container; ///< the VTM file that names it, or empty
    MeshReading reading;   ///< what the file is, and which of its shapes are drawn
    Transform transform;   ///< scale, rotation and move of the command, then the current matrix
    /// `<clipdomain>`: the surface is cut at the domain grown by so many metres on all sides.
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

/// A box, or one that a map turns or slants, as a figure.
using BoxLimits = std::variant<BoxRegion, FigureOp>;

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
    int gap_nodes = 1; ///< openings up to so many nodes wide are closed; 0: none
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
using Shape = std::variant<PointsOp, LinesOp, FigureOp, SphereOp, CylinderOp, EllipsoidOp,
                           MeshFileOp, WaveOp>;
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
};

/// The shape that a command draws if it is of this kind, else null.
template <typename Kind>
const Kind* shape_as(const DrawOp& draw)
{
    const auto* shape = std::get_if<Shape>(&draw.what);
    return shape != nullptr ? std::get_if<Kind>(shape) : nullptr;
}

/// `<constantsdef>`: what the case fixes and what it leaves to the formulas.
struct ConstantsDef
{
    int lattice_bound = 1;
    int lattice_fluid = 1;
    Vec3 gravity;
    double rhop0 = 0;
    int rhop_gradient = 2;
    double gamma = 0;
    std::optional<double> hswl;         ///< empty: automatic
    std::optional<double> speed_system; ///< empty: automatic
    double coef_sound = 0;
    std::optional<double> speed_sound; ///< empty: automatic
    std::optional<double> coef_h;      ///< one of coef_h and hdp is given
    std::optional<double> hdp;
    double cfl_number = 0;
    std::optional<double> eps;
    std::optional<double> h;
    std::optional<double> b;
    std::optional<double> mass_bound;
    std::optional<double> mass_fluid;
};

/// `<mkorientbound>`, `<mkorientfluid>`: the order of the particles of one mk (rule N2).
struct MkOrient
{
    std::uint16_t mk = 0;             ///< absolute
    std::array<int, 3> axes{0, 1, 2}; ///< slowest first
    std::array<bool, 3> descending{}; ///< per entry of `axes`
};

/// `<floating>`; empty optionals are computed from the particles.
struct FloatingDef
{
    int line = 0;
    std::vector<std::uint16_t> mkbound;
    std::optional<double> mass_body;
    std::optional<double> rhop_body; ///< relativeweight w is given as w * rhop0
    std::optional<double> mass_part;
    bool distribute_mass = false; ///< masspart = massbody / n
    std::optional<Vec3> center;
    std::optional<std::array<Vec3, 3>> inertia;
    std::vector<std::string> properties; ///< names, each once
    std::vector<Element> extra;          ///< translationDOF and the like, for Case.xml
};

/// How the particles of a fitted wall and those near it are evened out: `<relax>`.
struct RelaxSettings
{
    bool is_active = true;
    /// 1 and more; empty: on the surface until `tolerance` is met
    std::optional<int> iterations;
    /// The particles on the surface are even when the spread of their spacing (standard deviation
    /// over mean) falls by less than this in 30 iterations; above 0, up to 1.
    double tolerance = 0.001;
    double surface_h_dp = 0.8; ///< smoothing length on the surface in dp, 0.5 to 2
    /// Particles inside the solid up to this far from its surface move, in dp; 0: none; may be
    /// infinite.
    double band_dp = 3;
    /// The wall particles are written as a picture after every so many iterations; 0: never.
    int snapshots = 0;
    bool operator==(const RelaxSettings&) const = default;
};

/// How the particles of a boundary mk are placed on its true surface: `<fppg><bodyfitted>`, or
/// -fit.
struct FitSettings
{
    int line = 0;                  ///< of the element; 0: from the command line
    double feature_angle_deg = 30; ///< [0, 180)
    FitDensity density = FitDensity::Area;
    std::optional<double> clearance_dp; ///< 0.5 to 1; empty: chosen per body from its volume
    /// A plate thinner than this gets one sheet of particles instead of one on each side, dp: from
    /// half a dp down two sheets are one of twice the density to SPH.
    double one_sheet_dp = 0.5;
    RelaxSettings relax;
    bool operator==(const FitSettings&) const = default;
};

/// Which boundary mks are body-fitted.
struct FitDef
{
    std::optional<FitSettings> all; ///< for every boundary mk that has none of its own
    std::vector<std::pair<std::uint16_t, FitSettings>> of_mk; ///< absolute mk; the last one counts
    bool is_empty() const { return !all && of_mk.empty(); }
};

/// Fluid near fitted walls that is relaxed with them: `<fppg><fluidband>`.
struct FluidBand
{
    int line = 0;                  ///< of the element
    std::vector<std::uint16_t> mk; ///< absolute, ascending; empty: every fluid
    double width_dp = 3; ///< fluid this near to a fitted wall moves, in dp; above 0, finite
};

/// `<fppg><floatings exact="true">`: floating bodies whose mass, centre and inertia are those of
/// their true shape instead of those of their particles.
struct ExactFloatings
{
    bool all = false;
    std::vector<std::uint16_t> mk; ///< absolute
    int line = 0;                  ///< of the element; 0: there is none
};

/// A file that the case names and the solver reads: of a motion, of properties, of mesh data.
struct DataFileUse
{
    std::string name; ///< as the definition writes it
    int line = 0;
};

/// `<fppg><points>`: particles exactly at the places that a file gives.
struct PointFile
{
    SourceRef source;
    MkValue mk;
    std::string file; ///< as written in the case
    Transform transform;
};

/// Parts of the case that are drawn as one: `<fppg><boolean>`.
struct BooleanDef
{
    /// A draw that is one of the parts.
    struct Part
    {
        std::size_t op = 0;    ///< index into CaseDef::ops
        bool is_sheet = false; ///< it may be a surface without an inside
    };
    int line = 0;
    std::string name; ///< empty without
    BooleanNode tree; ///< of the parts
    std::vector<Part> parts;
    std::optional<std::uint16_t> mk; ///< absolute; empty: each particle has the mk of its part
    bool is_drawn = true;            ///< false: only a name for others
};

/// A user variable, for `<uservars>`.
struct UserVariable
{
    std::string name;
    bool is_text = false;
    double number = 0;
    std::string text;
};

class MeshLibrary;

/// A case definition, read and executed. Nothing after it knows XML.
struct CaseDef
{
    std::string file;      ///< of the definition, as the user named it
    std::string case_name; ///< of the output, without folder

    ConstantsDef constants;
    LatticeGrid grid;  ///< after -dp and pointref
    Vec3 case_pos_min; ///< limits of the domain as printed: grid.origin, pointmax
    Vec3 case_pos_max;
    double h = 0;          ///< smoothing length, given or by its formula
    double mass_bound = 0; ///< of a boundary particle, given or rhop0 * dp^dim
    double mass_fluid = 0;
    int mkbound_count = 0;
    int mkfluid_count = 0;
    std::uint16_t mk_bound_first = 0; ///< mk = mkbound + mk_bound_first
    std::uint16_t mk_fluid_first = 1;
    std::vector<MkOrient> mk_orients;

    std::vector<DrawOp> ops; ///< in order of execution
    std::vector<BoxPicture> box_pictures;
    std::shared_ptr<MeshLibrary> meshes; ///< that reading needed; null: none is read yet
    std::vector<std::string> list_log; ///< what GenCase prints while it draws: "> MAIN" and printf

    FitDef fit;                         ///< empty: every particle stands on the lattice
    std::vector<FluidBand> fluid_bands; ///< of a fluid that several name the last one counts
    std::vector<PointFile> point_files; ///< in the order of the file
    /// `<fppg><offlattice hydrostatic="true" />`: fluid of `<setfrdrawmode>` has the density of its
    /// depth, where GenCase v5.4 gives it rhop0.
    bool hydrostatic_off_lattice = false;
    /// Drawn in place of their parts, where the last of these stands.
    std::vector<BooleanDef> booleans;
    std::vector<InitialOp> initials; ///< in the order of the file
    NormalsDef normals;
    std::vector<FloatingDef> floatings;
    ExactFloatings exact_floatings;
    std::vector<DataFileUse> data_files; ///< each once; GenCase copies them beside the result
    std::vector<std::pair<std::uint16_t, std::string>> property_links; ///< absolute mk, one name
    Element properties;             ///< `<properties>` of the definition, or empty name
    Element motion;                 ///< `<motion>` with numbers evaluated; objreal refs are mkbound
    std::vector<Element> execution; ///< children of `<execution>` that Case.xml takes over
    Element casedef;                ///< `<casedef>` as read, for the copy in Case.xml
    Element document;               ///< the definition as read: children are the root, comments

    std::vector<UserVariable> user_variables; ///< in printing order
    std::string variables_log; ///< "List of available variables: ..." at the end of reading
    std::vector<std::string> warnings;

    VresDef vres;         ///< no zones: one resolution
    std::size_t zone = 0; ///< which of them this case is
    /// Of zone 0, where this is another one: GenCase takes its depth and, for rhopgradient 3, its
    /// surface.
    std::optional<double> main_hswl;
    std::optional<double> main_surface;
    Box3 particles_around; ///< limits of the particles of the zone around this one
};

/// -fit: which walls are body-fitted.
enum class FitChoice : std::uint8_t
{
    AsCase, ///< those that the case's `<fppg>` block names
    On,     ///< every boundary mk; those that the block names with their settings
    Raw,    ///< as On, without relaxation of walls or fluid
    Off,    ///< none; the block is not even read
};

/// Overrides of the command line.
struct CaseOptions
{
    FitChoice fit = FitChoice::AsCase;
    std::optional<double> dp;                               ///< -dp:
    std::vector<std::pair<std::string, std::string>> evars; ///< -evars:
    std::string case_name;                                  ///< of the output
    /// The zones as zone 0 gave them, to read the case as zone `zone`; null: zone 0.
    const VresDef* vres = nullptr;
    std::size_t zone = 0;
    std::shared_ptr<MeshLibrary> meshes; ///< of a case read before from this file; may be null
};

/// The name of a zone's case: NAME_vres00 and so on.
std::string zone_name(const std::string& case_name, std::size_t zone);

/// The settings of a boundary mk; null: its particles stand on the lattice.
const FitSettings* fit_settings(const FitDef& fit, std::uint16_t mk);

/// Reads and executes `<path>`.
///
/// path     the file, with its extension
/// options  what the command line overrides
/// throws   IoError if it cannot be read; CaseError with file, line and element if it is wrong, if
///          it uses a command that is known but not built ("not supported yet"), or if `abort` runs
CaseDef read_case(const std::string& path, const CaseOptions& options);

/// The definition as a tree, not executed; what -clean prints. Its children are the root and what
/// stands around it.
///
/// throws IoError, CaseError as read_case does for a file that is no XML
Element read_definition_tree(const std::string& path);

} // namespace fppg
