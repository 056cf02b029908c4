#include "fppg/error.h"

namespace fppg
{

CaseError::CaseError(const std::string& file, int line, const std::string& text)
    : Error(line > 0 ? file + ":" + std::to_string(line) + ": " + text : file + ": " + text)
{
}

} // namespace fppg
