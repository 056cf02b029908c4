#pragma once

#include "fppg/particles.h"
#include "fppg/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// What is wrong with a particle. A boundary particle has at most one of the first seven, the first
/// that holds; the others may come together.
enum class Fault : std::uint8_t
{
    NoNormal,       ///< fluid can come within 2h, and it has no normal: it stays plain DBC
    GhostOutside,   ///< no fluid can come within 2h of its ghost node, which is outside the domain
    GhostInWall,    ///< its ghost node lies in another wall, or in its own
    ThroughWall,    ///< a wall stands between it and its ghost node
    LooksAway,      ///< the same, in the domain: the solver switches the particle off
    WeakKernel,     ///< the kernel sum at the ghost node is below 0.1
    IllConditioned, ///< condition number above 50, or determinant below 0.001: Shepard's sum
    BothSides,      ///< the wall is wet on both sides and thinner than 2h - dp/2
    InBufferZone,   ///< in a buffer zone of vres without what the solver asks for there
    FluidNearWall,  ///< fluid nearer than 0.5 dp to a wall particle
    ClosePair,      ///< another particle is nearer than 0.3 dp
    OutsideDomain,  ///< outside the domain of the solver, or its place is no number
    NearInlet,      ///< of a wall, nearer than 0.7 dp to points of a zone of <inout>
};
inline constexpr std::size_t fault_count = 13;

/// Short stable name, as in JSON: "no_normal".
const char* fault_name(Fault fault);

/// A buffer zone of variable resolution: inside `outer`, limits included, but not inside `inner`.
struct BufferZone
{
    Box3 outer;
    Box3 inner;
};

/// A zone where fluid goes in and out.
struct CheckInlet
{
    std::optional<std::uint16_t> mk; ///< absolute, of the fluid whose particles are its points
    std::vector<Vec3> points;        ///< of the others
    Vec3 way;                        ///< unit, in which fluid comes in; zero: not known
    int layers = 1;                  ///< rows that the solver sets, dp apart
};

/// A block of moving particles and where it is at even times, as maps of its places at the start.
struct MovingBlock
{
    std::uint16_t mk = 0;          ///< absolute
    double step = 0;               ///< seconds from one to the next
    std::vector<Transform> places; ///< the first at 0 s; empty: a file moves it
};

/// What the solver knows of a case besides its particles. SI units.
struct CheckSetup
{
    std::string case_name;
    bool is_2d = false;
    double dp = 0;
    double h = 0;
    double volume = 0;      ///< of a fluid particle: mass / rhop0
    double speed_sound = 0; ///< m/s; 0: the case does not say it
    double cfl_number = 0;
    double least_step = 0;           ///< parameter DtMin, s; 0: the solver's own
    std::vector<MovingBlock> moving; ///< up to TimeMax
    Vec3 gravity;                    ///< m/s2
    int boundary = 1;                ///< parameter Boundary: 1 DBC, 2 mDBC
    int slip_mode = 1;               ///< parameter SlipMode
    bool no_penetration = false;     ///< parameter NoPenetration, where SlipMode is 2 or 3
    Box3 domain;                     ///< as the solver sets it
    std::array<bool, 3> is_periodic{};
    std::array<Vec3, 3> periodic; ///< from a place to its copy, of each axis that is periodic
    std::vector<BufferZone> buffers;
    std::vector<CheckInlet> inlets;
    std::vector<std::string> notes; ///< what was not judged, whole sentences
};

/// The particles of a case, one entry each in all arrays but `normals`.
struct CheckParticles
{
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> ids;
    std::vector<std::uint16_t> mk; ///< absolute
    std::vector<ParticleType> type;
    /// From a boundary particle to the boundary's surface; zero: none. Particles beyond the end
    /// have none; empty: the file has no normals.
    std::vector<std::array<float, 3>> normals;
};

