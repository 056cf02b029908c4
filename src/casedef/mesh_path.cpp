#include "casedef/mesh_path.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

std::string find_mesh_file(const CaseDef& def, const SourceRef& source, const std::string& file)
{
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return file;
    std::string beside = (std::filesystem::path(def.file).parent_path() / file).string();
    if (std::filesystem::exists(beside, ignored)) return beside;
    throw IoError(fmt::format("{}:{}: <{} file=\"{}\">: cannot open the file: there is no {}{}",
                              def.file, source.line, source.command, file, file,
                              beside == file ? "" : " and no " + beside));
}

} // namespace fppg
