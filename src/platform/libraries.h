#pragma once

#include <string>

namespace fppg
{

/// The folder of the program or of the shared library that this code is in; empty where the system
/// does not say.
std::string own_folder();

/// Opens a shared library.
///
/// returns  what library_symbol() takes, or nullptr; library_error() says why
void* open_library(const std::string& path);

/// The address of what a library has under a name, or nullptr; without a library, of what any one
/// that is loaded has.
void* library_symbol(void* library, const char* name);

std::string library_error();

/// Name, version as loaded and version as built of the library of C.
struct SystemLibrary
{
    std::string name;
    std::string loaded;
    std::string built;
};
SystemLibrary c_library();

} // namespace fppg
