#pragma once

#include "fppg/mesh_reading.h"

#include <optional>
#include <string>
#include <string_view>

namespace fppg
{

/// The format that `<drawfileNAME>` draws; empty: there is none of this name.
std::optional<MeshFormat> mesh_format_named(std::string_view name);

/// The endings of all files that a mesh is read from, for messages: ".stl, .ply, ...".
std::string mesh_file_endings();

} // namespace fppg
