#include "fppg/error.h"

namespace fppg
{

namespace
{

/// "file:line: text"; appended piece by piece, as g++ 12 warns wrongly of a sum that begins with
/// "file +".
std::string at_place(const std::string& file, int line, const std::string& text)
{
    std::string out = file;
    if (line > 0) out.append(":").append(std::to_string(line));
    return out.append(": ").append(text);
}

} // namespace

CaseError::CaseError(const std::string& file, int line, const std::string& text)
    : Error(at_place(file, line, text))
{
}

} // namespace fppg
