#include "core/nearest_word.h"

#include "core/text.h"

#include <algorithm>
#include <cstddef>

namespace fppg
{
namespace
{

/// Letters put in, left out, changed or swapped with the next one.
std::size_t edits_between(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1,
                               last[j - 1] + static_cast<std::size_t>(a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last[b.size()];
}

} // namespace

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& known)
{
    const std::string small = lower_case(word);
    std::size_t least = std::max<std::size_t>(1, small.size() / 3) + 1;
    std::string_view nearest;
    for (const std::string_view candidate : known)
    {
        // A word of one letter is one change from every other.
        const std::size_t edits = edits_between(small, lower_case(candidate));
        if (edits < least && edits < std::max(small.size(), candidate.size()))
        {
            least = edits;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known)
{
    const std::string_view nearest = nearest_word(word, known);
    return nearest.empty() ? std::string() : " (did you mean " + std::string(nearest) + "?)";
}

} // namespace fppg
