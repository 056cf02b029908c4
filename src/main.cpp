#include "fppg/error.h"

#include "app/command_line.h"
#include "app/drop_in.h"
#include "app/run_log.h"
#include "app/stop_signals.h"
#include "app/subcommands.h"

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

namespace
{

/// Whoever asked for JSON lines gets the error as one.
bool wants_json = false;

int fail(const char* text, int code)
{
    std::fflush(stdout);
    if (wants_json)
    {
        fppg::print_json_error(text, code);
        return code;
    }
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
        wants_json =
            std::any_of(arguments.begin(), arguments.end(),
                        [](const std::string& a) { return a == "-log-json" || a == "--log-json"; });
        if (!arguments.empty())
            if (const fppg::Subcommand run = fppg::find_subcommand(arguments.front()))
                return run({arguments.begin() + 1, arguments.end()});
        if (!arguments.empty()) fppg::refuse_mistyped_subcommand(arguments.front());
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
