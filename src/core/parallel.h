#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>

namespace fppg
{

/// A loop cut into chunks. run(body, begin, end) works through the indices [begin, end) and does
/// not throw.
struct ChunkedLoop
{
    std::size_t n = 0;
    std::size_t chunk = 1;
    void* body = nullptr;
    void (*run)(void* body, std::size_t begin, std::size_t end) = nullptr;
};

/// Runs all chunks of a loop on a team of up to `threads` threads of OpenMP, which keeps them for
/// the next loop. Returns when all chunks are done. A loop inside a loop runs on its caller alone.
/// OMP_NUM_THREADS, OMP_PROC_BIND and OMP_WAIT_POLICY count.
void run_chunks(const ChunkedLoop& loop, int threads);

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
    struct Guarded
    {
        const Body& body;
        std::mutex guard;
        std::size_t first_index = SIZE_MAX;
        std::exception_ptr first_error;

        void call(std::size_t i)
        {
            try
            {
                body(i);
            }
            catch (...)
            {
                const std::lock_guard lock(guard);
                if (i >= first_index) return;
                first_index = i;
                first_error = std::current_exception();
            }
        }
    };
    Guarded guarded{body, {}, SIZE_MAX, {}};
    ChunkedLoop loop;
    loop.n = n;
    loop.chunk = chunk;
    loop.body = &guarded;
    loop.run = [](void* at, std::size_t begin, std::size_t end)
    {
        auto& all = *static_cast<Guarded*>(at);
        for (std::size_t i = begin; i < end; ++i) all.call(i);
    };
    run_chunks(loop, threads);
    if (guarded.first_error) std::rethrow_exception(guarded.first_error);
}

} // namespace fppg
