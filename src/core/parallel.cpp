// Most loops of a case last less than a millisecond, and other programs use the machine too. So a
// loop never waits for a helper that has not come yet: the caller starts at once and takes chunks
// until none is left; helpers that the system wakes in time take theirs, others find nothing to do.
// Helpers that wait sleep. (A team of OpenMP meets at a barrier, where its threads wait actively:
// on a busy machine each short loop then costs a time slice of the scheduler.)

#include "core/parallel.h"

#include <signal.h>
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <system_error>
#include <thread>
#include <vector>

namespace fppg
{

namespace
{

/// A loop while it runs. `places` and `working` are guarded by the mutex of the helpers.
struct Job
{
    const ChunkedLoop& loop;
    std::size_t places = 0;  ///< helpers that may still join
    std::size_t working = 0; ///< helpers that have joined and not left
    std::atomic<std::size_t> next{0};

    void work()
    {
        for (std::size_t i = next.fetch_add(loop.chunk); i < loop.n; i = next.fetch_add(loop.chunk))
            loop.run(loop.body, i, std::min(loop.n, i + loop.chunk));
    }
};

class Helpers
{
public:
    ~Helpers()
    {
        {
            const std::lock_guard lock(guard_);
            is_ending_ = true;
        }
        wake_.notify_all();
        for (std::thread& t : threads_) t.join();
    }

    /// False if a loop is running: nothing was done then.
    bool run(const ChunkedLoop& loop, std::size_t helpers)
    {
        const std::unique_lock alone(one_loop_, std::try_to_lock);
        if (!alone.owns_lock()) return false;
        Job job{loop, grow_to(helpers)};
        const std::size_t called = job.places;
        {
            const std::lock_guard lock(guard_);
            job_ = &job;
        }
        for (std::size_t i = 0; i < called; ++i) wake_.notify_one();
        job.work();
        std::unique_lock lock(guard_);
        job_ = nullptr;
        done_.wait(lock, [&] { return job.working == 0; });
        return true;
    }

private:
    /// Helpers take no signals: those are for the threads of the program, which may have blocked
    /// them.
    std::size_t grow_to(std::size_t wanted)
    {
        sigset_t all;
        sigset_t before;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        try
        {
            while (threads_.size() < wanted) threads_.emplace_back([this] { help(); });
        }
        catch (const std::system_error&)
        {
            // Fewer threads give the same result, later.
        }
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
        return std::min(wanted, threads_.size());
    }

    void help();

    std::mutex one_loop_; ///< held by the caller for the length of its loop
    std::mutex guard_;
    std::condition_variable wake_;
    std::condition_variable done_;
    Job* job_ = nullptr;
    bool is_ending_ = false;
    std::vector<std::thread> threads_;
};

/// Whether this thread works on a loop.
thread_local bool is_in_loop = false;

void Helpers::help()
{
    is_in_loop = true;
    std::unique_lock lock(guard_);
    for (;;)
    {
        wake_.wait(lock, [this] { return is_ending_ || (job_ != nullptr && job_->places > 0); });
        if (is_ending_) return;
        Job& job = *job_;
        --job.places;
        ++job.working;
        lock.unlock();
        job.work();
        lock.lock();
        job.places = 0;
        if (--job.working == 0) done_.notify_one();
    }
}

Helpers& helpers()
{
    static Helpers all;
    return all;
}

} // namespace

void run_chunks(const ChunkedLoop& loop, int threads)
{
    const std::size_t chunks = (loop.n + loop.chunk - 1) / loop.chunk;
    const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(threads, 1)), chunks);
    if (wanted > 1 && !is_in_loop)
    {
        is_in_loop = true;
        const bool is_done = helpers().run(loop, wanted - 1);
        is_in_loop = false;
        if (is_done) return;
    }
    loop.run(loop.body, 0, loop.n);
}

} // namespace fppg
