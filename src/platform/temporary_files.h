#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// Notes a file that is to go when a signal ends the process. At most 1,024 are known at a time;
/// those beyond are left to a later run.
///
/// returns  for unregister_temporary(); -1 where it could not be noted
int register_temporary(const std::string& path);
void unregister_temporary(int slot) noexcept;

/// Removes all files that are noted. Async-signal-safe: meant for a signal handler that ends the
/// process afterwards.
void remove_temporary_files() noexcept;

/// Removes temporary files `.<name>.part-<process id>` of a folder whose processes are gone, as a
/// killed run leaves them: those of the file `name`, and with `is_stem` of every file whose name
/// goes on with '.' or '_' behind it. A file that a process of another machine holds (flock) stays.
void remove_dead_parts(const std::string& folder, const std::string& name, bool is_stem);

} // namespace fppg
