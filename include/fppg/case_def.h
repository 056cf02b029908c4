#pragma once

#include "fppg/combination.h"
#include "fppg/debug_box.h"
#include "fppg/draw_ops.h"
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
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fppg
{

/// `<constantsdef>`: what the case fixes and what it leaves to the formulas.
struct ConstantsDef
{
    int lattice_bound = 1;
    int lattice_fluid = 1;
    Vec3 gravity;
    Vec3 driving; ///< part of gravity that drives fluid through a channel, where walls are fitted
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

    /// What walls and a free surface hold at rest.
    Vec3 rest_gravity() const { return gravity - driving; }
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
    /// The particles on the surface are even when the coefficient of variation of their spacing
    /// falls by less than this in 3 iterations (few particles: 12); above 0, up to 1.
    double tolerance = 0.001;
    double surface_h_dp = 0.8; ///< smoothing length on the surface in dp, 0.5 to 2
    /// Particles inside the solid up to this far from its surface move, in dp; 0: none; may be
    /// infinite.
    double band_dp = 3;
    /// Iterations between two pictures of the wall particles; 0: none.
    int snapshots = 0;
    bool operator==(const RelaxSettings&) const = default;
};

/// The boundary condition that the particles of a wall are placed for.
enum class WallBoundary : std::uint8_t
{
    Dbc,  ///< dynamic: on the surface, and under it where layers are asked for
    Mdbc, ///< modified dynamic: half a step behind the surface, and deeper
};

/// On which side of an open sheet its layers stand.
enum class LayerSide : std::uint8_t
{
    Behind, ///< where its facets do not look
    Front,
    Both,
};

/// How the particles of a boundary mk are placed on its true surface: `<fppg><bodyfitted>`, or
/// -fit.
/// Where the particles of a fitted body stand.
enum class Placement : std::uint8_t
{
    Surface, ///< the first on its surface, or in layers behind it
    Inside,  ///< all inside, the outermost half a dp behind its surface; each stands for dp^3
};

struct FitSettings
{
    int line = 0;                  ///< of the element; 0: from the command line
    double feature_angle_deg = 30; ///< [0, 180)
    double cad_angle_deg = 1;      ///< the same of edges of CAD models, between their exact faces
    FitDensity density = FitDensity::Area;
    std::optional<double> clearance_dp; ///< 0.5 to 1; empty: chosen per body from its volume
    /// A plate thinner than this gets one sheet of particles instead of one on each side, dp: no
    /// two particles of a wall are nearer (least_pair_dp).
    double one_sheet_dp = 0.6;
    bool gives_sheets = false; ///< the case says how many sheets plates have
    RelaxSettings relax;
    std::optional<WallBoundary> boundary; ///< empty until the case's parameters are known
    /// How many layers: at (k + 1/2) dp behind the surface for Mdbc, at k dp for Dbc. Empty: for
    /// Mdbc as many as fill the kernel of fluid at the wall, for Dbc those within 0.92 of it, at
    /// least two, for sheets with fluid on one side, else none but the surface.
    std::optional<int> layers;
    /// Of sheets; empty: away from the fluid, and behind where there is none.
    std::optional<LayerSide> side;
    bool thickens = false; ///< plates with room for one layer of mDBC; set where walls are fitted
    bool has_fluid_behind = false; ///< layers of a sheet would stand in fluid; set there too
    /// Depths of the layers in dp, ascending, once the boundary condition is known; empty: only the
    /// surface has particles.
    std::vector<double> depths_dp;
    /// The same of sheets for Dbc with fluid on one side that stand still or move slowly
    /// (walls/fast_walls.h), where `layers` is empty.
    std::vector<double> sheet_depths_dp;
    /// Empty: Inside for solids that float, with dynamic boundaries (settle_boundaries()), else
    /// Surface.
    std::optional<Placement> place;
    /// Inside without being asked for: shapes without room inside have their particles on the
    /// surface instead.
    bool may_be_open = false;
    /// Of bodies with Placement::Inside: how many sheets of particles through their thickness;
    /// empty: as many as it is dp, rounded.
    std::optional<int> across;
    bool has_exact_volumes = false; ///< each particle has its own volume (CaseParticles::volumes)
    std::vector<Vec3> fluid_places; ///< where fluid is drawn, by which sides of sheets are chosen
    bool operator==(const FitSettings&) const = default;
};

/// Which boundary mks are body-fitted.
struct FitDef
{
    std::optional<FitSettings> all;             ///< for every boundary mk that has none of its own
    std::map<std::uint16_t, FitSettings> of_mk; ///< by absolute mk
    bool is_empty() const { return !all && of_mk.empty(); }
};

/// Fluid near fitted walls that is relaxed with them: `<fppg><fluidband>`.
struct FluidBand
{
    int line = 0;                  ///< of the element
    std::vector<std::uint16_t> mk; ///< absolute, ascending; empty: every fluid
    double width_dp = 3;   ///< fluid this near to a fitted wall moves, in dp; above 0, finite
    bool is_active = true; ///< false: it stays on the lattice
    bool balances = true;  ///< it is brought to rest (balance.h)
    /// `packing="stable"`: still water all of which is brought to rest leaves its lattice for one
    /// that is more stable, where there is one.
    bool packs = true;
    /// `mass="exact"`: all fluid particles together have the mass of the space between walls.
    bool has_exact_mass = false;
};

/// Nearer to points of a zone where fluid goes in and out, and to the rows behind them, the solver
/// refuses boundary particles and takes other fluid out, dp (v5.4, JSphInOut::InitCheckProximity).
inline constexpr double off_inlets_dp = 0.7;

/// Particles of fluid that are the points of a zone where fluid goes in and out.
struct InletParticles
{
    Vec3 way;       ///< unit, in which fluid comes in; zero where that is not known
    int layers = 1; ///< rows that the solver sets behind them and on them, dp apart
    int line = 0;
};

/// A zone where fluid goes in and out that is given by its shape.
struct InletShape
{
    Box3 box; ///< about it
    Vec3 way; ///< as of InletParticles
    int layers = 1;
    int line = 0;
    std::vector<Vec3> points; ///< that the solver sets; empty where that is not known
};

/// Where the solver lets fluid in and out: the zones of `<special><inout>`.
struct InOutZones
{
    std::map<std::uint16_t, InletParticles> fluids; ///< by absolute mk
    std::vector<InletShape> shapes;

    bool is_empty() const { return fluids.empty() && shapes.empty(); }
};

/// What the solver is told on which places and densities depend.
struct SolverParameters
{
    int boundary = 1;            ///< 1: DBC, 2: mDBC
    int slip_mode = 1;           ///< of mDBC
    bool no_penetration = false; ///< of mDBC with slip_mode 2 or 3
    int kernel = 2;              ///< 1: cubic spline, 2: Wendland
    InOutZones inout;
    std::set<std::uint16_t> flexible; ///< absolute mks, each of whose particles counts for dp^3
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
        std::size_t op = 0;      ///< index into CaseDef::ops
        bool is_sheet = false;   ///< it may be a surface without an inside
        bool is_surface = false; ///< it has none, though it may be closed
        double least_depth = 0;  ///< metres; as BooleanPart::least_depth
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
    /// mass_fluid over rhop0 times the volume that a particle has: above 1 where fluid that walls
    /// hold off has the mass of all of their cavity, `<fluidband mass="exact">`.
    double fluid_fullness = 1;
    int mkbound_count = 0;
    int mkfluid_count = 0;
    std::uint16_t mk_bound_first = 0; ///< mk = mkbound + mk_bound_first
    std::uint16_t mk_fluid_first = 1;
    std::vector<MkOrient> mk_orients;

    std::vector<DrawOp> ops; ///< in order of execution
    std::vector<DebugBox> debug_boxes;
    std::shared_ptr<MeshLibrary> meshes; ///< that reading needed; null: none is read yet
    std::vector<std::string> list_log; ///< what GenCase prints while it draws: "> MAIN" and printf

    FitDef fit;                         ///< empty: every particle stands on the lattice
    std::vector<FluidBand> fluid_bands; ///< of a fluid that several name the last one counts
    SolverParameters solver;            ///< of a case with fitted walls
    /// Whether fluid starts balanced beside fitted walls (balance.h), with the densities of its
    /// depth below a surface half a dp above its highest particles: gravity and depths give it
    /// pressure, and a band of fluid asks for it.
    bool balances() const;
    /// Whether a `<fill>` gives a fluid its litres.
    bool fills_litres() const;
    std::vector<PointFile> point_files; ///< in the order of the file
    /// `<fppg><offlattice hydrostatic="true" />`: fluid of `<setfrdrawmode>` has the density of its
    /// depth, where GenCase v5.4 gives it rhop0.
    bool hydrostatic_off_lattice = false;
    /// Drawn in place of their parts, where the last of these stands.
    std::vector<BooleanDef> booleans;
    std::vector<InitialOp> initials; ///< in the order of the file
    NormalsDef normals;
    /// To the next copy of the case along the axes that grid.is_periodic names, besides the period
    /// itself, metres: minus XPeriodicIncY and XPeriodicIncZ of the solver's parameters, and so on.
    std::array<Vec3, 3> period_shift{};
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
    std::vector<std::string> hints; ///< what would be better; no errors with -strict

    VresDef vres;         ///< no zones: one resolution
    std::size_t zone = 0; ///< which of them this case is
    /// Of zone 0, where this is another one: GenCase takes its depth and, for rhopgradient 3, its
    /// surface.
    std::optional<double> main_hswl;
    std::optional<double> main_surface;
    Box3 particles_around; ///< limits of the particles of the zone around this one
};

/// The band of a fluid; null: none. `mk` is absolute.
const FluidBand* fluid_band(const CaseDef& def, std::uint16_t mk);

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
