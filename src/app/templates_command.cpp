#include "app/templates_command.h"

#include "fppg/error.h"
#include "fppg/files.h"
#include "platform/regular_file.h"

#include "app/subcommand_line.h"
#include "app/template_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

bool has_bytes(const fs::path& file, std::string_view bytes)
{
    expect_regular_file(file.string());
    std::ifstream in(std::filesystem::path(file), std::ios::binary);
    const std::string found((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    return found == bytes;
}

} // namespace

void write_templates(const std::string& folder, bool overwrite)
{
    std::size_t written = 0;
    std::size_t equal = 0;
    std::vector<std::string_view> kept;
    for (const TemplateFile& file : template_files())
    {
        const fs::path path = fs::path(folder) / file.path;
        if (fs::exists(path) && !fs::is_directory(path))
        {
            if (has_bytes(path, file.bytes))
            {
                ++equal;
                continue;
            }
            if (!overwrite)
            {
                kept.push_back(file.path);
                continue;
            }
        }
        std::error_code error;
        fs::create_directories(path.parent_path(), error);
        if (error)
            throw IoError(fmt::format("{}: cannot make the folder: {}", path.parent_path().string(),
                                      error.message()));
        OutputFile out(path.string());
        out.append(file.bytes.data(), file.bytes.size());
        out.commit();
        ++written;
    }
    fmt::print("{} files written to {}", written, folder);
    if (equal > 0) fmt::print(", {} were there already", equal);
    fmt::print(".\n");
    if (!kept.empty())
        fmt::print(
            "{} files that differ were left as they are (--overwrite replaces them):\n  {}\n",
            kept.size(), fmt::join(kept, "\n  "));
    fmt::print(
        "README.md lists the templates; fppg.xsd is the schema that checks a case:\n"
        "  xmllint --noout --schema fppg.xsd MyCase_Def.xml\n");
}

int run_templates(const std::vector<std::string>& arguments)
{
    SubcommandLine app(
        "Writes case templates, one per feature, the files that they read and a schema that checks "
        "cases",
        "fppg templates");
    std::string folder;
    bool overwrite = false;
    app.add_option("folder", folder, "target folder; created if it is missing").required();
    app.add_flag("--overwrite", overwrite, "replace files that exist and differ");
    if (!app.read(arguments)) return 0;
    write_templates(folder, overwrite);
    return 0;
}

} // namespace fppg
