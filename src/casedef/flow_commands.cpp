// Commands that run lists, print and set variables.
#include "casedef/command_table.h"
#include "fppg/error.h"

#include "casedef/variable_commands.h"
#include "core/nearest_word.h"

#include <fmt/format.h>

namespace fppg::commands
{

void run_named_list(Program& p, const Element& e)
{
    const std::string& list = p.read.text(e, "name");
    const auto found = p.lists.find(list);
    if (found == p.lists.end())
    {
        std::vector<std::string_view> names;
        for (const auto& [name, ignored] : p.lists) names.push_back(name);
        p.read.fail(e,
                    fmt::format("there is no list named '{}'{}", list, did_you_mean(list, names)));
    }
    const int times = !p.read.text_or(e, "times", "").empty()
                          ? p.read.integer(e, "times", 0, 1'000'000'000, true)
                          : 1;
    const bool is_printed = p.read.plain_flag_or(*found->second, "printcall", true);
    p.expect_few_commands(e, *found->second, times);
    for (int i = 0; i < times; ++i)
    {
        // An empty list counts too: each call leaves a line in the log.
        p.count_command(e);
        if (is_printed) p.def.list_log.push_back("> " + list);
        p.run_list(*found->second, list);
    }
}

void print_text(Program& p, const Element& e)
{
    p.def.list_log.push_back(p.read.interpolated(e, p.read.text(e, "text")));
}

void abort_case(Program& p, const Element& e)
{
    throw CaseError(p.def.file, e.line,
                    fmt::format("<abort>: the case stops itself: {}",
                                p.read.interpolated(e, p.read.text_or(e, "text", "(no text)"))));
}

/// A picture for GenCase's own debugging, written at a debug level only.
void pass_over(Program&, const Element&) {}

void run_variable_command(Program& p, const Element& e)
{
    p.variables.run(e, p.def.list_log);
}

} // namespace fppg::commands
