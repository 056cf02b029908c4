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

/// Lays out an HDF5 file (format specification 3.0: superblock 0, object headers 1, contiguous
/// arrays, little-endian), which HDF5 1.x and all that is built on it read. The program needs no
/// HDF5 for that, and threads write the numbers at their places.
///
/// objects  every group before what is in it, at most 126 things in a group
/// size     filled: bytes of the whole file
/// returns  its begin, up to the first number
std::string lay_out_hdf5(std::vector<Hdf5Object>& objects, std::uint64_t& size);

} // namespace fppg
