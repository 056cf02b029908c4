#pragma once

#include "fppg/mesh_reading.h"

#include "meshes/cad_facets.h"

#include <memory>
#include <string>
#include <vector>

namespace fppg
{

/// Angles between facets of smooth faces of STEP files, about; radians. Well below feature angles.
inline constexpr double step_angle = 0.2;

/// Facets of STEP files are so far from their surface in a case, dp.
inline constexpr double cad_deflection_dp = 0.01;

/// Whether a file is STEP by its ending: .step, .stp.
bool is_step_file(const std::string& path);

/// Reads a STEP file as facets, with the exact faces behind them (MeshFile::cad). Metres, whatever
/// the unit of the file.
///
/// reading  `parts` says which; `deflection` how far facets are from their surface
/// throws   IoError where the plugin that reads STEP is missing (names the places looked at), or
///          the file cannot be opened; GeometryError where it is no STEP file, or has no part, or
///          none of a name that is asked for (lists them)
MeshFile read_step(const std::string& path, const MeshReading& reading);

/// The parts of a STEP file, in its order. CadPart::first_facet and what is measured are 0.
///
/// throws  as read_step()
std::vector<CadPart> step_parts(const std::string& path);

} // namespace fppg
