#pragma once

#include "fppg/case_def.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// What a call in GenCase's form asks for.
struct DropInOptions
{
    enum class Action
    {
        Run,
        Help,
        Version,
        Info,
        Templates,
        Clean,
    };

    Action action = Action::Run;
    std::string input;  ///< without ".xml"
    std::string output; ///< without extension; of Templates the folder
    std::optional<double> dp;
    std::vector<std::pair<std::string, std::string>> evars;
    FitChoice fit = FitChoice::AsCase;
    int threads = 0;      ///< 0: what the machine or its scheduler allows
    double memory_gb = 0; ///< that the run may take; 0: what the machine has
    int debug = 0;
    bool save_nothing = false; ///< makes all and writes no file
    bool save_bi4 = true;
    bool save_cells = true;
    bool save_off_lattice_points = true; ///< of setfrdrawmode, where there are any
    bool save_all = false;
    bool save_bound = false;
    bool save_fluid = false;
    bool save_features = false;   ///< where walls are fitted
    bool save_relaxation = false; ///< its history, where something is relaxed
    bool save_three_vtk = false;
    std::vector<std::string> to; ///< formats of other codes, by name
    bool create_folders = true;
    bool strict = false;    ///< warnings where GenCase is silent are errors
    bool is_quiet = false;  ///< print warnings and errors only
    bool log_json = false;  ///< print a JSON object a line
    bool overwrite = false; ///< templates that exist and differ
};

/// Reads arguments in GenCase's form: `in out`, `in a*b` (the star stands for the input's name), or
/// one name for both, and `-name:value` options.
///
/// throws UsageError for what is not known, or has a value that cannot be read
DropInOptions parse_command_line(const std::vector<std::string>& arguments);

/// What a run gives to read_case().
CaseOptions case_options(const DropInOptions& run);

/// The text of --help.
std::string help_text();

} // namespace fppg
