#pragma once

#include "fppg/vec.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// What `fppg new` is asked: parts, and what no file says. Lengths in metres, times in seconds.
struct NewCaseOptions
{
    std::vector<std::string> inputs; ///< mesh and STEP files, and folders of them
    std::string output; ///< of the definition, with .xml; the parts are named from there
    std::string kind;   ///< a name of new_case_kinds(); empty: found
    std::string unit;   ///< of all files: m, cm, mm or in; empty: found
    std::vector<std::string> units;     ///< NAME=mm: of one part
    std::string up = "z";               ///< the axis of the files that points upwards: x, y or z
    double dp = 0;                      ///< 0: by the two below
    double particles = 0;               ///< about as many; 0: 500,000 where nothing else is given
    double across = 0;                  ///< so many through the thinnest passage between parts
    std::string housing;                ///< the part that holds the fluid; empty: found
    std::vector<std::string> rotations; ///< NAME[,NAME...]=3000deg/s[@AXIS], rad/s, rpm
    std::vector<std::string> fixed;     ///< parts that stand still, whatever their shape
    std::vector<std::string> floatings; ///< NAME=400 (kg/m3) or NAME=12kg
    /// PART=2m/s of a flat sheet, PART:-x=3l/min or PART:0.8,0,0.6@PLACE=0.05l/s of a flat face
    std::vector<std::string> inlets;
    std::string fill;               ///< LIQUID=2.5l[@HOUSING], LIQUID=60%, LIQUID=0.12m
    std::optional<double> water;    ///< its level along z
    std::optional<double> speed;    ///< of the vehicle, or of the stream; m/s
    std::optional<double> duration; ///< of the run
    bool allows_far = false;        ///< parts far from all others
    bool allows_overlap = false;    ///< parts that move through each other
    int threads = 1;
    /// Asks at the terminal; the answer, or what stands there where it is empty. Without a
    /// function nothing is asked: what is missing is an error.
    std::function<std::string(const std::string& question, const std::string& otherwise)> ask{};
};

/// One thing that was decided, with its reason.
struct Proposal
{
    std::string what;   ///< such as "unit", "dp", "gear1"
    std::string value;  ///< such as "mm"
    std::string reason; ///< a sentence or a clause, for everyone
    std::string more;   ///< for --explain: what else could be said, and the option that changes it
};

/// A part of the case, as it was taken in.
struct NewCasePart
{
    std::string name;
    std::string path;      ///< of its file
    std::string step_part; ///< of a STEP file, how `fppg:part` names it
    std::string unit;
    int mkbound = 0;
    std::string role; ///< "housing", "fixed", "moving", "floating" or "inlet"
};

/// A case that runs as it stands.
struct NewCase
{
    std::string kind;
    std::string xml; ///< the definition
    double dp = 0;
    double expected_particles = 0;
    std::vector<NewCasePart> parts;
    std::vector<Proposal> proposals;
    std::vector<std::string> warnings; ///< whole sentences
    /// Of the files, whole sentences; making the particles says them again.
    std::vector<std::string> file_warnings;
};

/// "tank", "wading", "gearbox", "obstacle", "floating".
const std::vector<std::string>& new_case_kinds();

/// From parts to a definition: finds units, roles, axes, the cavity, the domain, dp and constants,
/// and says why. The definition is body-fitted, with walls in layers for mDBC.
///
/// throws  UsageError for an option that names no part, cannot be read, or is missing; IoError,
///         GeometryError for files, and for parts in other units, far away, open, or that move
///         through each other: with the file, the place and what to do
/// returns the same for any number of threads
/// cost    that of reading the parts, of their distances, and of a search on about a million nodes
///         for the cavity of a housing
NewCase propose_case(const NewCaseOptions& options);

/// For people: a table of proposals with their reasons.
///
/// explains  with all that can be said about each
std::string to_text(const NewCase& made, bool explains);

/// For programs: one JSON object.
std::string to_json(const NewCase& made);

} // namespace fppg