/// What was found of one mk.
struct CheckedMk
{
    std::uint16_t mk = 0;
    ParticleType type = ParticleType::Fixed;
    std::uint64_t count = 0;
    std::uint64_t near_fluid = 0; ///< boundary: fluid can come within 2h
    bool has_normals = false;
    std::array<std::uint64_t, fault_count> faults{}; ///< particles, by Fault
    /// Boundary: particles that fluid can come next to (1.9 dp), and those of them that
    /// NoPenetration can act on (|n| < 0.875 dp).
    std::uint64_t front = 0;
    std::uint64_t front_no_penetration = 0;
    double mean_window = 0; ///< of those: 1.5 |n| / dp, within which NoPenetration acts
    /// Of walls wet on both sides that are too thin: metres, the thinnest and the median, and the
    /// dp at which the median has room for both sides; 0 without any.
    double thinnest = 0;
    double median_thickness = 0;
    double dp_needed = 0;

    std::uint64_t operator[](Fault f) const { return faults[static_cast<std::size_t>(f)]; }
};

struct FaultyParticle
{
    std::uint32_t id = 0;
    std::uint16_t mk = 0;
    std::uint16_t faults = 0; ///< bit i: Fault i
    Vec3 position;
    std::array<float, 3> normal{};
};

struct CheckReport
{
    CheckSetup setup;
    std::uint64_t np = 0;
    bool judges_normals = false;        ///< the case has normals or mDBC
    std::uint64_t fluid = 0;            ///< particles
    std::uint64_t fill = 0;             ///< nodes that fluid can reach besides them
    std::uint64_t close_pairs = 0;      ///< nearer than 0.3 dp
    std::vector<CheckedMk> mks;         ///< by mk
    std::vector<FaultyParticle> faulty; ///< by their order in the file

    std::uint64_t total(Fault fault) const;
    /// A fault counts as a finding where a single one is harmful; the solver has an answer of its
    /// own to weak kernels and ill-conditioned ghost nodes: they count where they are more than 1 %
    /// of the particles of an mk that fluid can reach.
    bool is_finding(const CheckedMk& mk, Fault fault) const;
    bool is_clean() const;
};

/// Judges particles as DualSPHysics v5.4 would with mDBC, with the cavity full of fluid.
///
/// Where fluid can come: nodes of a lattice (spacing dp, through the fluid of the case) in the box
/// of all boundary particles that are 0.87 dp (2D: 0.75 dp, so that no way leads through a sheet of
/// particles) or more from all boundary particles and not in the cylinder around a normal (radius
/// 0.7 dp, up to 0.5 dp beyond the surface), and that a way from node to node joins with the fluid
/// of the case; where the case has no fluid, all spaces of eight such nodes or more. Under gravity
/// along -z not those that fluid comes to over a rim only, above where it is at the start, and from
/// which it runs down and out of the box, as beside a round vessel; within the rim it stands up to
/// 2 h above its level. Nodes nearer than 0.75 dp to fluid of the case give way to it. Where fluid
/// comes to a side of the box, as over an open tank, it is taken to go on 4 h beyond that side, and
/// 2 h along it, so that rims are judged as if under water.
///
/// threads  the result does not depend on it
/// cost     a few microseconds a boundary particle that fluid can reach, less for others; about 100
///          bytes a particle
/// source   DualSPHysics v5.4, JSphCpu_mdbc.cpp: Wendland kernel, matrices and thresholds
CheckReport check_particles(const CheckParticles& particles, CheckSetup setup, int threads);

/// The same of a written case, ours or GenCase's.
///
/// case_name  without extension: Case.xml and Case.bi4
/// throws     IoError, CaseError as the readers of files; CaseError where Case.xml lacks a constant
CheckReport check_case(const std::string& case_name, int threads);

/// For people: tables by mk and what to do.
std::string to_text(const CheckReport& report);
/// The same as part of a page.
std::string to_html(const CheckReport& report);
/// For programs: one JSON object.
std::string to_json(const CheckReport& report);
/// The faulty particles as legacy binary VTK: Fault (number of the first), Faults (bits), Idp, Mk,
/// Normal.
std::string to_vtk(const CheckReport& report);

} // namespace fppg
