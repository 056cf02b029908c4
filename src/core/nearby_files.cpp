#include "core/nearby_files.h"

#include "core/nearest_word.h"
#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

namespace fppg
{

std::string what_lies_at(const std::vector<std::filesystem::path>& paths)
{
    constexpr std::size_t most_names = 8;
    std::string out;
    std::set<std::string> seen;
    for (const std::filesystem::path& path : paths)
    {
        std::filesystem::path folder = path.parent_path();
        if (folder.empty()) folder = ".";
        std::error_code error;
        const std::filesystem::path place = std::filesystem::weakly_canonical(folder, error);
        if (!seen.insert(place.string()).second) continue;
        std::vector<std::string> names;
        for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end;
             i.increment(error))
            if (lower_case(i->path().extension().string()) == lower_case(path.extension().string()))
                names.push_back(i->path().filename().string());
        if (!std::filesystem::is_directory(folder, error))
        {
            out += fmt::format("; there is no folder {}", folder.string());
            continue;
        }
        std::sort(names.begin(), names.end());
        const std::vector<std::string_view> views(names.begin(), names.end());
        const std::string nearest = did_you_mean(path.filename().string(), views);
        const std::size_t more = names.size() - std::min(names.size(), most_names);
        names.resize(names.size() - more);
        out += names.empty()
                   ? fmt::format("; in {} lies no *{}", place.string(), path.extension().string())
                   : fmt::format("; in {} lie {}{}{}", place.string(), fmt::join(names, ", "),
                                 more > 0 ? fmt::format(" and {} more", more) : "", nearest);
    }
    return out;
}

} // namespace fppg
