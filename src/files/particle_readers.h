#pragma once

#include "files/bi4_view.h"
#include "fppg/read_particles.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// Particles that a thread takes at once.
inline constexpr std::size_t particles_per_chunk = 65536;

/// Copies the places of a .bi4: array Posd, or Pos in single precision.
///
/// idp  receives the id of every particle
void copy_particles(const Bi4View& view, ParticleCloud& cloud, std::vector<std::uint32_t>& idp,
                    int threads);

/// Reads positions and the point data Mk, Type and Kind from a legacy binary VTK file.
///
/// throws  IoError if the file is not whole or not of this format, or has no Mk
void read_particles_vtk(const std::string& path, ParticleCloud& cloud, int threads);

} // namespace fppg
