#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>

namespace fppg
{

/// Calls body(i) for i in [0, n), spread over `threads` threads in chunks of `chunk`, handed out as
/// threads become free. The body must not depend on the order. The exception of the lowest i that
/// failed is thrown afterwards.
template <typename Body>
void parallel_for(std::size_t n, int threads, const Body& body, std::size_t chunk = 1)
{
    if (n == 0) return;
    if (threads <= 1 || n <= chunk)
    {
        for (std::size_t i = 0; i < n; ++i) body(i);
        return;
    }
    std::exception_ptr first_error;
    std::size_t first_index = SIZE_MAX;
    std::mutex guard;
    const auto count = static_cast<std::int64_t>(n);
    const auto step = static_cast<std::int64_t>(chunk);
#pragma omp parallel for schedule(dynamic, step) num_threads(threads)
    for (std::int64_t i = 0; i < count; ++i)
    {
        try
        {
            body(static_cast<std::size_t>(i));
        }
        catch (...)
        {
            const std::lock_guard lock(guard);
            if (static_cast<std::size_t>(i) < first_index)
            {
                first_index = static_cast<std::size_t>(i);
                first_error = std::current_exception();
            }
        }
    }
    if (first_error) std::rethrow_exception(first_error);
}

} // namespace fppg
