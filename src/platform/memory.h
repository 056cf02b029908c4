#pragma once

#include <cstdint>

namespace fppg
{

/// Bytes of memory that the machine can still give to a process without swapping; a large number
/// where the system does not say.
std::uint64_t available_memory();

/// Gives memory that was freed in many small pieces back to the system, where it keeps it for the
/// process otherwise.
void return_free_memory();

} // namespace fppg
