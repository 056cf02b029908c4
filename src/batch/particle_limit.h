#pragma once

#include "fppg/case_def.h"

#include "core/most_particles.h"

#include <cstdint>
#include <string>

namespace fppg
{

/// How many particles a result can have, and what holds no more.
struct ParticleLimit
{
    double most = static_cast<double>(most_particles);
    std::string holder = std::string("the file format holds at most ") + most_particles_text;
    bool is_of_disk = false;
};

/// The limit of the file format, or of the disk where that has less room.
///
/// folder  of the files, which exists
/// bytes   of all files for a particle
ParticleLimit limit_of_disk(const std::string& folder, double bytes);

/// Refuses a case of more particles than the limit before it is drawn, where the nodes of its
/// domain are more than that: draws it with a few larger particle distances on the lattice and goes
/// on from these numbers. A case that cannot be judged so is left to the draw itself, which counts.
///
/// path     of the definition
/// options  that `def` was read with
/// throws   CaseError, or IoError where the disk is the limit, that names a particle distance that
///          fits
void expect_particles_fit(const std::string& path, const CaseOptions& options, const CaseDef& def,
                          int threads, const ParticleLimit& limit = {});

/// The same of a case that is drawn.
///
/// throws  IoError where the disk is the limit; the limit of the format is left to
///         make_particles()
void expect_room(const CaseDef& def, std::uint64_t particles, const ParticleLimit& limit);

} // namespace fppg
