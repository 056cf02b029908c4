#include "app/result_files.h"

#include "fppg/error.h"

#include "platform/files.h"
#include "platform/stop_signals.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace fppg
{

void ResultFiles::copy(const std::string& source, const std::string& path)
{
    OutputFile& file = add(path);
    std::ifstream in(std::filesystem::path(source), std::ios::binary);
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

namespace
{

/// The order in which files get their names: Case.bi4 and Case.xml last and side by side.
int rank(const OutputFile& file)
{
    return file.path().ends_with(".xml") ? 2 : file.path().ends_with(".bi4") ? 1 : 0;
}

} // namespace

/// Were a run killed between the two renames, a new Case.bi4 would stand beside the old Case.xml:
/// nobody, the solver neither, would see that. Without Case.xml all do.
void ResultFiles::remove_old_xml() const
{
    for (const OutputFile& file : files_)
    {
        if (!file.path().ends_with(".bi4")) continue;
        const std::string xml = file.path().substr(0, file.path().size() - 4) + ".xml";
        if (has(xml) && !remove_file(xml.c_str()) && errno != ENOENT)
            throw IoError(fmt::format("cannot write '{}': {}", xml, std::strerror(errno)));
    }
}

/// Copies are files of the result as all others: they come with it or not at all.
void ResultFiles::copy_pictures()
{
    std::vector<std::pair<std::string, std::string>> pictures;
    for (const OutputFile& file : files_)
        if (file.path().ends_with(".vtk"))
            pictures.emplace_back(file.temporary_path(), file.path());
    for (const auto& [source, path] : pictures)
        for (const char* number : {"_r00", "_r01", "_r02"})
            copy(source, path.substr(0, path.size() - 4) + number + ".vtk");
}

void ResultFiles::commit(bool three_vtk)
{
    if (!are_written_) return;
    if (three_vtk) copy_pictures();
    const StopSignalsIgnored ignored;
    for (OutputFile& file : files_) file.finish();
    std::stable_sort(files_.begin(), files_.end(),
                     [](const OutputFile& a, const OutputFile& b) { return rank(a) < rank(b); });
    bool has_old_xml = true;
    for (OutputFile& file : files_)
    {
        if (has_old_xml && rank(file) > 0)
        {
            remove_old_xml();
            has_old_xml = false;
        }
        file.commit();
    }
    files_.clear();
}

} // namespace fppg
