#include "platform/terminal.h"

#include <sys/stat.h>
#include <unistd.h>

namespace fppg
{

namespace
{

int descriptor_of(Stream stream)
{
    return stream == Stream::In    ? STDIN_FILENO
           : stream == Stream::Out ? STDOUT_FILENO
                                   : STDERR_FILENO;
}

} // namespace

bool is_terminal(Stream stream)
{
    return ::isatty(descriptor_of(stream)) != 0;
}

bool are_one(Stream a, Stream b)
{
    struct stat first = {};
    struct stat second = {};
    return ::fstat(descriptor_of(a), &first) == 0 && ::fstat(descriptor_of(b), &second) == 0 &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

} // namespace fppg
