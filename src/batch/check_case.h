#pragma once

#include "fppg/case_def.h"

#include <optional>
#include <string>

namespace fppg
{

/// Why a run of a case would be refused, or nothing: what reading the definition finds, of every
/// `<vres>` region, and mesh and point files that are not there. Meshes are not read and nothing is
/// drawn, so that drawing may refuse more.
///
/// path       the definition, with its extension
/// is_strict  warnings of reading count, as with -strict
std::optional<std::string> find_refusal(const std::string& path, CaseOptions options,
                                        bool is_strict);

} // namespace fppg
