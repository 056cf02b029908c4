#pragma once

#include "fppg/case_def.h"
#include "fppg/files.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/scene.h"

#include "app/command_line.h"
#include "app/result_files.h"
#include "app/run_log.h"
#include "app/stage_bar.h"
#include "app/stopwatch.h"
#include "batch/particle_limit.h"

#include <array>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// What all stages of a run share.
struct CaseRunState
{
    DropInOptions options;
    int threads = 1;
    RunLog log;
    ResultFiles files;
    std::vector<std::string> warnings;
    std::vector<std::string> diagnostics; ///< those that -strict takes for errors
    std::set<std::uint16_t> mks;          ///< absolute, with particles in any zone
    ParticleLimit limit{};                ///< of the files that the run writes
    /// Told of the stage and the share of it that is done, 0 to 1, by the thread that runs the
    /// case. What it throws ends the run.
    std::function<void(const std::string& stage, double share)> on_progress{};
    std::string stage_name{};

    /// Shows how far the stage is.
    void progress(double share, std::string text)
    {
        StageBar::show(share, std::move(text));
        if (on_progress) on_progress(stage_name, share);
    }
    void warn(std::string text)
    {
        log.warning(text);
        warnings.push_back(std::move(text));
    }
    /// A warning where GenCase says nothing; with -strict an error.
    void diagnose(std::string text)
    {
        diagnostics.push_back(text);
        warn(std::move(text));
    }

    /// Runs a stage and writes into the log when it begins and how long it took.
    template <typename Body>
    void stage(const char* name, const Body& body)
    {
        const Stopwatch time;
        log.begin_stage(name);
        stage_name = name;
        if (on_progress) on_progress(stage_name, 0);
        {
            const StageBar bar(name, log.style() == LogStyle::Text);
            body();
        }
        log.end_stage(name, time.seconds());
    }
};

/// A case, or one zone of it, on its way from the definition to the files.
struct MadeCase
{
    std::string output; ///< of its files, without the endings
    CaseDef def;
    Scene scene; ///< of def
    RunField field;
    std::vector<NodeFile> node_files;
    std::vector<MeshFileUse> mesh_files;
    std::string relax_history; ///< CSV
    CaseParticles particles;
    CaseConstants constants;
    std::vector<ShapeFile> shape_files;
    std::vector<ShapePolygons> normal_shapes; ///< that the normals were taken from
};

} // namespace fppg
