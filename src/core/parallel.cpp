#include "core/parallel.h"

#include "fppg/error.h"
#include "platform/signals_blocked.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

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

/// GCC's runtime ends the program where it cannot start a thread. So others are started first, all
/// at a time; the team takes their place.
///
/// throws  IoError that says how many there can be
void expect_threads(int threads)
{
    std::vector<std::thread> others;
    // Not std::latch: that of GCC 12 can miss its last count where the system has no futex, as
    // Windows, and the program would wait without end.
    std::mutex until_all_tried;
    std::unique_lock<std::mutex> trying(until_all_tried);
    int why = 0;
    try
    {
        others.reserve(static_cast<std::size_t>(threads - 1));
        for (int i = 1; i < threads; ++i)
            others.emplace_back([&] { const std::lock_guard<std::mutex> wait(until_all_tried); });
    }
    catch (const std::system_error& error)
    {
        why = error.code().value();
    }
    catch (const std::bad_alloc&)
    {
        why = ENOMEM;
    }
    trying.unlock();
    for (std::thread& other : others) other.join();
    if (why != 0)
        throw IoError(
            fmt::format("only {} of {} threads can be started here ({}), as processes or "
                        "memory are limited; -threads:{} needs no more",
                        others.size() + 1, threads, std::strerror(why), others.size() + 1));
}

/// OpenMP keeps the threads of a team for the next loop of the same caller.
void start_team(int threads)
{
    thread_local int started = 1;
    if (threads <= started) return;
    // Signals are for the threads of the program, which may wait for them.
    const SignalsBlocked blocked;
    expect_threads(threads);
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
