#include "core/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{

std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t left,
                       const std::string& indent)
{
    std::vector<std::size_t> widths(rows.empty() ? 0 : rows.front().size());
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const auto& row : rows)
    {
        std::string line = indent;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += c < left ? fmt::format("{:<{}}  ", row[c], widths[c])
                             : fmt::format("{:>{}}  ", row[c], widths[c]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

} // namespace fppg
