#pragma once

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace fppg::test
{

/// A box of particles; at dp 0.1 in less than 0.1 s.
inline CaseText box_case(const std::string& size = "0.8")
{
    CaseText out;
    out.mainlist =
        R"(<setdrawmode mode="full" /><setmkfluid mk="0" /><drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x=")" +
        size + "\" y=\"" + size + "\" z=\"" + size + "\" /></drawbox>";
    return out;
}

/// Cases of xml-templates, with the data that they read.
inline void copy_templates(const std::filesystem::path& folder, const Arguments& names)
{
    namespace fs = std::filesystem;
    const fs::path templates(FPPG_TEMPLATES);
    fs::create_directories(folder);
    fs::copy(templates / "data", folder / "data", fs::copy_options::recursive);
    for (const std::string& name : names)
        fs::copy_file(templates / (name + "_Def.xml"), folder / (name + "_Def.xml"));
}

inline nlohmann::json read_json(const std::filesystem::path& path)
{
    return nlohmann::json::parse(read_text(path.string()));
}

} // namespace fppg::test
