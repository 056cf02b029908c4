#pragma once

#include "batch/sweep.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

enum class RunState : std::uint8_t
{
    Waiting, ///< not begun
    Done,
    Failed,
    Refused, ///< needs more memory than the batch may use
    Stopped, ///< before its end
};

/// "waiting", "done", "failed", "refused", "stopped".
const char* name_of(RunState state);

/// What is known of a run, kept as JSON beside its result (`<output>.batch.json`).
struct RunRecord
{
    RunState state = RunState::Waiting;
    bool is_reused = false; ///< done by an earlier batch; not stored
    std::string program;    ///< version, and hash of the program's file
    std::vector<std::string> options;
    std::vector<std::pair<std::string, std::string>> inputs;    ///< absolute path, content_hash()
    std::vector<std::pair<std::string, std::uint64_t>> outputs; ///< name in its folder, bytes
    std::string picture;                                        ///< likewise; empty: none

    std::uint64_t np = 0;
    std::uint64_t n_fixed = 0;
    std::uint64_t n_moving = 0;
    std::uint64_t n_floating = 0;
    std::uint64_t n_fluid = 0;
    double seconds = 0;
    double memory_bytes = 0; ///< at its peak
    double estimated_seconds = 0;
    double estimated_memory_bytes = 0;
    int exit_code = 0;
    std::vector<std::string> warnings;
    std::string error;
};

/// The version and the content of this program, for RunRecord::program.
std::string program_identity();

std::string record_path(const BatchRun& run);

/// What the report shows of a run besides its picture (read_look()).
std::string look_path(const BatchRun& run);

/// throws IoError
void write_record(const BatchRun& run, const RunRecord& record);

/// The record of a run; a waiting one where there is none or it cannot be read.
RunRecord read_record(const BatchRun& run);

/// Whether a run needs not be done again: it was done by this program with the same options, its
/// inputs have the same content, and its outputs are there with their sizes.
bool is_current(const BatchRun& run, const RunRecord& record, const std::string& program);

/// The files in the folder of a result that belong to it, without those of the batch.
std::vector<std::pair<std::string, std::uint64_t>> list_outputs(const BatchRun& run);

/// Takes counts, warnings and the error out of what a run printed.
void read_printed(const std::string& text, RunRecord& record);

} // namespace fppg
