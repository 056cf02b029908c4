#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace
{

using fppg::parallel_for;

TEST(ParallelFor, CallsEveryIndexOnceForAnyNumberOfThreads)
{
    for (const int threads : {-1, 0, 1, 2, 3, 8})
        for (const std::size_t n :
             {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{1000}})
            for (const std::size_t chunk : {std::size_t{1}, std::size_t{3}, std::size_t{16}})
            {
                std::vector<std::atomic<int>> calls(n);
                parallel_for(
                    n, threads, [&](std::size_t i) { ++calls[i]; }, chunk);
                for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(calls[i], 1) << i << " of " << n;
            }
}

TEST(ParallelFor, ManyShortLoopsFollowOneAnother)
{
    std::vector<std::size_t> sums(64, 0);
    for (int repetition = 0; repetition < 5000; ++repetition)
        parallel_for(sums.size(), 4, [&](std::size_t i) { sums[i] += i; });
    for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_EQ(sums[i], 5000 * i);
}

TEST(ParallelFor, ThrowsTheExceptionOfTheLowestIndexThatFailed)
{
    for (const int threads : {1, 2, 5})
    {
        std::string message;
        try
        {
            parallel_for(1000, threads,
                         [](std::size_t i)
                         {
                             if (i >= 300 && i % 7 == 0)
                                 throw std::runtime_error(std::to_string(i));
                         });
        }
        catch (const std::runtime_error& error)
        {
            message = error.what();
        }
        EXPECT_EQ(message, "301");
    }
}

TEST(ParallelFor, ALoopInsideALoopEnds)
{
    std::atomic<int> calls = 0;
    parallel_for(20, 3, [&](std::size_t) { parallel_for(30, 3, [&](std::size_t) { ++calls; }); });
    EXPECT_EQ(calls, 600);
}

TEST(ParallelFor, SeveralThreadsMayStartLoopsAtTheSameTime)
{
    std::atomic<int> calls = 0;
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 4; ++caller)
        callers.emplace_back(
            [&]
            {
                for (int repetition = 0; repetition < 100; ++repetition)
                    parallel_for(50, 3, [&](std::size_t) { ++calls; });
            });
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(calls, 4 * 100 * 50);
}

} // namespace
