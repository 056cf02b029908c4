#include "platform/start.h"

#include "platform/windows/errors.h"

#include <fcntl.h>
#include <io.h>
#include <shellapi.h>

#include <cstdio>
#include <cstdlib>
#include <cwchar>

namespace fppg
{

namespace
{

unsigned code_page_of_before = 0;

void give_code_page_back()
{
    ::SetConsoleOutputCP(code_page_of_before);
}

} // namespace

void prepare_streams()
{
    for (std::FILE* stream : {stdin, stdout, stderr})
        if (::_fileno(stream) < 0) (void)std::freopen("NUL", stream == stdin ? "r" : "w", stream);
    code_page_of_before = ::GetConsoleOutputCP();
    if (code_page_of_before == 0 || ::SetConsoleOutputCP(CP_UTF8) == 0) return;
    std::atexit(give_code_page_back);
    // The bar of a stage is drawn by escape sequences.
    const HANDLE error = ::GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode = 0;
    if (::GetConsoleMode(error, &mode) != 0)
        ::SetConsoleMode(error, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

std::vector<std::string> program_arguments(int /*argc*/, char** /*argv*/)
{
    int count = 0;
    wchar_t** const words = ::CommandLineToArgvW(::GetCommandLineW(), &count);
    std::vector<std::string> arguments;
    for (int i = 1; words != nullptr && i < count; ++i) arguments.push_back(utf8(words[i]));
    ::LocalFree(reinterpret_cast<HLOCAL>(words));
    return arguments;
}

void set_default_variable(const char* name, const char* value)
{
    if (std::getenv(name) == nullptr) ::_putenv_s(name, value);
}

} // namespace fppg
