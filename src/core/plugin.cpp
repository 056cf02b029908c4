#include "core/plugin.h"

#include "fppg/error.h"
#include "platform/libraries.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace fppg
{

namespace
{

namespace fs = std::filesystem;

std::vector<fs::path> plugin_folders()
{
    std::vector<fs::path> folders;
    if (const char* named = std::getenv("FPPG_PLUGINS")) folders.emplace_back(named);
    // The program is in bin, the Python module in lib/python3/dist-packages/fppg.
    if (const fs::path own(own_folder()); !own.empty())
        for (const char* way : {".", "../" FPPG_LIBRARIES, "../../../../" FPPG_LIBRARIES})
            folders.push_back((own / way).lexically_normal());
    folders.emplace_back(FPPG_PLUGIN_FOLDER);
    return folders;
}

} // namespace

void* plugin_function(const std::string& file, const char* symbol, const std::string& purpose)
{
    std::vector<std::string> looked_at;
    for (const fs::path& folder : plugin_folders())
    {
        const fs::path path = folder / file;
        std::error_code failed;
        if (!fs::exists(path, failed))
        {
            looked_at.push_back(folder.string());
            continue;
        }
        void* const plugin = open_library(path.string());
        void* const entry = plugin ? library_symbol(plugin, symbol) : nullptr;
        if (entry) return entry;
        throw IoError(fmt::format("cannot open the plugin {}: {}", path.string(), library_error()));
    }
    throw IoError(fmt::format("there is no plugin {} in {}: {}", file, fmt::join(looked_at, " or "),
                              purpose));
}

} // namespace fppg
