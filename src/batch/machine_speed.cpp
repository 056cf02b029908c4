#include "batch/machine_speed.h"

#include "fppg/error.h"
#include "fppg/files.h"

#include "core/json.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

/// Empty where the environment names no folder for settings.
fs::path file_of_speed()
{
    struct Place
    {
        const char* variable;
        const char* below;
    };
    for (const Place& place :
         {Place{"XDG_CONFIG_HOME", ""}, Place{"HOME", ".config"}, Place{"APPDATA", ""}})
        if (const char* folder = std::getenv(place.variable); folder != nullptr && *folder != 0)
            return fs::path(folder) / place.below / "fppg" / "speed.json";
    return {};
}

} // namespace

MachineSpeed read_machine_speed()
{
    const fs::path path = file_of_speed();
    std::ifstream in(path);
    if (path.empty() || !in) return {};
    try
    {
        double factor = 0;
        Json::parse(in).at("factor").get_to(factor);
        if (factor > 0 && std::isfinite(factor)) return {factor, path.string()};
    }
    catch (const JsonError&)
    {
        // A file of another program, or cut short: as if it were not there.
    }
    return {};
}

MachineSpeed keep_machine_speed(double factor)
{
    const fs::path path = file_of_speed();
    if (path.empty()) throw IoError("no folder for settings is known: set XDG_CONFIG_HOME or HOME");
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    OutputFile file(path.string());
    file.append(Json{{"factor", factor}}.text(2) + "\n");
    file.commit();
    return {factor, path.string()};
}

} // namespace fppg
