#include "core/parallel.h"

#include "core/signals_blocked.h"

#include <omp.h>

#include <algorithm>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace fppg
{
namespace
{

/// The thread sanitizer does not see the barriers of GCC's OpenMP runtime: these tell it that a
/// team starts after what its caller did, and the caller goes on after what the team did.
void release_to_others([[maybe_unused]] const ChunkedLoop& loop)
{
#ifdef __SANITIZE_THREAD__
    __tsan_release(loop.body);
#endif
}

void acquire_from_others([[maybe_unused]] const ChunkedLoop& loop)
{
#ifdef __SANITIZE_THREAD__
    __tsan_acquire(loop.body);
#endif
}

/// OpenMP keeps the threads of a team for the next loop of the same caller.
void start_team(int threads)
{
    thread_local int started = 1;
    if (threads <= started) return;
    // Signals are for the threads of the program, which may wait for them.
    const SignalsBlocked blocked;
    // GCC leaves an empty region out, and the team would start later, with signals.
#pragma omp parallel num_threads(threads)
    {
        [[maybe_unused]] const volatile int member = omp_get_thread_num();
    }
    started = threads;
}

} // namespace

void run_chunks(const ChunkedLoop& loop, int threads)
{
    const std::size_t chunks = (loop.n + loop.chunk - 1) / loop.chunk;
    const auto team =
        static_cast<int>(std::min(static_cast<std::size_t>(std::max(threads, 1)), chunks));
    if (team <= 1 || omp_in_parallel() != 0)
    {
        loop.run(loop.body, 0, loop.n);
        return;
    }
    start_team(team);
    release_to_others(loop);
#pragma omp parallel for num_threads(team) schedule(dynamic, 1)
    for (std::size_t c = 0; c < chunks; ++c)
    {
        acquire_from_others(loop);
        loop.run(loop.body, c * loop.chunk, std::min(loop.n, (c + 1) * loop.chunk));
        release_to_others(loop);
    }
    acquire_from_others(loop);
}

} // namespace fppg
