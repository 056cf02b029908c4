#pragma once

#include "fppg/mesh_reading.h"

#include <optional>
#include <string>
#include <string_view>

namespace fppg
{

/// The format that `<drawfileNAME>` draws; empty: there is none of this name.
std::optional<MeshFormat> mesh_format_named(std::string_view name);

/// Whether GenCase cannot read it.
bool is_own_format(MeshFormat format);

/// The name of a format, "stl"; empty for one that no file name tells.
std::string_view mesh_format_name(MeshFormat format);

/// The names of all formats, for help texts: "STL, PLY, ...".
std::string mesh_format_list();

} // namespace fppg
