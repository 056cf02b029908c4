#include "app/subcommands.h"

#include "app/batch_command.h"
#include "app/check_command.h"
#include "app/compare_command.h"
#include "app/convert_command.h"
#include "app/estimate_command.h"
#include "app/inspect_command.h"
#include "app/leak_command.h"
#include "app/new_command.h"
#include "app/render_command.h"
#include "app/report_command.h"
#include "app/templates_command.h"
#include "app/upgrade_command.h"
#include "core/nearest_word.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

namespace fppg
{

namespace
{

struct Entry
{
    const char* name;
    Subcommand run;
};

constexpr Entry entries[] = {
    {"batch", run_batch_command}, {"check", run_check},
    {"compare", run_compare},     {"convert", run_convert},
    {"estimate", run_estimate},   {"inspect", run_inspect},
    {"leak", run_leak},           {"new", run_new},
    {"render", run_render},       {"report", run_report},
    {"templates", run_templates}, {"upgrade", run_upgrade},
};

} // namespace

Subcommand find_subcommand(const std::string& name)
{
    for (const Entry& entry : entries)
        if (name == entry.name) return entry.run;
    return nullptr;
}

void refuse_mistyped_subcommand(const std::string& argument)
{
    std::error_code ignored;
    if (argument.starts_with('-') || std::filesystem::exists(argument, ignored) ||
        std::filesystem::exists(argument + ".xml", ignored))
        return;
    std::vector<std::string_view> names;
    for (const Entry& entry : entries) names.emplace_back(entry.name);
    if (nearest_word(argument, names).empty()) return;
    throw UsageError(
        fmt::format("\"{}\" is no subcommand{}, and there is no definition {}.xml; "
                    "fppg --help lists the subcommands",
                    argument, did_you_mean(argument, names), argument));
}

} // namespace fppg
