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

/// What calibrate_speed() wrote; factor 1 where there is none, or none of sense.
MachineSpeed read_machine_speed();

/// Measures the factor, by the processor time of particles laid and relaxed on a ball, the least of
/// three runs of about half a second each, and writes it to fppg/speed.json in XDG_CONFIG_HOME,
/// else in .config of HOME, else in APPDATA.
///
/// throws  IoError
MachineSpeed calibrate_speed();

} // namespace fppg
