#pragma once

#include "fppg/case_def.h"

#include <string>

namespace fppg
{

/// Where the mesh file of a draw lies: GenCase takes names from the working directory, which comes
/// first; then the folder of the definition.
///
/// throws IoError that names both places
std::string find_mesh_file(const CaseDef& def, const SourceRef& source, const std::string& file);

} // namespace fppg
