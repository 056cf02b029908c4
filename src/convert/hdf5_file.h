#pragma once

#include "convert/columns.h"

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fppg
{

/// A number or a text of a group or a dataset.
struct Hdf5Attribute
{
    std::string name;
    std::variant<std::int64_t, double, std::string> value;
};

/// A group, or a dataset where it has a column. Its name is a path, as "particles/fluid0/arrays/x".
struct Hdf5Object
{
    std::string path;
    std::vector<Hdf5Attribute> attributes;
    bool is_dataset = false;
    Column column;
    std::uint64_t count = 0; ///< of particles
    std::uint64_t at = 0;    ///< filled: where its numbers stand in the file
};

/// Makes `file` an HDF5 file of these objects with room for all numbers, which threads then write
/// at their places. The HDF5 library does it, in a plugin that is opened at the first call: linked
/// with the program it would double the time of a start (7.7 ms for libcurl and what else it
/// needs).
///
/// objects  the first is the root, "", and every group stands before what is in it; `at` is filled
/// throws   IoError if the plugin cannot be opened, or the file cannot be written
void lay_out_hdf5(OutputFile& file, std::vector<Hdf5Object>& objects);

/// The entry of the plugin: makes the file at `path` and fills `at`.
///
/// returns  what went wrong, empty where nothing did
using LayOutHdf5 = std::string(const std::string& path, std::vector<Hdf5Object>& objects);

} // namespace fppg
