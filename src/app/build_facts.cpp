#include "app/build_facts.h"

#include "meshes/embree.h"
#include "platform/libraries.h"

#include <fmt/format.h>
#include <png.h>
#include <tinyxml2.h>
#include <zlib.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <string_view>

namespace fppg
{

extern const char* const build_commit; ///< of tools/cmake/build_facts.cmake

namespace
{

std::string library(std::string_view name, const std::string& loaded, const std::string& built)
{
    return fmt::format("  {:<14}{}{}\n", name, loaded,
                       loaded == built || built.empty() ? "" : " (built with " + built + ")");
}

std::string numbers(long long major, long long minor, long long patch)
{
    return fmt::format("{}.{}.{}", major, minor, patch);
}

/// Embree brings it.
std::string tbb_version()
{
    using Version = const char* (*)();
    // The system gives functions as pointers to data.
    const auto version = reinterpret_cast<Version>(library_symbol(nullptr, "TBB_runtime_version"));
    return version != nullptr ? version() : "";
}

std::string compiler()
{
#ifdef __clang__
    return __VERSION__;
#else
    return "GCC " __VERSION__;
#endif
}

std::string embree_version()
{
    const RTCDevice device = new_embree_device(1);
    const auto part = [&](RTCDeviceProperty property)
    { return static_cast<long long>(rtcGetDeviceProperty(device, property)); };
    std::string out =
        numbers(part(RTC_DEVICE_PROPERTY_VERSION_MAJOR), part(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                part(RTC_DEVICE_PROPERTY_VERSION_PATCH));
    rtcReleaseDevice(device);
    return out;
}

} // namespace

std::string build_facts()
{
    std::string out = fmt::format("commit {}, built by {} for C++{}, OpenMP {}\n", build_commit,
                                  compiler(), __cplusplus / 100 % 100, _OPENMP);
    out += "libraries:\n";
    const SystemLibrary c = c_library();
    out += library(c.name, c.loaded, c.built);
    out += library("libstdc++", fmt::format("{}", __GLIBCXX__), "");
    out += library("fmt", numbers(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100),
                   "");
    out += library("tinyxml2",
                   numbers(TIXML2_MAJOR_VERSION, TIXML2_MINOR_VERSION, TIXML2_PATCH_VERSION), "");
    out += library("embree", embree_version(), RTC_VERSION_STRING);
    if (const std::string tbb = tbb_version(); !tbb.empty()) out += library("tbb", tbb, "");
    out += library("libpng", ::png_get_libpng_ver(nullptr), PNG_LIBPNG_VER_STRING);
    out += library("zlib", ::zlibVersion(), ZLIB_VERSION);
    out += library("CLI11", CLI11_VERSION, "");
    out += library("nlohmann_json",
                   numbers(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                           NLOHMANN_JSON_VERSION_PATCH),
                   "");
#ifdef FPPG_HDF5_VERSION
    out += library("hdf5", FPPG_HDF5_VERSION " (in a module, loaded where it is needed)", "");
#endif
    return out;
}

} // namespace fppg
