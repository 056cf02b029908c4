#include "batch/machine_speed.h"

#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/fit_mesh.h"

#include "core/json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

namespace fppg
{
namespace
{

namespace fs = std::filesystem;

/// Processor seconds of the ball on the machine of rates.h.
constexpr double reference_seconds = 0.232;

/// Of radius 1; rows of quads, cut in two.
TriangleSoup ball()
{
    constexpr int rows = 32;
    const auto at = [](int i, int j)
    {
        const double polar = std::numbers::pi * i / rows;
        const double around = std::numbers::pi * (j % (2 * rows)) / rows;
        return Vec3{std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                    std::cos(polar)};
    };
    TriangleSoup soup;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 2 * rows; ++j)
        {
            if (i + 1 < rows)
                soup.vertices.insert(soup.vertices.end(),
                                     {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            if (i > 0)
                soup.vertices.insert(soup.vertices.end(),
                                     {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return soup;
}

double seconds_of_ball()
{
    FitMeshOptions options;
    options.dp = 0.014; // 64,000 particles
    const std::clock_t begin = std::clock();
    fit_mesh(ball(), options);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

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

MachineSpeed calibrate_speed()
{
    const fs::path path = file_of_speed();
    if (path.empty())
        throw IoError("estimate: no folder for settings is known: set XDG_CONFIG_HOME or HOME");
    double seconds = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 3; ++run) seconds = std::min(seconds, seconds_of_ball());
    const double factor = seconds / reference_seconds;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    OutputFile file(path.string());
    file.append(Json{{"factor", factor}, {"seconds", seconds}}.text(2) + "\n");
    file.commit();
    return {factor, path.string()};
}

} // namespace fppg
