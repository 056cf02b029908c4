#include "newcase/plan.h"

#include "core/nearest_word.h"
#include "core/text.h"
#include "fppg/error.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <utility>

namespace fppg
{

namespace
{

constexpr std::array<std::pair<const char*, const char*>, 5> kinds{{
    {"tank", "fluid at rest in a vessel, or in a basin round the parts"},
    {"wading",
     "a vehicle that drives through water: its wheels roll, the water comes from the front"},
    {"gearbox", "parts that turn in the fluid of a housing"},
    {"obstacle", "a stream past parts that stand"},
    {"floating", "bodies afloat in a basin"},
}};

CaseKind kind_named(const std::string& name)
{
    for (std::size_t k = 0; k < kinds.size(); ++k)
        if (name == kinds[k].first) return static_cast<CaseKind>(k);
    const std::vector<std::string>& names = new_case_kinds();
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw UsageError(fmt::format("--kind: \"{}\" is invalid{}, expected {}", name,
                                 did_you_mean(name, known), fmt::join(known, ", ")));
}

bool has_vehicle_names(const CasePlan& plan)
{
    return std::any_of(plan.parts.begin(), plan.parts.end(),
                       [](const NewPart& p) {
                           return has_word(p.name, {"wheel", "tyre", "tire", "vehicle", "car_"});
                       });
}

/// The kind and why, from what else is given.
std::pair<CaseKind, std::string> kind_by_options(const CasePlan& plan)
{
    const NewCaseOptions& o = *plan.options;
    if (!o.floatings.empty()) return {CaseKind::Floating, "--float is given"};
    if (o.speed && has_vehicle_names(plan))
        return {CaseKind::Wading, "there is a speed, and parts are called wheels or tyres"};
    if (o.speed) return {CaseKind::Obstacle, "there is a speed, and no part is called a wheel"};
    if (!o.rotations.empty()) return {CaseKind::Gearbox, "parts turn, and there is no --speed"};
    if (o.water || !o.fill.empty()) return {CaseKind::Tank, "there is fluid, and nothing moves"};
    std::string list;
    for (const auto& [name, what] : kinds) list += fmt::format("\n    {:<9} {}", name, what);
    if (o.ask)
    {
        const std::string answer =
            o.ask(fmt::format("What kind of case is it?{}\n  kind", list), "tank");
        return {kind_named(answer), "answered"};
    }
    throw UsageError(
        fmt::format("--kind is missing, and no other option says what happens in the "
                    "case; expected one of{}",
                    list));
}

struct FloatingWish
{
    std::size_t part = 0;
    double rhop = 0; ///< kg/m3
    std::string reason;
};

FloatingWish floating_wish(const CasePlan& plan, const std::string& entry)
{
    const std::size_t at = entry.find('=');
    FloatingWish out;
    out.part = part_named(plan, entry.substr(0, at), "--float");
    const NewPart& part = plan.parts[out.part];
    if (!(part.body.volume > 0))
        throw GeometryError(fmt::format(
            "{}: a floating part must be closed, it has {} open edges; close it where it was made",
            part.path, part.report.open_edges));
    if (at == std::string::npos)
    {
        out.rhop = 500;
        out.reason = "half as heavy as water, as --float gives no density (NAME=400 or NAME=12kg)";
        return out;
    }
    const char* expected = "PART=400 (kg/m3) or PART=12kg";
    const Quantity q = split_quantity(entry.substr(at + 1), "--float", expected);
    if (!(q.value > 0) || (q.unit != "" && q.unit != "kg" && q.unit != "kg/m3"))
        throw UsageError(fmt::format("--float: \"{}\" is invalid, expected {}", entry, expected));
    out.rhop = q.unit == "kg" ? q.value / part.body.volume : q.value;
    out.reason = fmt::format("given; its volume is {} l", short_number(1000 * part.body.volume));
    return out;
}

void choose_floatings(CasePlan& plan)
{
    std::vector<std::string> wishes = plan.options->floatings;
    if (wishes.empty() && plan.kind == CaseKind::Floating && plan.parts.size() == 1)
        wishes.push_back(plan.parts[0].name);
    if (wishes.empty() && plan.kind == CaseKind::Floating)
    {
        std::vector<std::string> names;
        for (const NewPart& part : plan.parts) names.push_back(part.name);
        if (!plan.options->ask)
            throw UsageError(fmt::format("--float PART=400 is missing: which of {} floats?",
                                         fmt::join(names, ", ")));
        wishes.push_back(plan.options->ask(
            fmt::format("Which part floats ({}), as PART=400 (kg/m3) or PART=12kg?",
                        fmt::join(names, ", ")),
            names[0]));
    }
    for (const std::string& entry : wishes)
    {
        const FloatingWish wish = floating_wish(plan, entry);
        NewPart& part = plan.parts[wish.part];
        part.role = PartRole::Floating;
        part.rhop_body = wish.rhop;
        plan.propose(part.name,
                     fmt::format("floats, {} kg/m3, {} kg", short_number(wish.rhop),
                                 short_number(wish.rhop * part.body.volume)),
                     wish.reason,
                     "Mass, centre and inertia are those of its shape (<floatings exact>).");
    }
}

bool is_called_housing(const NewPart& part)
{
    return has_word(part.name,
                    {"hous", "casing", "case", "tank", "vessel", "basin", "gearbox", "bath"});
}

/// How well a part would do as the one that holds the fluid, and the volume of its box.
std::pair<double, double> housing_rank(const CasePlan& plan, std::size_t h)
{
    const Box3& box = plan.parts[h].box();
    const double room = 0.02 * norm(box.max - box.min);
    double rank = 0;
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
    {
        if (i == h) continue;
        const Vec3 middle = (plan.parts[i].box().min + plan.parts[i].box().max) * 0.5;
        bool is_in = true;
        for (int axis = 0; axis < 3; ++axis)
            is_in &= middle[axis] > box.min[axis] - room && middle[axis] < box.max[axis] + room;
        if (is_in) ++rank;
    }
    const Vec3 size = box.max - box.min;
    if (is_called_housing(plan.parts[h])) rank += static_cast<double>(plan.parts.size());
    if (has_word(plan.parts[h].name, {"lid", "cover", "gear1", "shaft", "wheel", "bearing"}))
        rank -= static_cast<double>(plan.parts.size());
    return {rank, size.x * size.y * size.z};
}

/// What floats, turns or is a sheet that lets fluid in is no housing. One that is called a housing
/// and is to turn stays one here: the choice of motions says that it cannot.
bool may_hold_fluid(const CasePlan& plan, const NewPart& part)
{
    const auto is_named = [&](const std::vector<std::string>& entries)
    {
        return std::any_of(entries.begin(), entries.end(),
                           [&](const std::string& entry)
                           {
                               const std::vector<std::string> names =
                                   names_of_list(entry.substr(0, entry.find('=')));
                               return std::any_of(
                                   names.begin(), names.end(),
                                   [&](const std::string& name)
                                   { return lower_case(name) == lower_case(part.name); });
                           });
    };
    return part.role != PartRole::Floating && !is_named(plan.options->inlets) &&
           (is_called_housing(part) || !is_named(plan.options->rotations));
}

void choose_housing(CasePlan& plan)
{
    const NewCaseOptions& o = *plan.options;
    std::string given = o.housing;
    std::string option = "--housing";
    if (given.empty() && o.fill.find('@') != std::string::npos)
    {
        given = o.fill.substr(o.fill.find('@') + 1);
        option = "--fill";
    }
    std::size_t housing = 0;
    std::string reason = "given";
    if (!given.empty())
        housing = part_named(plan, given, option);
    else
    {
        const bool is_needed =
            plan.kind == CaseKind::Gearbox || plan.kind == CaseKind::Tank || !o.fill.empty();
        if (!is_needed) return;
        housing = plan.parts.size();
        for (std::size_t i = 0; i < plan.parts.size(); ++i)
            if (may_hold_fluid(plan, plan.parts[i]) &&
                (housing == plan.parts.size() ||
                 housing_rank(plan, i) > housing_rank(plan, housing)))
                housing = i;
        if (housing == plan.parts.size()) return;
        reason = plan.parts.size() == 1
                     ? "the only part"
                     : "its box holds most of the other parts, or its name says so";
    }
    NewPart& part = plan.parts[housing];
    if (part.role == PartRole::Floating)
        throw UsageError(fmt::format("{} cannot float and hold the fluid", part.name));
    part.role = PartRole::Housing;
    part.role_reason = reason;
}

void choose_speed(CasePlan& plan)
{
    plan.speed = plan.options->speed;
    const bool is_needed = plan.kind == CaseKind::Wading || plan.kind == CaseKind::Obstacle;
    if (plan.speed || !is_needed) return;
    const char* of = plan.kind == CaseKind::Wading ? "vehicle" : "stream";
    if (!plan.options->ask)
        throw UsageError(
            fmt::format("--speed is missing: how fast is the {}, metres a second?", of));
    const std::string answer =
        plan.options->ask(fmt::format("How fast is the {}, metres a second?", of), "");
    const Quantity q = split_quantity(answer, "speed", "metres a second, such as 5");
    if (!q.unit.empty() && q.unit != "m/s")
        throw UsageError(fmt::format("speed: \"{}\" is invalid, expected metres a second", answer));
    plan.speed = q.value;
}

} // namespace

const std::vector<std::string>& new_case_kinds()
{
    static const std::vector<std::string> names = []
    {
        std::vector<std::string> out;
        for (const auto& kind : kinds) out.emplace_back(kind.first);
        return out;
    }();
    return names;
}

void choose_roles(CasePlan& plan)
{
    std::string reason = "given";
    if (plan.options->kind.empty())
        std::tie(plan.kind, reason) = kind_by_options(plan);
    else
        plan.kind = kind_named(plan.options->kind);
    const auto& [name, what] = kinds[static_cast<std::size_t>(plan.kind)];
    plan.propose("kind", name, reason, fmt::format("{}. --kind chooses another.", what));
    for (const std::string& fixed : plan.options->fixed) (void)part_named(plan, fixed, "--fix");
    choose_floatings(plan);
    choose_housing(plan);
    choose_speed(plan);
}

} // namespace fppg
