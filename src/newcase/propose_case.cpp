#include "fppg/new_case.h"

#include "core/json.h"
#include "fppg/error.h"
#include "newcase/plan.h"
#include "newcase/xml_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace fppg
{

namespace
{

const char* role_name(PartRole role)
{
    switch (role)
    {
        case PartRole::Housing:
            return "housing";
        case PartRole::Moving:
            return "moving";
        case PartRole::Floating:
            return "floating";
        case PartRole::Inlet:
            return "inlet";
        case PartRole::Fixed:
            break;
    }
    return "fixed";
}

} // namespace

NewCase propose_case(const NewCaseOptions& options)
{
    CasePlan plan;
    plan.options = &options;
    read_parts(plan);
    choose_units(plan);
    judge_parts(plan);
    measure_pairs(plan);
    choose_roles(plan);
    choose_inlets(plan);
    choose_motion(plan);
    judge_overlaps(plan);
    choose_fluid(plan);
    choose_resolution(plan);
    place_inlets(plan);
    choose_constants(plan);
    NewCase out;
    out.kind = new_case_kinds()[static_cast<std::size_t>(plan.kind)];
    out.xml = case_text(plan);
    out.dp = plan.dp;
    out.expected_particles = plan.expected;
    for (const NewPart& part : plan.parts)
    {
        out.parts.push_back(
            {part.name, part.path, part.step_part, part.unit, part.mkbound, role_name(part.role)});
        if (!part.step_part.empty())
            plan.propose(part.name, "from " + part.path, part.step_facts,
                         "Walls stand on its exact faces; its edges that bend are feature edges.");
    }
    out.proposals = std::move(plan.proposals);
    out.warnings = std::move(plan.warnings);
    out.file_warnings = std::move(plan.file_warnings);
    return out;
}

std::string to_text(const NewCase& made, bool explains)
{
    std::size_t width = 0;
    for (const Proposal& p : made.proposals) width = std::max(width, p.what.size());
    std::string out;
    for (const Proposal& p : made.proposals)
    {
        out += fmt::format("{:<{}}  {}", p.what, width, p.value);
        if (!p.reason.empty()) out += fmt::format(": {}", p.reason);
        out += '\n';
        if (explains && !p.more.empty()) out += fmt::format("{:<{}}  {}\n", "", width, p.more);
    }
    for (const std::string& warning : made.warnings) out += "Warning: " + warning + '\n';
    return out;
}

std::string to_json(const NewCase& made)
{
    Json json;
    json["kind"] = made.kind;
    json["dp"] = made.dp;
    json["expected_particles"] = made.expected_particles;
    json["parts"] = Json::array();
    for (const NewCasePart& part : made.parts)
        json["parts"].push_back({{"name", part.name},
                                 {"file", part.path},
                                 {"unit", part.unit},
                                 {"mkbound", part.mkbound},
                                 {"role", part.role}});
    json["proposals"] = Json::array();
    for (const Proposal& p : made.proposals)
        json["proposals"].push_back(
            {{"what", p.what}, {"value", p.value}, {"reason", p.reason}, {"more", p.more}});
    json["warnings"] = Json::array();
    for (const std::string& warning : made.warnings) json["warnings"].push_back(warning);
    for (const std::string& warning : made.file_warnings) json["warnings"].push_back(warning);
    return json.text(2) + "\n";
}

} // namespace fppg
