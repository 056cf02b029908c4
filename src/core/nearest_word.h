#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// The known word that a mistyped one is nearest to: least letters put in, left out, changed or
/// swapped with the next one, capitals not counted, at most a third of the word's letters and at
/// least one. Empty where none is as near. Of equally near ones it is the first.
std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& known);

/// " (did you mean autofill?)", or "" where no known word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& known);

} // namespace fppg
