#include "newcase/plan.h"

#include "core/length_units.h"
#include "core/text.h"
#include "core/transforms.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>
#include <utility>

namespace fppg
{

namespace
{

constexpr std::array<const char*, 3> guessed_units{"mm", "m", "in"};

/// Sizes in metres that a case of a kind has; without a kind the widest.
std::pair<double, double> usual_sizes(const std::string& kind)
{
    if (kind == "gearbox") return {0.03, 1.5};
    if (kind == "wading") return {1.2, 25};
    if (kind == "floating") return {0.05, 400};
    return {0.03, 30};
}

/// The unit that a comment of the file names, as exporters write it: "units=mm", "unit: inch".
std::string unit_in_comments(const NewPart& part)
{
    constexpr std::array<std::pair<std::string_view, const char*>, 14> words{{{"mm", "mm"},
                                                                              {"millimeter", "mm"},
                                                                              {"millimeters", "mm"},
                                                                              {"millimetre", "mm"},
                                                                              {"millimetres", "mm"},
                                                                              {"cm", "cm"},
                                                                              {"centimeters", "cm"},
                                                                              {"m", "m"},
                                                                              {"meter", "m"},
                                                                              {"meters", "m"},
                                                                              {"metres", "m"},
                                                                              {"inch", "in"},
                                                                              {"inches", "in"},
                                                                              {"in", "in"}}};
    for (const std::string& line : part.comments)
    {
        std::size_t at = line.find("unit");
        if (at == std::string::npos) continue;
        at += 4;
        if (at < line.size() && line[at] == 's') ++at;
        const std::size_t begin = line.find_first_not_of(" =:\t\"(", at);
        if (begin == std::string::npos || begin == at) continue;
        const std::size_t end = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz", begin);
        const std::string word = line.substr(begin, end - begin);
        for (const auto& [name, unit] : words)
            if (word == name) return unit;
    }
    return "";
}

double longest(const Box3& box)
{
    const Vec3 size = box.max - box.min;
    return std::max({size.x, size.y, size.z});
}

/// STEP files name their unit, and are read as metres.
bool is_in_metres(const NewPart& part)
{
    return !part.step_part.empty();
}

/// Of the files whose unit is looked for.
Box3 box_of_meshes(const std::vector<NewPart>& parts)
{
    Box3 box;
    for (const NewPart& part : parts)
    {
        if (is_in_metres(part)) continue;
        box.add(part.box().min);
        box.add(part.box().max);
    }
    return box;
}

/// Why a unit cannot be meant, by what else is known; empty where it can.
std::string doubt(const CasePlan& plan, const Box3& box, double metre)
{
    const NewCaseOptions& options = *plan.options;
    const double size = longest(box) * metre;
    const auto [least, most] = usual_sizes(options.kind);
    if (size < least || size > most) return fmt::format("{} m long", short_number(size));
    if (options.dp > 0 && (size < 8 * options.dp || size > 5000 * options.dp))
        return fmt::format("{} dp long", short_number(size / options.dp));
    if (options.water && (*options.water < box.min.z * metre - size ||
                          *options.water > box.max.z * metre + 2 * size))
        return fmt::format("its heights are {} to {} m, the water {} m",
                           short_number(box.min.z * metre), short_number(box.max.z * metre),
                           *options.water);
    const std::size_t litres = options.fill.find_first_of("lL", options.fill.find('=') + 1);
    if (options.fill.find('=') != std::string::npos && litres != std::string::npos)
    {
        const std::string number =
            options.fill.substr(options.fill.find('=') + 1, litres - options.fill.find('=') - 1);
        const double wanted = std::atof(number.c_str());
        const Vec3 extent = box.max - box.min;
        const double room = 1000 * extent.x * extent.y * extent.z * std::pow(metre, 3);
        // More than fits is told later: only what is off by far speaks against a unit.
        if (wanted > 0 && (20 * room < wanted || room > 1000 * wanted))
            return fmt::format("its box would hold {} l, and {} l are asked for",
                               short_number(room), number);
    }
    return "";
}

struct UnitChoice
{
    std::string unit;
    std::string reason;
    bool is_sure = true;
};

UnitChoice unit_by_size(const CasePlan& plan)
{
    const Box3 box = box_of_meshes(plan.parts);
    const double size = longest(box);
    std::vector<std::string> fits;
    std::vector<std::string> not_so;
    for (const char* unit : guessed_units)
    {
        const std::string why = doubt(plan, box, metres_of_unit(unit));
        if (why.empty())
            fits.emplace_back(unit);
        else
            not_so.push_back(fmt::format("not {} ({})", unit, why));
    }
    const auto fitting = [&](const char* unit)
    { return std::find(fits.begin(), fits.end(), unit) != fits.end(); };
    if (fits.size() == 1)
        return {fits[0],
                fmt::format("all parts together are {} long: {} m in {}; {}", short_number(size),
                            short_number(size * metres_of_unit(fits[0])), fits[0],
                            fmt::join(not_so, ", "))};
    // Inches are rare: without a word of the file they are taken only where nothing else fits.
    const std::string unit = fits.empty()     ? (size > 200 ? "mm" : "m")
                             : !fitting("mm") ? "m"
                             : !fitting("m")  ? "mm"
                             : size > 20      ? "mm"
                                              : "m";
    const bool is_sure = !fits.empty() && !(fitting("mm") && fitting("m"));
    return {unit,
            fmt::format("all parts together are {} long, which is {} m in {}", short_number(size),
                        short_number(size * metres_of_unit(unit)), unit),
            is_sure};
}

/// Warns where the sizes speak against the unit that is given, and for another one.
void doubt_given_unit(CasePlan& plan)
{
    const Box3 box = box_of_meshes(plan.parts);
    const std::string why = doubt(plan, box, metres_of_unit(plan.options->unit));
    if (why.empty()) return;
    for (const char* unit : guessed_units)
        if (doubt(plan, box, metres_of_unit(unit)).empty())
        {
            plan.warnings.push_back(fmt::format(
                "--unit {}: with it all parts together would be {}; in {} they are {} m long. {} "
                "is "
                "the first of them. Expected the unit that they were exported in.",
                plan.options->unit, why, unit, short_number(longest(box) * metres_of_unit(unit)),
                plan.parts.front().path));
            return;
        }
}

UnitChoice common_unit(CasePlan& plan)
{
    const NewCaseOptions& options = *plan.options;
    if (std::all_of(plan.parts.begin(), plan.parts.end(), is_in_metres))
        return {"m", "STEP files name their units, all is read as metres"};
    if (!options.unit.empty())
    {
        doubt_given_unit(plan);
        return {options.unit, "given"};
    }
    UnitChoice out;
    for (const NewPart& part : plan.parts)
    {
        const std::string named = unit_in_comments(part);
        if (named.empty() || named == out.unit) continue;
        if (!out.unit.empty()) return unit_by_size(plan);
        out = {named, fmt::format("{} says so", part.path)};
    }
    if (!out.unit.empty()) return out;
    out = unit_by_size(plan);
    if (out.is_sure || !options.ask) return out;
    const std::string answer = options.ask(
        fmt::format("A length in the files is a m, cm, mm or in? ({})", out.reason), out.unit);
    if (metres_of_unit(answer) == 0)
        throw UsageError(fmt::format("unit: \"{}\" is invalid, expected m, cm, mm or in", answer));
    return {answer, "answered"};
}

/// The places of the file with its axis `up` along z; as <drawrotate> turns them.
Transform turned_up(const std::string& up)
{
    if (up == "y") return rotation_about_axis(0, std::numbers::pi / 2);
    if (up == "x") return rotation_about_axis(1, -std::numbers::pi / 2);
    return {};
}

void turn_part(NewPart& part, const std::string& up)
{
    if (up == "z") return;
    const Transform turn = turned_up(up);
    part.report.bounds = {};
    for (Vec3& v : part.mesh.vertices) part.report.bounds.add(v = turn(v));
    for (Vec3& n : part.mesh.normals) n = turn(n);
}

void scale_part(NewPart& part, const std::string& unit)
{
    part.unit = unit;
    part.metre = metres_of_unit(unit);
    const double s = part.metre;
    for (Vec3& v : part.mesh.vertices) v = v * s;
    for (double& area : part.mesh.areas) area *= s * s;
    part.report.area *= s * s;
    part.report.volume *= s * s * s;
    part.report.bounds = {part.report.bounds.min * s, part.report.bounds.max * s};
    part.tree = std::make_shared<GapTree>(soup_of(part.mesh));
    if (part.report.is_watertight) part.body = body_of_facets(part.tree->soup());
}

} // namespace

void choose_units(CasePlan& plan)
{
    for (NewPart& part : plan.parts) turn_part(part, plan.options->up);
    const UnitChoice common = common_unit(plan);
    std::vector<std::string> of_part(plan.parts.size(), common.unit);
    for (const std::string& entry : plan.options->units)
    {
        const std::size_t at = entry.find('=');
        const std::string unit = at == std::string::npos ? "" : entry.substr(at + 1);
        if (metres_of_unit(unit) == 0)
            throw UsageError(fmt::format(
                "--unit: \"{}\" is invalid, expected m, cm, mm or in, or PART=mm", entry));
        of_part[part_named(plan, entry.substr(0, at), "--unit")] = unit;
    }
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
    {
        NewPart& part = plan.parts[i];
        if (is_in_metres(part))
        {
            scale_part(part, "m");
            continue;
        }
        if (plan.options->units.empty())
        {
            const std::string named = unit_in_comments(part);
            if (!named.empty() && named != common.unit && common.reason != "given")
                of_part[i] = named;
        }
        scale_part(part, of_part[i]);
        if (of_part[i] != common.unit)
            plan.propose(part.name, "in " + of_part[i],
                         plan.options->units.empty() ? "its file says so" : "given");
    }
    Box3 box;
    for (const NewPart& part : plan.parts)
    {
        box.add(part.box().min);
        box.add(part.box().max);
    }
    const Vec3 size = box.max - box.min;
    plan.propose("unit", common.unit, common.reason,
                 fmt::format("The parts fill a box of {} x {} x {} m. --unit mm decides for all "
                             "files, --unit PART=mm for one.",
                             short_number(size.x), short_number(size.y), short_number(size.z)));
    if (!common.is_sure)
        plan.warnings.push_back(
            fmt::format("The unit of the files is not sure: {}. --unit m, cm, mm or in decides.",
                        common.reason));
}

} // namespace fppg
