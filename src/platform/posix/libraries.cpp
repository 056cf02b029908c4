#include "platform/libraries.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <filesystem>

namespace fppg
{

std::string own_folder()
{
    Dl_info image = {};
    if (::dladdr(reinterpret_cast<void*>(&own_folder), &image) == 0 || !image.dli_fname) return {};
    std::error_code failed;
    return std::filesystem::canonical(image.dli_fname, failed).parent_path().string();
}

void* open_library(const std::string& path)
{
    return ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
}

void* library_symbol(void* library, const char* name)
{
    return ::dlsym(library != nullptr ? library : RTLD_DEFAULT, name);
}

std::string library_error()
{
    const char* text = ::dlerror();
    return text != nullptr ? text : "";
}

SystemLibrary c_library()
{
    return {"glibc", ::gnu_get_libc_version(), fmt::format("{}.{}", __GLIBC__, __GLIBC_MINOR__)};
}

} // namespace fppg
