#include "platform/start.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>

namespace fppg
{

void prepare_streams()
{
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0) (void)::open("/dev/null", O_RDWR);
}

std::vector<std::string> program_arguments(int argc, char** argv)
{
    return {argv + 1, argv + argc};
}

void set_default_variable(const char* name, const char* value)
{
    ::setenv(name, value, 0);
}

} // namespace fppg
