#include "platform/libraries.h"

#include "platform/processes.h"
#include "platform/windows/errors.h"

#include <filesystem>

namespace fppg
{

std::string own_folder()
{
    // Libraries of this code are static here: it is in the program.
    return std::filesystem::path(program_path()).parent_path().string();
}

void* open_library(const std::string& path)
{
    return reinterpret_cast<void*>(::LoadLibraryW(wide(path).c_str()));
}

void* library_symbol(void* library, const char* name)
{
    const HMODULE module =
        library != nullptr ? static_cast<HMODULE>(library) : ::GetModuleHandleW(nullptr);
    return reinterpret_cast<void*>(::GetProcAddress(module, name));
}

std::string library_error()
{
    return windows_text(::GetLastError());
}

SystemLibrary c_library()
{
    const std::string built =
        std::to_string(__MINGW64_VERSION_MAJOR) + "." + std::to_string(__MINGW64_VERSION_MINOR);
    return {"mingw-w64", built, built};
}

} // namespace fppg
