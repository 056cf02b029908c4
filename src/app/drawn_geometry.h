#pragma once

#include "app/command_line.h"
#include "fppg/mesh.h"

#include <string>
#include <vector>

namespace fppg
{

/// Takes what stands behind "--" out of the arguments of a subcommand: options of a run.
std::vector<std::string> take_run_options(std::vector<std::string>& arguments);

/// A definition and the options that it is run with; `input` is without its extension.
///
/// throws  UsageError for options that a run would refuse
DropInOptions parse_definition(const std::string& definition,
                               const std::vector<std::string>& of_run);

/// The surfaces of the boundaries that a definition draws, where it draws them.
///
/// definition  with or without its extension
/// of_run      the options that it was run with, as -dp:0.01
/// throws      as wall_geometry(), UsageError for options that a run would refuse
TriangleSoup drawn_geometry(const std::string& definition, const std::vector<std::string>& of_run,
                            int threads);

} // namespace fppg
