#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// Rows of equally many cells as lines of text, two blanks between the columns.
///
/// left    this many first columns are aligned to the left, the others to the right
/// indent  stands before every line
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t left = 0,
                       const std::string& indent = "");

} // namespace fppg
