#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/particles.h"
#include "fppg/scene.h"

#include "app/run_log.h"
#include "shapes/moments.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// The shape that a block is drawn by: exact_body(), or the surface of the one fitted solid that a
/// combination of draws makes of it.
///
/// why_not  filled with a sentence when nothing is returned
std::optional<ExactBody> shape_of_block(const Scene& scene, const FittedWalls& walls,
                                        const ParticleBlock& block, std::string& why_not);

/// The volume, the centre and the inertia at density 1 of the particles of a block, by the share of
/// dp^3 or the volume that each stands for.
///
/// are_cubes  each counts as a cube of dp, not as a point
ExactBody body_of_particles(const CaseParticles& particles, const ParticleBlock& block,
                            bool are_cubes);

/// A warning for each flexible body whose particles, not placed inside, are not its volume as the
/// solver counts them.
std::vector<std::string> weigh_flexible(const Scene& scene, const FittedWalls& walls,
                                        const CaseParticles& particles);

/// Writes a table of the fitted solids into the log: volume, mass, centre and inertia of the shape
/// and of the particles, each by mk. The mass is that of the density of `<floating>`, else of
/// rhop0. Particles count by the share of dp^3 or the volume that they stand for; those of bodies
/// with Placement::Inside as cubes of dp, others as points. Bodies of several draws, hollow ones
/// and those in 2D have no exact centre and inertia, and none of these is shown.
void log_bodies(const Scene& scene, const FittedWalls& walls, const CaseParticles& particles,
                const CaseConstants& constants, RunLog& log);

} // namespace fppg
