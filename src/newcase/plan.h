#pragma once

#include "fppg/mesh_reading.h"
#include "fppg/new_case.h"
#include "fppg/surface_mesh.h"

#include "meshes/surface_gap.h"
#include "shapes/moments.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

enum class CaseKind
{
    Tank,
    Wading,
    Gearbox,
    Obstacle,
    Floating,
};

enum class PartRole
{
    Fixed,
    Housing, ///< fixed, and holds the fluid
    Moving,
    Floating,
    Inlet, ///< a sheet through which fluid comes in; no wall
};

/// A line through a point.
struct AxisLine
{
    Vec3 point;
    Vec3 direction; ///< of length 1
};

/// A line about which a part turns onto itself.
struct SymmetryAxis
{
    AxisLine line;
    int times = 0;  ///< a turn; 0: at any angle
    double off = 0; ///< metres, from its surface to the turned one: of half of the places at most
};

/// A part that turns.
struct Turning
{
    AxisLine axis;
    double degrees_per_s = 0; ///< counter-clockwise seen from the end of the axis
};

struct NewPart
{
    std::string path;
    std::string file;       ///< as the definition writes it
    std::string step_part;  ///< of a STEP file, how `fppg:part` names it; empty: it is a mesh file
    std::string step_facts; ///< what its CAD model says: edges, exact volume
    std::string name;       ///< no two parts have the same
    std::string unit;
    double metre = 0; ///< metres of its unit
    MeshFormat format = MeshFormat::Stl;
    std::vector<std::string> comments; ///< of the file, in small letters
    SurfaceMesh mesh;                  ///< metres, once the unit is known
    MeshReport report;                 ///< likewise: bounds, area and volume
    ExactBody body;                    ///< of closed meshes
    std::shared_ptr<GapTree> tree;
    std::optional<SymmetryAxis> symmetry;
    bool knows_symmetry = false; ///< it was looked for
    PartRole role = PartRole::Fixed;
    std::string role_reason;
    std::optional<Turning> turning;
    double rhop_body = 0; ///< of floating ones
    int mkbound = 0;

    const Box3& box() const { return report.bounds; }
    bool moves() const { return role == PartRole::Moving || role == PartRole::Floating; }
};

/// How near two parts are to each other.
struct PartPair
{
    std::size_t first = 0;
    std::size_t second = 0;
    SurfaceGap gap;
    bool touches = false; ///< nearer than a ten-thousandth of the smaller one
};

/// What a liquid is by its name.
struct Liquid
{
    std::string name = "water";
    double rhop0 = 1000;
    double viscosity = 1e-6; ///< m2/s
    std::string about;
};

enum class FluidAmount
{
    Level,
    Litres,
    Percent,
};

/// The fluid inside a housing or vessel: `<fppg><fill>`.
struct VesselFill
{
    std::size_t vessel = 0; ///< index of the part
    FluidAmount amount = FluidAmount::Litres;
    double value = 0;
    Vec3 seed;
    double volume = 0; ///< m3, of the fluid
    double level = 0;  ///< z of its surface
    double bottom = 0;
};

/// The disc or rectangle that a face is.
struct FaceOutline
{
    bool is_disc = false;
    Vec3 middle;
    double radius = 0; ///< of a disc, m
    Vec3 along;        ///< of a rectangle: along its first sides, of length 1
    Vec3 across;       ///< along the others: normal x along
    double length = 0; ///< of the first sides, m
    double width = 0;
    double filled = 0; ///< share of the disc or rectangle that the face covers: at least 0.9 of a
                       ///< disc, 0.97 of a rectangle are near enough
    bool is_near_enough = false;
};

/// A flat place through which fluid comes in.
struct FluidInlet
{
    std::string name;
    FaceOutline face;
    Vec3 direction; ///< of the fluid, of length 1
    double area = 0;
    double speed = 0;        ///< m/s
    double litres_per_s = 0; ///< where a flow is asked for; 0: a speed
    bool is_sheet = false;   ///< a part of its own, no wall
    double before_dp = 0;    ///< how far before the face its zone stands (place_inlets())
};

/// Fluid and walls around the parts where none of them holds it: a basin, or a channel whose ends
/// are joined.
struct WaterBox
{
    Box3 box;           ///< inner faces of the walls
    double level = 0;   ///< z of the water
    bool flows = false; ///< along x, periodic
    double volume = 0;  ///< m3, of the fluid
    Vec3 seed;
};

/// A case as it is being decided, part by part.
struct CasePlan
{
    const NewCaseOptions* options = nullptr;
    CaseKind kind = CaseKind::Tank;
    std::vector<NewPart> parts;
    std::vector<PartPair> pairs;
    std::optional<double> speed; ///< of the vehicle or stream, given or answered; m/s
    Liquid liquid;
    std::optional<VesselFill> fill;
    std::optional<WaterBox> water;
    std::vector<FluidInlet> inlets;
    double passage = 0; ///< the thinnest between parts that do not touch, metres; 0: there is none
    Vec3 passage_at;
    double dp = 0;
    double expected = 0; ///< particles
    double duration = 0;
    double time_out = 0;
    double depth = 0;
    double fastest = 0; ///< of parts and stream, m/s
    double speed_sound = 0;
    double visco = 0; ///< coefficient of the artificial viscosity
    std::vector<Proposal> proposals;
    std::vector<std::string> warnings;
    std::vector<std::string> file_warnings;

    void propose(std::string what, std::string value, std::string reason, std::string more = "")
    {
        proposals.push_back(
            {std::move(what), std::move(value), std::move(reason), std::move(more)});
    }
    const PartPair& pair(std::size_t a, std::size_t b) const;
};

/// The index of a part by its name; capitals do not count.
///
/// option  that names it, for the message
/// throws  UsageError that lists the parts
std::size_t part_named(const CasePlan& plan, const std::string& name, const std::string& option);

/// Whether two parts keep their places against each other.
bool move_alike(const NewPart& a, const NewPart& b);

/// "(0.1, 0, 0.05) m"
std::string place_text(const Vec3& p);
/// A number with so many digits, without an exponent where that is short.
std::string short_number(double value, int digits = 4);
/// 0.000123 to two or three digits as a person writes it, rounded up.
double round_up(double value, int digits);
double round_nearest(double value, int digits);

// The steps, in this order; each adds its proposals. All throw as propose_case() says.

/// Reads the files and names the parts.
void read_parts(CasePlan& plan);
/// Finds out what a length in each file is, and scales the meshes to metres.
void choose_units(CasePlan& plan);
/// Refuses parts in other units and parts far away, warns of open ones.
void judge_parts(CasePlan& plan);
/// The distances of all pairs.
void measure_pairs(CasePlan& plan);
/// Kind, housing, and what floats.
void choose_roles(CasePlan& plan);
/// Where fluid comes in; numbers the parts that are walls.
void choose_inlets(CasePlan& plan);
/// What turns, about which axes, and what turns with it.
void choose_motion(CasePlan& plan);
/// Parts that move through each other are refused.
void judge_overlaps(CasePlan& plan);
/// Where the fluid is: in a vessel, in a basin or in a channel.
void choose_fluid(CasePlan& plan);
/// dp and the number of particles.
void choose_resolution(CasePlan& plan);
/// Speed of sound, viscosity, duration, outputs.
void choose_constants(CasePlan& plan);
/// The definition.
std::string case_text(const CasePlan& plan);

/// The axis about which a part turns onto itself; nothing where it does about none, or about many.
const std::optional<SymmetryAxis>& symmetry_of(NewPart& part, int threads);

} // namespace fppg
