#pragma once

#include <string>

namespace fppg
{

/// How long this machine takes, over the one that src/batch/rates.h was measured on.
struct MachineSpeed
{
    double factor = 1; ///< above 0; 2: twice as long
    std::string file;  ///< that it was read from; empty: none is there
};

/// What keep_machine_speed() wrote; factor 1 where there is nothing, or nothing of sense.
MachineSpeed read_machine_speed();

/// Writes the factor to fppg/speed.json in XDG_CONFIG_HOME, else in .config of HOME, else in
/// APPDATA.
///
/// throws  IoError
MachineSpeed keep_machine_speed(double factor);

} // namespace fppg
