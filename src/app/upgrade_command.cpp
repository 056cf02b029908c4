#include "app/upgrade_command.h"

#include "app/subcommand_line.h"
#include "core/text.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "platform/regular_file.h"
#include "upgrade/upgrade.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

struct UpgradeCall
{
    std::vector<std::string> definitions;
    std::string output;
    bool in_place = false;
};

std::string read_text(const std::string& path)
{
    expect_regular_file(path);
    std::ifstream in(std::filesystem::path(path), std::ios::binary);
    if (!in || fs::is_directory(path))
        throw IoError(
            fmt::format("{}: cannot open the file: {}", path, std::strerror(in ? EISDIR : errno)));
    std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    if (in.bad()) throw IoError(fmt::format("{}: cannot read the file", path));
    return text;
}

void write_text(const std::string& path, const std::string& text)
{
    OutputFile file(path);
    file.append(text);
    file.commit();
}

/// A copy under a name that nothing has yet.
std::string back_up(const std::string& path)
{
    for (int i = 1;; ++i)
    {
        std::string copy = path + (i == 1 ? ".bak" : fmt::format(".bak{}", i));
        if (fs::exists(fs::symlink_status(copy))) continue;
        std::error_code error;
        fs::copy_file(path, copy, error);
        if (error)
            throw IoError(fmt::format("{}: cannot write the file: {}", copy, error.message()));
        return copy;
    }
}

void tell(const std::string& path, const UpgradedDefinition& upgraded)
{
    for (const UpgradeChange& c : upgraded.changes)
        fmt::print("{}:{}: {}  ->  {}\n", path, c.line, c.from, c.to);
    for (const UpgradeNote& n : upgraded.notes)
        fmt::print("{}:{}: note: {}\n", path, n.line, n.text);
    fmt::print("{}: {}", path, counted(upgraded.changes.size(), "change", "changes"));
    if (!upgraded.notes.empty())
        fmt::print(", {}", counted(upgraded.notes.size(), "note", "notes"));
}

void upgrade(const std::string& name, const UpgradeCall& call)
{
    const std::string path =
        name.ends_with(".xml") || !fs::exists(name + ".xml") ? name : name + ".xml";
    const UpgradedDefinition upgraded = upgrade_definition(read_text(path), path);
    tell(path, upgraded);
    if (!call.output.empty())
    {
        write_text(call.output, upgraded.text);
        fmt::print("; written to {}\n", call.output);
    }
    else if (upgraded.changes.empty())
        fmt::print("\n");
    else if (call.in_place)
    {
        const std::string copy = back_up(path);
        // A link stays one, and its file is written.
        const fs::path file = fs::canonical(path);
        const fs::perms permissions = fs::status(file).permissions();
        write_text(file.string(), upgraded.text);
        std::error_code ignored;
        fs::permissions(file, permissions, ignored);
        fmt::print("; written; the old file is {}\n", copy);
    }
    else
        fmt::print("; nothing is written, --in-place or -o FILE does\n");
}

} // namespace

int run_upgrade(const std::vector<std::string>& arguments)
{
    SubcommandLine app(
        "Lists what changes when a case definition is written in the forms of DualSPHysics v5.4, a "
        "line for each change, and writes it with -o or --in-place. Particles, normals and what "
        "v5.4's solver does stay the same; comments and all else in the file stay too. Notes name "
        "what a person has to decide.",
        "fppg upgrade");
    UpgradeCall call;
    app.add_option("DEFINITION", call.definitions, "case definitions, .xml may be left out")
        .required();
    const auto output =
        app.add_option("-o,--output", call.output, "a new file for the upgraded definition");
    app.add_flag("--in-place", call.in_place,
                 "write the definition itself; the old one is kept as .bak, or .bak2, ...")
        .excludes(output);
    if (!app.read(arguments)) return 0;
    if (!call.output.empty() && call.definitions.size() > 1)
        throw UsageError("-o is for one definition; --in-place takes several");
    if (!call.output.empty() && fs::exists(fs::symlink_status(call.output)))
        throw IoError(fmt::format(
            "{}: exists already and is not overwritten; give another name, or --in-place",
            call.output));
    for (const std::string& definition : call.definitions) upgrade(definition, call);
    return 0;
}

} // namespace fppg
