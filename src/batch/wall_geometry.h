#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

#include <string>

namespace fppg
{

/// The surfaces of all boundaries that a case draws and does not forget (`<resetdraw>`), in the
/// place of its particles: of Booleans the result. What clips and later draws take away is not
/// taken off.
///
/// path    the definition, with its extension
/// throws  as read_case(), and for mesh files as read_mesh_file()
TriangleSoup wall_geometry(const std::string& path, const CaseOptions& options, int threads);

} // namespace fppg
