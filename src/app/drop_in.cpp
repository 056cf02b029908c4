#include "app/drop_in.h"

#include "fppg/error.h"
#include "fppg/version.h"

#include "app/build_facts.h"
#include "app/case_stages.h"
#include "app/particle_log.h"
#include "app/save_result.h"
#include "app/templates_command.h"
#include "app/threads.h"
#include "batch/rates.h"
#include "files/output_lock.h"
#include "platform/files.h"
#include "platform/memory.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

void prepare_folder(const DropInOptions& options)
{
    const fs::path folder = fs::path(options.output).parent_path();
    if (folder.empty() || fs::is_directory(folder)) return;
    if (!options.create_folders)
        throw IoError(fmt::format("{}: the folder does not exist (and -createdirs:0 is given)",
                                  folder.string()));
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw IoError(
            fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
}

/// In the files that a run writes; those that not every particle has do not count.
double bytes_of_particle(const DropInOptions& options)
{
    double bytes = options.save_bi4 ? rates.bi4_bytes : 0;
    if (options.save_all) bytes += rates.vtk_bytes;
    if (options.save_bound && options.save_fluid) bytes += rates.vtk_bytes;
    return bytes;
}

/// What a zone of a case with `<vres>` takes from those made before it.
void take_from_others(const std::vector<ZoneSummary>& zones, const VresDef& vres, CaseDef& def)
{
    def.main_hswl = zones[0].constants.hswl;
    if (def.constants.rhop_gradient == 3 && zones[0].counts[0] > 0)
        def.main_surface = zones[0].constants.surface;
    def.particles_around = zones[static_cast<std::size_t>(vres.zones[zones.size()].parent)].limits;
}

/// A case, or its next zone, from the definition to the files.
///
/// vres   of all zones; null for a case without and for zone 0
/// zones  those made before; this one is added
void make_case(CaseRunState& run, const VresDef* vres, std::vector<ZoneSummary>& zones,
               MadeCase& made)
{
    read_definition(run, zones.size(), vres, made);
    if (vres != nullptr) take_from_others(zones, *vres, made.def);
    make_particles_of_case(run, made);
    save_result(run, made);
    if (made.def.vres.is_active())
        zones.push_back(summary_of_zone(made.def, made.particles, made.constants));
}

/// Each zone of a case with `<vres>` is a case of its own.
void make_zones(CaseRunState& run, MadeCase& made)
{
    std::vector<ZoneSummary> zones;
    make_case(run, nullptr, zones, made);
    if (!made.def.vres.is_active()) return;
    const VresDef vres = made.def.vres;
    while (zones.size() < vres.zones.size())
    {
        run.log.line();
        run.log.line(std::string(72, '#'));
        make_case(run, &vres, zones, made);
    }
    save_zones(run, vres);
    log_zones(zones, run.log);
}

void print_warnings(CaseRunState& run)
{
    if (run.warnings.empty()) return;
    run.log.line("[WARNINGS]");
    for (std::size_t i = 0; i < run.warnings.size(); ++i)
        run.log.line(fmt::format("{}. {}", i + 1, run.warnings[i]));
    run.log.line();
}

/// What went wrong goes into Case.out, unless one of an older run stands beside older results.
void write_failed_log(CaseRunState& run, const std::exception& error)
{
    const std::string path = run.options.output + ".out";
    std::error_code ignored;
    if (fs::exists(path, ignored)) return;
    run.files.clear();
    try
    {
        const auto* known = dynamic_cast<const Error*>(&error);
        run.files.add(path).append(with_line_ends(
            fmt::format("{}\n*** Error: {}\n\nFinished execution (code={}).\n", run.log.text(),
                        error.what(), known != nullptr ? known->exit_code() : 5)));
        run.files.commit(false);
    }
    catch (const std::exception&)
    {
        // The folder cannot be written: the error itself is what the user has to see.
    }
    run.files.clear();
}

int run_case(const DropInOptions& options)
{
    const Stopwatch total;
    CaseRunState run;
    run.options = options;
    run.threads = options.threads > 0 ? options.threads : default_threads();
    if (options.memory_gb > 0)
        limit_memory(static_cast<std::uint64_t>(options.memory_gb * 1e9), run.threads);
    run.log = RunLog(options.log_json   ? LogStyle::Json
                     : options.is_quiet ? LogStyle::Quiet
                                        : LogStyle::Text);
    RunLog& log = run.log;
    MadeCase made;
    log.line(full_name());
    log.line(std::string(full_name().size(), '='));
    log.line(fmt::format("OmpThreads: {}", run.threads));
    std::optional<OutputLock> lock;
    try
    {
        if (options.save_nothing)
            run.files.write_none();
        else
        {
            prepare_folder(options);
            lock.emplace(options.output);
            run.limit = limit_of_disk(fs::path(options.output).parent_path().string(),
                                      bytes_of_particle(options));
        }
        make_zones(run, made);
    }
    catch (const std::exception& error)
    {
        if (lock) write_failed_log(run, error);
        throw;
    }
    print_warnings(run);
    log.line(
        fmt::format("Time of execution: {:.3f} sec. ({} threads)", total.seconds(), run.threads));
    log.line();
    log.line("Finished execution (code=0).");
    run.files.add(options.output + ".out").append(with_line_ends(log.text()));
    expect_printed();
    run.files.commit(options.save_three_vtk);
    const CaseParticles& particles = made.particles;
    log.finished(total.seconds(), {{"particles", particles.np},
                                   {"fixed", particles.n_fixed},
                                   {"moving", particles.n_moving},
                                   {"floating", particles.n_floating},
                                   {"fluid", particles.n_fluid}});
    return 0;
}

void print_info()
{
    fmt::print(
        "{{ \"ShortName\" : \"GenCase\", \"FullName\" : \"{}\", \"Version\" : \"v{}\", \"Date\" : "
        "\"21-11-2026\", "
        "\"Features\" : {{ \"MaximumMkValues\" : 65000 }} }}\n",
        full_name(), version);
}

int write_clean_copy(const DropInOptions& options)
{
    const Element document = read_definition_tree(options.input + ".xml");
    OutputFile file(options.output + ".xml");
    file.append(with_line_ends(print_document(document)));
    file.commit();
    fmt::print("{}\n{}.xml\nFinished execution (code=0).\n", full_name(), options.output);
    return 0;
}

} // namespace

int run_drop_in(const DropInOptions& options)
{
    switch (options.action)
    {
        case DropInOptions::Action::Help:
            fmt::print("{}", help_text());
            return 0;
        case DropInOptions::Action::Version:
            fmt::print("{}\n{}", full_name(), build_facts());
            return 0;
        case DropInOptions::Action::Info:
            print_info();
            return 0;
        case DropInOptions::Action::Templates:
            fmt::print("{}\n", full_name());
            write_templates(options.output, options.overwrite);
            return 0;
        case DropInOptions::Action::Clean:
            return write_clean_copy(options);
        case DropInOptions::Action::Run:
            break;
    }
    return run_case(options);
}

} // namespace fppg
