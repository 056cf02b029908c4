#pragma once

#include "batch/record.h"
#include "batch/sweep.h"

#include <string>
#include <vector>

namespace fppg
{

/// How many runs are in which state.
struct BatchCounts
{
    std::size_t done = 0; ///< with those done before
    std::size_t reused = 0;
    std::size_t failed = 0; ///< with those refused
    std::size_t open = 0;   ///< stopped or waiting
};

BatchCounts count_states(const std::vector<RunRecord>& records);

/// Writes summary.csv, summary.json and report.html into a folder. report.html needs no other file:
/// pictures are inside it.
///
/// records  one per run
/// throws   IoError
void write_summary(const std::string& folder, const std::vector<BatchRun>& runs,
                   const std::vector<RunRecord>& records);

} // namespace fppg
