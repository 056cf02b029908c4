#pragma once

#include <string>

namespace fppg
{

int process_id();

/// Whether no process of this machine has the id any more.
bool is_process_gone(int id);

/// The name of this machine in its network.
std::string machine_name();

/// The path of this program.
///
/// throws  IoError
std::string program_path();

/// Whether this system runs scripts of a POSIX shell.
bool has_shell();

/// Runs a script by the shell and waits for it.
///
/// returns  its exit code
int run_script(const std::string& quoted_path);

} // namespace fppg
