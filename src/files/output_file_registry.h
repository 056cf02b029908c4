#pragma once

namespace fppg
{

/// Removes the temporary files of all living OutputFile objects. Async-signal-safe: meant for a
/// signal handler that ends the process afterwards. At most 64 files are known at a time; those
/// beyond are removed by their destructors only.
void remove_temporary_files() noexcept;

} // namespace fppg
