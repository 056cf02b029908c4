#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// A variable and the values that it takes in turn.
struct SweepVariable
{
    std::string name; ///< "Dp" (in any case of letters) is the particle distance
    std::vector<std::string> values;
};

/// Reads `NAME=VALUE,VALUE,...`. throws UsageError
SweepVariable parse_sweep(const std::string& text);

/// One run of a case.
struct BatchRun
{
    std::string name;       ///< unlike all others; a path relative to the folder of results
    std::string definition; ///< absolute, without ".xml"
    std::string output;     ///< absolute, without extension
    std::vector<std::pair<std::string, std::string>> settings; ///< of swept variables
    std::vector<std::string> options; ///< of the program: -dp:, -evars:, then those for all runs
};

/// The runs of a batch: every case with every combination of values, the last variable changing
/// fastest, cases in the order of their paths or of the list.
///
/// source   a folder, searched with those in it for `*_Def.xml` (but not `out`), or a file that
///          lists cases, one per line, relative to its own folder; blank lines and those that begin
///          with '#' do not count; ".xml" may be left out; or one definition `.xml`
/// out      absolute folder of results; a run's files lie in out/<name>/<case>, <case> without
///          "_Def"
/// options  handed to every run
/// throws   IoError if there is no such folder or file, UsageError if it has no case
std::vector<BatchRun> list_runs(const std::string& source, const std::string& out,
                                const std::vector<SweepVariable>& variables,
                                const std::vector<std::string>& options);

} // namespace fppg
