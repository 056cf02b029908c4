#pragma once

#include "fppg/particles.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

struct LeakOptions
{
    /// The definition, where Case.xml with meshes beside it is not to be taken; with extension.
    std::string definition;
    std::vector<std::pair<std::string, std::string>> evars; ///< as -evars: of the generation
    /// A particle counts as inside when it is deeper than this below the surface, dp. Single
    /// precision puts particles off by less.
    double tolerance_dp = 0.001;
    int threads = 1;
};

/// A closed shape that fluid must not get into.
struct LeakBody
{
    std::string name;     ///< command, file or name, and line
    std::uint16_t mk = 0; ///< absolute
    ParticleType type = ParticleType::Fixed;
};

/// What one output of the solver shows.
struct LeakInstant
{
    std::string file;
    double time = 0; ///< seconds
    std::uint64_t step = 0;
    double dt_least = 0; ///< seconds, since the output before; 0 where the file does not say
    double dt_largest = 0;
    std::uint64_t fluid = 0; ///< particles that the file has
    /// Fluid particles of the case (and new ones of the solver) that the solver has taken out.
    std::uint64_t excluded = 0;
    std::uint64_t inside = 0;             ///< in a solid
    std::uint64_t deep = 0;               ///< of them more than 0.5 dp below its surface
    double deepest_dp = 0;                ///< below its surface
    std::optional<std::uint64_t> outside; ///< of the closed housing; empty without one
    std::vector<std::uint64_t> in_body;   ///< per body, sums to `inside`
};

struct LeakReport
{
    std::string case_name;
    double dp = 0;           ///< metres
    std::uint64_t fluid = 0; ///< of the case
    bool has_housing = false;
    std::vector<LeakBody> bodies;
    std::vector<LeakInstant> instants; ///< by time
    std::vector<std::string> notes;    ///< what could not be judged, whole sentences

    /// Nothing is inside a solid or outside the housing at any time.
    bool is_tight() const;
};

/// Counts fluid particles where none can be: inside solids, and outside a closed housing.
///
/// Solids are the closed shapes that the case draws with a mkbound and fills (solid and full mode,
/// autofill, advanced, fppg:fill), combinations of a <boolean> included, and closed shells without
/// fluid in them at the beginning. They are judged by their facets, not by particles: a point is
/// inside by the sum of signed crossings along each axis where at least two axes agree, else by the
/// winding number. What a later void or fluid shape takes away is not solid. A closed housing is
/// there when no way leads from outside all shapes to the fluid of the case through openings wider
/// than about two dp; outside of it are particles whose lattice node such a way reaches, which is
/// 0.87 dp off the surface at the latest. It moves with its shapes; where it opens while it moves,
/// or bends, nothing is counted at that time.
///
/// Shapes of a moving or floating mk stand where its particles are: the rigid motion that takes
/// those of the case to those of the output with the least squares (Horn 1987). Where they are more
/// than 0.05 dp off it, the mk does not move as a rigid body and is not judged, with a note.
///
/// case_name  the result that the solver was given, without extension: Case.xml and Case.bi4
/// parts      files Part_XXXX.bi4 of DualSPHysics v5, or folders that hold them
/// throws     UsageError without any file; IoError, CaseError, GeometryError as the readers of
///            files; CaseError if the case has variable resolution, or an output is not of it
/// returns    the same for any number of threads
/// cost       about a microsecond for a fluid particle and a body whose box it is in
LeakReport count_leaks(const std::string& case_name, const std::vector<std::string>& parts,
                       const LeakOptions& options);

/// For people: a table over time and the bodies that have something inside.
std::string to_text(const LeakReport& report);

/// For programs: one JSON object.
std::string to_json(const LeakReport& report);

/// A plot over time as SVG: inside solids, outside the housing, taken out by the solver.
std::string to_svg(const LeakReport& report);

} // namespace fppg
