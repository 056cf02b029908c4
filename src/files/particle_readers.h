#pragma once

#include "fppg/read_particles.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// Particles that a thread takes at once.
inline constexpr std::size_t particles_per_chunk = 65536;

/// Reads positions from a file of DualSPHysics' binary container (JPartDataBi4): array Posd, or Pos
/// in single precision.
///
/// idp     receives the id of every particle
/// throws  IoError if the file is not whole or not of this format
void read_bi4(const std::string& path, ParticleCloud& cloud, std::vector<std::uint32_t>& idp,
              int threads);

/// Reads positions and the point data Mk, Type and Kind from a legacy binary VTK file.
///
/// throws  IoError if the file is not whole or not of this format, or has no Mk
void read_particles_vtk(const std::string& path, ParticleCloud& cloud, int threads);

} // namespace fppg
