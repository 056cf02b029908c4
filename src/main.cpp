#include "fppg/error.h"

#include "app/command_line.h"
#include "app/drop_in.h"
#include "app/run_log.h"
#include "app/subcommands.h"
#include "platform/memory.h"
#include "platform/start.h"
#include "platform/stop_signals.h"
#include "platform/terminal.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace
{

/// Whoever asked for JSON lines gets the error as one.
bool wants_json = false;

/// Tells standard output, where callers of GenCase look for it, and standard error, where scripts
/// do; once where both are one.
int fail(const char* text, int code)
{
    if (wants_json)
        fppg::print_json_error(text, code);
    else
        std::printf("\n*** Error: %s\n\nFinished execution (code=%d).\n", text, code);
    const bool is_told = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (!is_told || !fppg::are_one(fppg::Stream::Out, fppg::Stream::Error))
        std::fprintf(stderr, "*** Error: %s\n", text);
    return code;
}

bool ends_itself = false;

/// Ends the program where a library gave up.
[[noreturn]] void end_without_memory(const char* library)
{
    fppg::drop_unfinished_files();
    const std::string text = std::string("memory or threads ran out and ") + library +
                             " gave up; a larger dp, a smaller domain or fewer -threads need less";
    const int code = fail(text.c_str(), 4);
    std::fflush(stderr);
    std::_Exit(code);
}

/// GCC's OpenMP runtime ends the program where it gets no memory or no thread, with exit code 1.
void tell_foreign_end()
{
    if (!ends_itself) end_without_memory("the OpenMP runtime");
}

/// Embree calls std::terminate() where it gets no memory for a scene. An exception that nobody
/// caught is a fault of the program.
void tell_terminate()
{
    if (std::current_exception()) std::abort();
    end_without_memory("Embree");
}

int run(const std::vector<std::string>& arguments)
{
    if (!arguments.empty())
    {
        if (const fppg::Subcommand command = fppg::find_subcommand(arguments.front()))
            return command({arguments.begin() + 1, arguments.end()});
        fppg::refuse_mistyped_subcommand(arguments.front());
    }
    return fppg::run_drop_in(fppg::parse_command_line(arguments));
}

int run_and_tell(int argc, char** argv)
{
    try
    {
        const std::vector<std::string> arguments = fppg::program_arguments(argc, argv);
        wants_json =
            std::any_of(arguments.begin(), arguments.end(),
                        [](const std::string& a) { return a == "-log-json" || a == "--log-json"; });
        const int code = run(arguments);
        fppg::expect_printed();
        return code;
    }
    catch (const fppg::Error& error)
    {
        return fail(error.what(), error.exit_code());
    }
    catch (const std::bad_alloc&)
    {
        const auto limit = static_cast<double>(fppg::memory_limit());
        const std::string why = limit > 0 ? fmt::format(
                                                "this case needs more than the {:.3g} GB that "
                                                "-memory allows",
                                                limit * 1e-9)
                                          : "there is not enough memory for this case";
        return fail((why + "; a larger dp or a smaller domain needs less").c_str(), 4);
    }
    catch (const std::filesystem::filesystem_error& error)
    {
        // Of names that the system does not take, longer than 255 characters for one.
        const std::string text = error.path1().string() + ": " + error.code().message();
        return fail(error.path1().empty() ? error.what() : text.c_str(), 4);
    }
    catch (const std::exception& error)
    {
        // fmt::print() throws this where it cannot write.
        if (std::ferror(stdout) != 0) return fail("standard output cannot be written", 4);
        return fail(error.what(), 5);
    }
}

} // namespace

int main(int argc, char** argv)
{
    fppg::prepare_streams();
    fppg::catch_stop_signals();
    std::atexit(tell_foreign_end);
    std::set_terminate(tell_terminate);
    const int code = run_and_tell(argc, argv);
    ends_itself = true;
    return code;
}
