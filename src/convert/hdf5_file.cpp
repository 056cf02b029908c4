#include "convert/hdf5_file.h"

#include "fppg/error.h"

#include "core/plugin.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace fppg
{

void lay_out_hdf5(OutputFile& file, std::vector<Hdf5Object>& objects)
{
    static auto* const lay_out = reinterpret_cast<LayOutHdf5*>(
        plugin_function("libfppg_hdf5.so", "fppg_lay_out_hdf5",
                        "HDF5 files are made by it; it is built where libhdf5-dev is installed"));
    const std::string wrong = lay_out(file.temporary_path(), objects);
    if (!wrong.empty())
        throw IoError(fmt::format("\"{}\" cannot be made: HDF5 says: {}", file.path(), wrong));
    std::uint64_t end = std::filesystem::file_size(file.temporary_path());
    for (const Hdf5Object& object : objects)
        if (object.is_dataset)
            end = std::max(end, object.at + object.count * object.column.bytes_per_particle());
    file.reserve(end);
}

} // namespace fppg
