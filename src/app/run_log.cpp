#include "app/run_log.h"

#include <cstdio>

namespace fppg
{

void RunLog::line(std::string_view text)
{
    text_.append(text);
    text_ += '\n';
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
}

} // namespace fppg
