#include "platform/terminal.h"

#include "platform/windows/errors.h"

namespace fppg
{

namespace
{

HANDLE handle_of(Stream stream)
{
    return ::GetStdHandle(stream == Stream::In    ? STD_INPUT_HANDLE
                          : stream == Stream::Out ? STD_OUTPUT_HANDLE
                                                  : STD_ERROR_HANDLE);
}

} // namespace

bool is_terminal(Stream stream)
{
    DWORD mode = 0;
    return ::GetConsoleMode(handle_of(stream), &mode) != 0;
}

bool are_one(Stream a, Stream b)
{
    const HANDLE first = handle_of(a);
    const HANDLE second = handle_of(b);
    if (first == second || (is_terminal(a) && is_terminal(b))) return true;
    BY_HANDLE_FILE_INFORMATION one = {};
    BY_HANDLE_FILE_INFORMATION other = {};
    return ::GetFileInformationByHandle(first, &one) != 0 &&
           ::GetFileInformationByHandle(second, &other) != 0 &&
           one.dwVolumeSerialNumber == other.dwVolumeSerialNumber &&
           one.nFileIndexHigh == other.nFileIndexHigh && one.nFileIndexLow == other.nFileIndexLow;
}

} // namespace fppg
