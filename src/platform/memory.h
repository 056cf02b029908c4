#pragma once

#include <cstdint>

namespace fppg
{

/// Bytes of memory that the machine can still give to a process without swapping; a large number
/// where the system does not say.
std::uint64_t available_memory();

/// Holds the memory of this process, without the stacks of so many threads, to a number of bytes:
/// what goes beyond throws std::bad_alloc, and available_memory() says what is left. Memory that is
/// reserved counts, used or not. Elsewhere than on Linux and Windows it may have no effect.
void limit_memory(std::uint64_t bytes, int threads);

/// What limit_memory() was given last; 0: nothing.
std::uint64_t memory_limit();

/// Gives memory that was freed in many small pieces back to the system, where it keeps it for the
/// process otherwise.
void return_free_memory();

} // namespace fppg
