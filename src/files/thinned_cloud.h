#pragma once

#include "files/particle_source.h"
#include "fppg/read_particles.h"

#include <cstdint>
#include <optional>

namespace fppg
{

/// The first particle of every mk in every cube of `step` dp, in the order of the file: what a
/// picture shows of a result that has too many particles. All particles for step 1.
///
/// from     least coordinates of the particles, metres
/// returns  positions, mks, types where the file has them, and the cube's size as dp; none where
///          there are more than `most`
std::optional<ParticleCloud> one_of_every_cube(const ParticleSource& source, const Vec3& from,
                                               double dp, std::uint64_t step, std::size_t most);

/// The same with the smallest step that leaves at most `most` particles (to 2 % where it is above
/// 64); one per mk where there are more mks than that.
ParticleCloud thinned_cloud(const ParticleSource& source, const Vec3& from, double dp,
                            std::size_t most);

} // namespace fppg
