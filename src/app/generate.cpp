#include "fppg/generate.h"

#include "fppg/error.h"

#include "app/case_stages.h"
#include "app/save_result.h"
#include "app/threads.h"
#include "files/output_lock.h"

#include <filesystem>

namespace fppg
{

namespace fs = std::filesystem;

struct GeneratedCase::State
{
    CaseRunState run;
    MadeCase made;
};

GeneratedCase::GeneratedCase() : state_(std::make_unique<State>()) {}
GeneratedCase::~GeneratedCase() = default;
GeneratedCase::GeneratedCase(GeneratedCase&&) noexcept = default;
GeneratedCase& GeneratedCase::operator=(GeneratedCase&&) noexcept = default;

const CaseDef& GeneratedCase::def() const
{
    return state_->made.def;
}

const CaseParticles& GeneratedCase::particles() const
{
    return state_->made.particles;
}

const CaseConstants& GeneratedCase::constants() const
{
    return state_->made.constants;
}

const std::vector<std::string>& GeneratedCase::warnings() const
{
    return state_->run.warnings;
}

std::vector<std::string> GeneratedCase::save(const std::string& output,
                                             const std::vector<std::string>& to)
{
    CaseRunState& run = state_->run;
    for (const std::string& name : to) (void)find_particle_format(name, output);
    const fs::path folder = fs::path(output).parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw IoError(folder.string() + ": cannot create the folder: " + error.message());
    run.options.output = output;
    run.options.to = to;
    state_->made.output = output;
    state_->made.def.case_name = fs::path(output).filename().string();
    const OutputLock lock(output);
    run.files.clear();
    save_result(run, state_->made);
    std::vector<std::string> names = run.files.names();
    run.files.commit(false);
    return names;
}

GeneratedCase generate_case(const std::string& definition, const GenerateOptions& options)
{
    GeneratedCase out;
    CaseRunState& run = out.state_->run;
    run.options.input = definition;
    if (definition.ends_with(".xml")) run.options.input.resize(definition.size() - 4);
    run.options.output = run.options.input;
    run.options.dp = options.dp;
    run.options.evars = options.vars;
    run.options.fit = options.fit;
    run.options.strict = options.strict;
    run.options.save_cells = false;
    run.options.save_off_lattice_points = false;
    run.threads = options.threads > 0 ? options.threads : default_threads();
    run.log = RunLog(LogStyle::None);
    run.on_progress = options.on_progress;
    read_definition(run, 0, nullptr, out.state_->made);
    if (out.def().vres.is_active())
        throw CaseError(out.def().file, out.def().vres.zones[0].line,
                        "<vres>: regions of other resolution are made by the program only");
    make_particles_of_case(run, out.state_->made);
    run.files.clear(); // pictures of the relaxation
    run.on_progress = nullptr;
    return out;
}

} // namespace fppg
