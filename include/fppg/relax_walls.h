#pragma once

#include "fppg/case_def.h"
#include "fppg/fluid_space.h"
#include "fppg/lattice.h"
#include "fppg/relax.h"
#include "fppg/relax_volume.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace fppg
{

/// What a running relaxation has reached.
struct RelaxStep
{
    std::string what;          ///< "surface", or "volume mk 11" and the like
    int iteration = 0;         ///< from 1
    int last_iteration = 0;    ///< that it may come to
    std::size_t particles = 0; ///< that may move, and of a surface all
    double mean = 0;           ///< spacing in dp on a surface, Shepard sum in a volume
    double variation = 0;      ///< coefficient of variation
    double largest_step_dp = 0;
    std::size_t piece = 1, pieces = 1; ///< RelaxProgress
};

/// Called after every iteration; false ends the relaxation of everything, and what is reached is
/// kept.
using RelaxObserver = std::function<bool(const RelaxStep&)>;

/// Called with all wall particles as they stand, on their facets, each time after the iterations
/// that RelaxSettings::snapshots says. Where several surfaces are relaxed one after the other,
/// their iterations are counted on.
using RelaxSnapshot = std::function<void(int iteration, const WallParticles&)>;

/// What one relaxation did.
struct RelaxedPart
{
    std::string what;
    int iterations = 0;
    std::size_t particles = 0; ///< afterwards
    std::size_t inserted = 0;
    std::size_t removed = 0;
    double variation_before = 0; ///< surfaces only
    double mean = 0;             ///< as in RelaxStep
    /// Coefficient of variation; of surfaces that of the distance from each wall particle to the
    /// nearest one, whatever edge, sheet or body it is on.
    double variation = 0;
    /// Surfaces only: the same over the particles that move, each among those of its sheet.
    double smooth_variation = 0;
    double nearest_pair_dp = 0; ///< surfaces only
};

struct RelaxReport
{
    std::vector<RelaxedPart> parts;
    std::vector<std::string> warnings; ///< whole sentences
    FluidSpace space;                  ///< that walls leave to fluid
    bool is_stopped = false;           ///< by the observer
};

/// Whether relax_walls() would move anything: not with -fit:raw, for example.
bool relaxes(const CaseDef& def, const RunField& field);

/// Relaxes the fitted walls of a field and the volume beside them, as the settings of their mks and
/// the fluid bands of the case say: first all surfaces, then the inside of every solid mk, then the
/// fluid. Places between walls that are narrower than 1.5 dp (moving: 2 dp) are left empty.
///
/// The particles of a surface stay on it (relax_surface()); those within 2 dp of a cut are held.
/// Afterwards no two of all surfaces are nearer than least_pair_dp, but those on both sheets of a
/// plate whose settings ask for both: the shallower layer stays, then corners, then edges.
/// Lattice nodes within the band of a wall become particles off the lattice: they go into
/// walls.volume, and their nodes are covered. Nodes that did not move stay nodes.
/// Nodes within 3 dp of a place where a wall was cut do not move, nor do those along a sheet that
/// has nodes of the same mks on both sides.
///
/// In 2D the surface particles stay, they stand evenly along their section already; volumes and
/// fluid move in their plane, beside the lines in which it meets the walls.
///
/// observe   may be empty; what it throws is passed on and leaves the field in an unspecified state
/// snapshot  may be empty; the same
/// threads   number of threads; the result does not depend on it
/// throws    GeometryError for options out of range
void relax_walls(const CaseDef& def, RunField& field, int threads, const RelaxObserver& observe,
                 RelaxReport& report, const RelaxSnapshot& snapshot = {});

} // namespace fppg
