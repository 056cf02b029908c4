#pragma once

#include "batch/record.h"
#include "batch/sweep.h"

#include <chrono>
#include <cstddef>
#include <string>

namespace fppg
{

enum class ProgressStyle : std::uint8_t
{
    Bar,   ///< one line on a terminal that is drawn anew
    Lines, ///< a line a run
    Json,  ///< a JSON object a line
    Quiet, ///< nothing
};

/// Shows how far a batch is: a bar goes to standard error, lines to standard output.
class Progress
{
public:
    Progress(ProgressStyle style, std::size_t runs) : style_(style), runs_(runs) {}
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void estimated(const BatchRun& run, const RunRecord& record) const;
    void started(const BatchRun& run) const;
    void finished(const BatchRun& run, const RunRecord& record);
    /// running  children at work
    /// done     of the estimated time of all runs, 0 to 1
    void tick(std::size_t running, double done);

private:
    double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    void clear_bar();

    ProgressStyle style_;
    std::size_t runs_;
    std::size_t finished_ = 0;
    std::size_t failed_ = 0;
    double drawn_at_ = -1;
    bool has_bar_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace fppg
