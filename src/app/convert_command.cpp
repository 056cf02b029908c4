#include "app/convert_command.h"

#include "fppg/convert.h"
#include "fppg/error.h"

#include "app/result_files.h"
#include "app/subcommand_line.h"
#include "app/threads.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

namespace
{

struct ConvertCall
{
    std::string case_name;
    std::string xml;
    std::string output;
    std::string format;
    int threads = 0;
};

std::string format_help()
{
    std::string text = "the format:";
    for (const ParticleFormat& format : particle_formats())
        text += fmt::format("\n{}{}: {}", format.name,
                            *format.ending != '\0' ? fmt::format(" ({})", format.ending) : "",
                            format.what);
    return text + "\nDefault: what the ending of FILE means";
}

/// Reads the arguments; false when only the help was asked for.
bool read_arguments(const std::vector<std::string>& arguments, ConvertCall& call)
{
    SubcommandLine app(
        "Writes the particles of a result, ours or GenCase's, or of an output of the solver for "
        "another code. What its format does not hold is said.",
        "fppg convert");
    app.add_option("CASE", call.case_name,
                   "a case without extension, its .bi4 or .xml, or an output PartXXXX.bi4")
        .required();
    app.add_option("-o,--output", call.output, "the file to write").required();
    app.add_option("--to", call.format, format_help());
    app.add_option("--case-xml", call.xml,
                   "Case.xml of an output of the solver; default: CASENAME.xml beside it or one "
                   "folder above");
    app.add_option("--threads", call.threads, "default 0: what the machine or its scheduler allows")
        .range(0, 4096);
    if (!app.read(arguments)) return false;
    if (call.threads == 0) call.threads = default_threads();
    return true;
}

/// Case.xml and Reload.xml have one ending: nothing that is read is written over.
void expect_other_file(const ConvertCall& call, const std::string& output)
{
    std::string stem = call.case_name;
    if (stem.ends_with(".xml") || stem.ends_with(".bi4")) stem.resize(stem.size() - 4);
    for (const std::string& input : {stem + ".xml", stem + ".bi4", call.xml})
    {
        std::error_code ignored;
        if (std::filesystem::equivalent(input, output, ignored))
            throw UsageError(
                fmt::format("'{}' is a file of the case, expected another name", output));
    }
}

} // namespace

int run_convert(const std::vector<std::string>& arguments)
{
    ConvertCall call;
    if (!read_arguments(arguments, call)) return 0;
    const ParticleFormat& format = find_particle_format(call.format, call.output);
    const ParticleFeed feed = feed_of_file(call.case_name, call.xml);
    ConvertedFiles written = convert_particles(feed, format, call.output, call.threads);
    ResultFiles result;
    for (OutputFile& file : written.files)
    {
        expect_other_file(call, file.path());
        result.take(std::move(file));
    }
    const std::vector<std::string> names = result.names();
    result.commit(false);
    for (const std::string& name : names) fmt::print("{}\n", name);
    fmt::print("{} particles as {}\n", feed.count, format.name);
    for (const std::string& loss : written.losses) fmt::print("Note: {}.\n", loss);
    return 0;
}

} // namespace fppg
