#pragma once

#include <string>

namespace fppg
{

/// Opens a plugin of the program: a library that needs others, whose loading would cost every start
/// of the program time (HDF5: 7.7 ms), and that the system may lack. Looked for in the folder that
/// FPPG_PLUGINS of the environment names, beside the program or the shared library that this code
/// is in, and where `install` puts it.
///
/// file      e.g. "libfppg_hdf5.so"
/// symbol    the function to be called
/// purpose   for the error, e.g. "STEP files are read by it; it is built where OpenCASCADE is"
/// returns   the address of the function
/// throws    IoError if there is no such plugin, or it cannot be opened
void* plugin_function(const std::string& file, const char* symbol, const std::string& purpose);

} // namespace fppg
