#pragma once

#include "app/inspect.h"
#include "fppg/mesh_reading.h"

#include <vector>

namespace fppg
{

/// How the file is read.
MeshReading reading_of(const InspectOptions& options);

/// The shape of a closed mesh file and its particles with the defaults of `<bodyfitted>` and of
/// place="inside".
///
/// options  with a dp
/// mesh     that of the file, watertight
std::vector<InspectedBody> inspect_bodies(const InspectOptions& options, const SurfaceMesh& mesh);

} // namespace fppg
