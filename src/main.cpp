#include "fppg/error.h"

#include "app/command_line.h"
#include "app/drop_in.h"
#include "app/stop_signals.h"
#include "app/subcommands.h"

#include <cstdio>
#include <new>
#include <string>
#include <vector>

namespace
{

int fail(const char* text, int code)
{
    std::fflush(stdout);
    std::printf("\n*** Error: %s\n\nFinished execution (code=%d).\n", text, code);
    return code;
}

} // namespace

int main(int argc, char** argv)
{
    fppg::catch_stop_signals();
    try
    {
        const std::vector<std::string> arguments(argv + 1, argv + argc);
        if (fppg::is_subcommand(arguments)) return fppg::run_subcommand(arguments);
        return fppg::run_drop_in(fppg::parse_command_line(arguments));
    }
    catch (const fppg::Error& error)
    {
        return fail(error.what(), error.exit_code());
    }
    catch (const std::bad_alloc&)
    {
        return fail(
            "there is not enough memory for this case; a larger dp or a smaller domain needs less",
            4);
    }
    catch (const std::exception& error)
    {
        return fail(error.what(), 5);
    }
}
