#pragma once

#include "fppg/rgb.h"
#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace fppg
{

/// Particles as a file holds them, one entry each in all arrays that are not empty, in the order of
/// the file.
struct ParticleCloud
{
    std::string file; ///< that the positions were read from
    double dp = 0;    ///< metres
    std::vector<Vec3> positions;
    std::vector<std::uint16_t> mk;        ///< absolute
    std::vector<std::uint8_t> type;       ///< as ParticleType; empty where the file does not say
    std::map<std::uint16_t, Rgb> colours; ///< of mks whose CAD model has one, by Case.xml
    std::vector<std::uint8_t> kind;       ///< as FitKind; empty where the file does not say
    /// Of fitted walls, 1 nearest to the surface; 0: in none; empty where the file does not say.
    std::vector<std::uint8_t> layer;
    std::vector<std::array<float, 3>> normals; ///< of walls, zero where there is none; as `kind`
    std::vector<float> distances; ///< metres to the walls, distance_of_nodes for nodes; as `kind`
};

/// Reads the particles of a case, written by fppg or by GenCase (v5.0 and v5.4).
///
/// name     a case without extension: `name.bi4` with `name.xml`, or else `name_All.vtk`;
///          or one file: `.bi4` or `.xml` of a case, or a legacy binary VTK file (POLYDATA) with
///          point data Mk and, if it has them, Type, Kind, Layer, Distance and the normals of walls
///          (WallNormal, or Normal in a file without NormalSize)
/// has_kind_first  for a case: `name_All.vtk` first, because only VTK files hold the kind
/// threads  number of threads; the result does not depend on it
/// returns  mk and type of a bi4 by the ranges of ids in Case.xml; dp as Case.xml says; for a VTK
///          file without Case.xml beside it the median of the distances from a sample of particles
///          to their nearest ones
/// throws   IoError if there is no such file, or one is not whole or not of these formats;
///          CaseError if Case.xml lacks the ranges, or they miss an id
ParticleCloud read_particles(const std::string& name, bool has_kind_first, int threads);

} // namespace fppg
