#include "app/subcommands.h"

#include "app/batch_command.h"
#include "app/compare_command.h"
#include "app/estimate_command.h"
#include "app/inspect_command.h"
#include "app/leak_command.h"
#include "app/render_command.h"
#include "app/report_command.h"
#include "app/templates_command.h"
#include "app/upgrade_command.h"

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
    {"batch", run_batch_command}, {"compare", run_compare},     {"estimate", run_estimate},
    {"inspect", run_inspect},     {"leak", run_leak},           {"render", run_render},
    {"report", run_report},       {"templates", run_templates}, {"upgrade", run_upgrade},
};

} // namespace

Subcommand find_subcommand(const std::string& name)
{
    for (const Entry& entry : entries)
        if (name == entry.name) return entry.run;
    return nullptr;
}

} // namespace fppg
