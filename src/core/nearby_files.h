#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fppg
{

/// For a message about a file that is at none of some places: "; in parts lie a.stl, b.stl
/// (did you mean a.stl?)", the files with its ending in the folders of the paths, each folder once
/// and eight names of each at most.
std::string what_lies_at(const std::vector<std::filesystem::path>& paths);

} // namespace fppg
