#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/particles.h"
#include "fppg/scene.h"

#include "app/run_log.h"
#include "scene/exact_body.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// What is known of a floating body.
struct SettledFloating
{
    int mkbound = 0;
    FloatingBody of_particles;      ///< as of GenCase
    std::optional<ExactBody> shape; ///< the closed shape that draws the body
    std::string why_not;            ///< where there is no such shape
    FloatingBody exact;             ///< of the shape
    bool is_exact_taken = false;
};

struct SettledFloatings
{
    std::vector<SettledFloating> bodies;
    /// Bodies with fitted walls whose mass by their density is more than 1 % off that of their
    /// shape, as they are hollow or cut, and those whose inertia is 5 % off that of their shape.
    std::vector<std::string> warnings;
    /// Bodies on the lattice whose mass by their density is more than 5 % off that of their shape:
    /// so GenCase gives them to the solver without a word.
    std::vector<std::string> light_or_heavy;
};

/// Finds mass, centre and inertia of all floating bodies: of their particles, as they go into
/// Case.xml like those of GenCase, and beside them the exact ones of the closed shape, at the
/// density of `<floating>` (where the mass is given, mass over exact volume). Where
/// `<fppg><floatings exact="true">` asks for it the exact ones take the place of the others in
/// `particles`, but for what `<floating>` itself gives.
///
/// throws  CaseError where exact ones are asked for and neither a single closed shape nor a
///         combination draws the body
SettledFloatings settle_floatings(const Scene& scene, const FittedWalls& walls,
                                  CaseParticles& particles);

/// Writes them into the log.
void log_floatings(const SettledFloatings& floatings, RunLog& log);

} // namespace fppg
