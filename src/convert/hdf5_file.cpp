#include "convert/hdf5_file.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace fppg
{

namespace
{

/// The folder of the program, or of the shared library, that this code is in.
std::filesystem::path own_folder()
{
    Dl_info image = {};
    if (dladdr(reinterpret_cast<void*>(&own_folder), &image) == 0 || !image.dli_fname) return {};
    std::error_code failed;
    return std::filesystem::canonical(image.dli_fname, failed).parent_path();
}

/// Where modules are: FPPG_MODULES of the environment, beside the program, and where `install` puts
/// them, from the program's or the Python module's folder, or by its whole name.
std::vector<std::filesystem::path> module_folders()
{
    std::vector<std::filesystem::path> folders;
    if (const char* named = std::getenv("FPPG_MODULES")) folders.emplace_back(named);
    if (const std::filesystem::path own = own_folder(); !own.empty())
        for (const char* way : {".", "../" FPPG_LIBRARIES, "../../../../" FPPG_LIBRARIES})
            folders.push_back(own / way);
    folders.emplace_back(FPPG_MODULE_FOLDER);
    return folders;
}

LayOutHdf5* load_hdf5_module()
{
    const char* const name = "fppg_hdf5.so";
    std::string why = "it is not there";
    for (const std::filesystem::path& folder : module_folders())
    {
        const std::filesystem::path file = folder / name;
        if (!std::filesystem::exists(file)) continue;
        void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const entry = module ? dlsym(module, "fppg_lay_out_hdf5") : nullptr;
        if (entry) return reinterpret_cast<LayOutHdf5*>(entry);
        why = dlerror();
    }
    throw IoError(
        fmt::format("HDF5 files need the module {}, which is built where libhdf5-dev is "
                    "installed: {}",
                    name, why));
}

} // namespace

void lay_out_hdf5(OutputFile& file, std::vector<Hdf5Object>& objects)
{
    static LayOutHdf5* const lay_out = load_hdf5_module();
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
