#include "app/run_log.h"

#include <cstdio>

namespace fppg
{

void RunLog::line(std::string_view text)
{
    const std::size_t begin = text_.size();
    text_.append(text);
    text_ += '\n';
    std::fwrite(text_.data() + begin, 1, text_.size() - begin, stdout);
    std::fflush(stdout);
}

} // namespace fppg
