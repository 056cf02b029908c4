// Besides the arrays that Case.bi4 has, an output of DualSPHysics v5.4 says in the values of its
// item PART_NNNN: TimeStep, Step, Npok, Nout, dtmin, dtmax and more (seen in its files).

#include "leak/part_file.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

namespace fppg
{

PartFile::PartFile(const std::string& path)
    : path_(path), file_(path), view_(view_bi4(file_.bytes(), path))
{
    const std::optional<double> time = find_number(view_.items, "TimeStep");
    if (!time || !std::isfinite(*time))
        throw IoError(
            fmt::format("cannot read '{}': it does not say its time (TimeStep), expected "
                        "an output Part_XXXX.bi4 of the solver",
                        path));
    time_ = *time;
    if (value("Npiece", 1) != 1)
        throw IoError(
            fmt::format("cannot read '{}': it is one of {:g} pieces, expected all "
                        "particles in one file",
                        path, value("Npiece", 1)));
}

std::uint32_t PartFile::id(std::size_t i) const
{
    std::uint32_t id;
    std::memcpy(&id, view_.idp.data() + 4 * i, sizeof id);
    return id;
}

Vec3 PartFile::position(std::size_t i) const
{
    Vec3 p;
    if (view_.is_single())
    {
        float f[3];
        std::memcpy(f, view_.pos.data() + 12 * i, sizeof f);
        p = {f[0], f[1], f[2]};
    }
    else
    {
        double d[3];
        std::memcpy(d, view_.posd.data() + 24 * i, sizeof d);
        p = {d[0], d[1], d[2]};
    }
    if (!is_finite(p))
        throw IoError(
            fmt::format("'{}': particle {} is at ({}, {}, {})", path_, id(i), p.x, p.y, p.z));
    return p;
}

double PartFile::value(std::string_view name, double otherwise) const
{
    return find_number(view_.items, name).value_or(otherwise);
}

std::vector<std::string> part_files(const std::vector<std::string>& names)
{
    namespace fs = std::filesystem;
    std::vector<std::string> files;
    for (const std::string& name : names)
    {
        std::error_code ignored;
        if (!fs::is_directory(name, ignored))
        {
            files.push_back(name);
            continue;
        }
        std::vector<std::string> found;
        for (const fs::directory_entry& entry : fs::directory_iterator(name))
        {
            const std::string file = entry.path().filename().string();
            if (file.starts_with("Part_") && file.ends_with(".bi4"))
                found.push_back(entry.path().string());
        }
        if (found.empty()) throw UsageError(fmt::format("'{}' holds no file Part_*.bi4", name));
        std::sort(found.begin(), found.end());
        files.insert(files.end(), found.begin(), found.end());
    }
    if (files.empty()) throw UsageError("no output of the solver is named, expected Part_*.bi4");
    return files;
}

} // namespace fppg
