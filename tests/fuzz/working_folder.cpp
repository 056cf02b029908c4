#include "fuzz/working_folder.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

namespace fppg::fuzz
{
namespace
{

namespace fs = std::filesystem;

/// The folder, and the files that belong there.
struct WorkingFolder
{
    fs::path path;
    std::set<std::string> kept;
};

WorkingFolder& working_folder()
{
    static WorkingFolder folder;
    return folder;
}

void remove_folder()
{
    std::error_code ignored;
    fs::current_path(fs::temp_directory_path(), ignored);
    fs::remove_all(working_folder().path, ignored);
}

} // namespace

void enter_working_folder()
{
    std::string name = (fs::temp_directory_path() / "fppg-fuzz-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
    {
        std::fprintf(stderr, "%s: cannot make the folder\n", name.c_str());
        std::exit(1);
    }
    WorkingFolder& folder = working_folder();
    folder.path = name;
    std::atexit(remove_folder);
    for (const auto& file : fs::directory_iterator(FPPG_FUZZ_FILES))
    {
        fs::copy_file(file.path(), folder.path / file.path().filename());
        folder.kept.insert(file.path().filename().string());
    }
    fs::current_path(folder.path);
}

void write_input(const std::string& name, std::string_view bytes)
{
    std::ofstream(working_folder().path / name, std::ios::binary) << bytes;
}

void tidy_working_folder()
{
    std::error_code ignored;
    for (const auto& file : fs::directory_iterator(working_folder().path, ignored))
        if (!working_folder().kept.contains(file.path().filename().string()))
            fs::remove_all(file.path(), ignored);
}

} // namespace fppg::fuzz
