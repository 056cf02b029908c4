#include "app/result_files.h"

#include "fppg/error.h"

#include "app/stop_signals.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace fppg
{

void ResultFiles::copy(const std::string& source, const std::string& path)
{
    OutputFile& file = add(path);
    std::ifstream in(source, std::ios::binary);
    std::string block(1 << 20, '\0');
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
        file.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (in.bad() || !in.eof())
        throw IoError(fmt::format("{}: cannot read the file again to copy it", source));
}

bool ResultFiles::has(const std::string& path) const
{
    return std::any_of(files_.begin(), files_.end(),
                       [&](const OutputFile& f) { return f.path() == path; });
}

void ResultFiles::commit(bool three_vtk)
{
    std::vector<std::string> pictures;
    const StopSignalsIgnored ignored;
    for (OutputFile& file : files_)
    {
        file.commit();
        if (file.path().ends_with(".vtk")) pictures.push_back(file.path());
    }
    files_.clear();
    if (!three_vtk) return;
    for (const std::string& path : pictures)
        for (const char* copy : {"_r00", "_r01", "_r02"})
            std::filesystem::copy_file(path, path.substr(0, path.size() - 4) + copy + ".vtk",
                                       std::filesystem::copy_options::overwrite_existing);
}

} // namespace fppg
