#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{

/// What Case.out tells of a run, ours or GenCase's.
struct RunFacts
{
    std::vector<std::pair<std::string, double>> stages; ///< name, seconds
    double seconds = 0;                                 ///< of all; 0 where it is not said
    std::vector<std::string> warnings;
};

RunFacts read_run_facts(std::string_view text);

/// Of the file Case.out that belongs to a result, Case.bi4, Case.xml or Case_All.vtk; none where
/// there is none.
std::optional<RunFacts> facts_of_result(const std::string& path);

/// A line of times and a list of warnings.
std::string run_facts_html(const RunFacts& facts);

} // namespace fppg
