#include "fppg/error.h"

#include "app/command_line.h"
#include "app/drop_in.h"
#include "files/output_file_registry.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

namespace
{

/// Ctrl-C ends the program at any moment: the temporary files go, the outputs of before stay.
extern "C" void stop(int)
{
    fppg::remove_temporary_files();
    constexpr char text[] = "\n*** Stopped by the user; no output file was changed.\n";
    const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    static_cast<void>(written);
    _exit(130);
}

int fail(const char* text, int code)
{
    std::fflush(stdout);
    std::printf("\n*** Error: %s\n\nFinished execution (code=%d).\n", text, code);
    return code;
}

} // namespace

int main(int argc, char** argv)
{
    std::signal(SIGINT, stop);
    std::signal(SIGTERM, stop);
    std::signal(SIGXFSZ, SIG_IGN); // a file size limit is reported by the write that meets it
    try
    {
        return fppg::run_drop_in(fppg::parse_command_line(std::vector<std::string>(argv + 1, argv + argc)));
    }
    catch (const fppg::Error& error)
    {
        return fail(error.what(), error.exit_code());
    }
    catch (const std::bad_alloc&)
    {
        return fail("there is not enough memory for this case; a larger dp or a smaller domain needs less", 4);
    }
    catch (const std::exception& error)
    {
        return fail(error.what(), 5);
    }
}
