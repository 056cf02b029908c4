#pragma once

#include <cstdint>
#include <string>

namespace fppg::fuzz
{

/// Changes a case definition by its grammar: elements are removed, repeated, moved and swapped,
/// numbers scaled, negated, moved by a little or made huge or no number, and words and file names
/// put in the place of others.
///
/// text     a definition
/// returns  another one; empty where `text` is no XML
std::string mutate_case(const std::string& text, std::uint32_t seed);

/// Puts an element of the second definition into the first one.
std::string cross_cases(const std::string& text, const std::string& other, std::uint32_t seed);

} // namespace fppg::fuzz
