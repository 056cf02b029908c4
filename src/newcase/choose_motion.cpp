#include "newcase/plan.h"

#include "core/transforms.h"
#include "fppg/error.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{

namespace
{

double size_of(const NewPart& part)
{
    return norm(part.box().max - part.box().min);
}

std::string times_text(const SymmetryAxis& s)
{
    return s.times == 0 ? "it is round about it"
                        : fmt::format("it turns onto itself {} times a turn about it", s.times);
}

/// The axis of an option: x, y or z (through the part's own), a direction, POINT:DIRECTION, or
/// another part's.
AxisLine axis_wanted(CasePlan& plan, std::size_t p, const std::string& text)
{
    const int threads = plan.options->threads;
    NewPart& part = plan.parts[p];
    const auto own_point = [&]
    {
        if (symmetry_of(part, threads)) return part.symmetry->line.point;
        return part.body.volume > 0 ? part.body.center : (part.box().min + part.box().max) * 0.5;
    };
    AxisLine out;
    if (text == "x" || text == "y" || text == "z")
    {
        out.direction[text[0] - 'x'] = 1;
        out.point = own_point();
        return out;
    }
    const std::size_t colon = text.find(':');
    if (text.find(',') != std::string::npos)
    {
        out.point =
            colon == std::string::npos ? own_point() : vector_of(text.substr(0, colon), "--rotate");
        out.direction =
            vector_of(colon == std::string::npos ? text : text.substr(colon + 1), "--rotate");
        const double length = norm(out.direction);
        if (!(length > 0))
            throw UsageError(fmt::format("--rotate: the axis \"{}\" has no direction", text));
        out.direction = out.direction / length;
        return out;
    }
    const std::size_t other = part_named(plan, text,
                                         "--rotate: axis (x, y, z, 0,1,0, "
                                         "POINT:DIRECTION or a part)");
    const auto& found = symmetry_of(plan.parts[other], threads);
    if (!found)
        throw UsageError(fmt::format("--rotate: {} has no axis of symmetry to turn about",
                                     plan.parts[other].name));
    return found->line;
}

std::string near_zero(double value)
{
    return short_number(std::abs(value) < 1e-9 ? 0 : value);
}

/// The axis that a part's own shape has. throws UsageError where it has none
AxisLine axis_found(CasePlan& plan, std::size_t p, std::string& reason)
{
    NewPart& part = plan.parts[p];
    const auto& found = symmetry_of(part, plan.options->threads);
    if (!found)
        throw UsageError(fmt::format(
            "--rotate: {0} turns onto itself about no axis, or about several, so its axis is not "
            "known; give it: {0}=...@z (through its middle), @0,1,0, @{1},{2},{3}:0,0,1 (a point "
            "of "
            "it and its direction) or @PART",
            part.name, near_zero(part.body.center.x), near_zero(part.body.center.y),
            near_zero(part.body.center.z)));
    reason = "its axis is found from its shape: " + times_text(*found);
    return found->line;
}

double degrees_per_s(const std::string& text)
{
    const char* expected = "3000deg/s, 50rad/s or 1500rpm";
    const Quantity q = split_quantity(text, "--rotate", expected);
    if (q.unit == "deg/s" || q.unit.empty()) return q.value;
    if (q.unit == "rad/s") return q.value * 180 / std::numbers::pi;
    if (q.unit == "rpm") return q.value * 6;
    throw UsageError(
        fmt::format("--rotate: \"{}\" is in an unknown unit, expected {}", text, expected));
}

void turn(CasePlan& plan, std::size_t p, const Turning& turning, const std::string& reason)
{
    NewPart& part = plan.parts[p];
    if (part.role == PartRole::Floating)
        throw UsageError(fmt::format("{} cannot float and turn at a given speed", part.name));
    part.role = PartRole::Moving;
    part.turning = turning;
    plan.propose(
        part.name,
        fmt::format("turns at {} deg/s ({} rpm) about {}", short_number(turning.degrees_per_s, 6),
                    short_number(turning.degrees_per_s / 6, 4), axis_text(turning.axis)),
        reason,
        "Above 0 is counter-clockwise seen from the end of the axis. --rotate "
        "PART=3000deg/s@AXIS decides, --fix PART lets it stand.");
}

void apply_rotation(CasePlan& plan, const std::string& entry)
{
    const std::size_t equal = entry.find('=');
    if (equal == std::string::npos || equal == 0)
        throw UsageError(fmt::format(
            "--rotate: \"{}\" is invalid, expected PART=3000deg/s or PART=3000deg/s@AXIS", entry));
    const std::size_t at = entry.find('@', equal);
    Turning turning;
    turning.degrees_per_s = degrees_per_s(
        entry.substr(equal + 1, at == std::string::npos ? std::string::npos : at - equal - 1));
    const std::vector<std::string> names = names_of_list(entry.substr(0, equal));
    std::string reason = "given";
    const std::string axis = at == std::string::npos ? "" : entry.substr(at + 1);
    for (std::size_t k = 0; k < names.size(); ++k)
    {
        const std::size_t p = part_named(plan, names[k], "--rotate");
        if (k == 0)
            turning.axis = axis.empty() || axis == "axis" ? axis_found(plan, p, reason)
                                                          : axis_wanted(plan, p, axis);
        if (plan.parts[p].role == PartRole::Housing)
            throw UsageError(fmt::format(
                "--rotate: {} holds the fluid and stands; --housing chooses another part",
                plan.parts[p].name));
        turn(plan, p, turning, k == 0 ? reason : "with " + names[0]);
    }
}

void apply_rotations(CasePlan& plan)
{
    for (const std::string& entry : plan.options->rotations) apply_rotation(plan, entry);
    if (plan.kind != CaseKind::Gearbox || !plan.options->rotations.empty()) return;
    std::vector<std::string> names;
    for (const NewPart& part : plan.parts)
        if (part.role == PartRole::Fixed) names.push_back(part.name);
    if (!plan.options->ask)
        throw UsageError(fmt::format(
            "--rotate PART=3000deg/s is missing: in a gearbox something turns; which of {}?",
            fmt::join(names, ", ")));
    apply_rotation(
        plan, plan.options->ask(
                  fmt::format("What turns, as PART=3000deg/s ({})?", fmt::join(names, ", ")), ""));
}

bool is_same_line(const AxisLine& a, const AxisLine& b, double within)
{
    if (std::abs(dot(a.direction, b.direction)) < 1 - 1e-5) return false;
    const Vec3 way = b.point - a.point;
    return norm(way - dot(way, a.direction) * a.direction) < within;
}

/// Whether a part may be set in motion by another.
bool may_follow(const CasePlan& plan, const NewPart& part)
{
    if (part.role != PartRole::Fixed || part.turning) return false;
    for (const std::string& fixed : plan.options->fixed)
        if (part_named(plan, fixed, "--fix") == static_cast<std::size_t>(&part - plan.parts.data()))
            return false;
    return true;
}

/// A part on the axis of one that turns, and touching it, turns with it, but for bearings.
bool follow_on_axis(CasePlan& plan, std::size_t p, std::size_t mover)
{
    NewPart& part = plan.parts[p];
    const NewPart& other = plan.parts[mover];
    if (!plan.pair(p, mover).touches || has_word(part.name, {"bearing", "seal", "bush"}))
        return false;
    const auto& symmetry = symmetry_of(part, plan.options->threads);
    if (!symmetry || !is_same_line(symmetry->line, other.turning->axis, 2e-3 * size_of(part)))
        return false;
    turn(plan, p, *other.turning, fmt::format("it touches {} and lies on its axis", other.name));
    return true;
}

/// A gear that meshes with one that turns gets its speed by their teeth.
bool follow_by_teeth(CasePlan& plan, std::size_t p, std::size_t mover)
{
    constexpr int least_teeth = 6;
    constexpr double mesh_within = 0.03; // of the smaller one's size
    NewPart& part = plan.parts[p];
    NewPart& other = plan.parts[mover];
    if (plan.pair(p, mover).gap.distance > mesh_within * std::min(size_of(part), size_of(other)))
        return false;
    const int threads = plan.options->threads;
    const auto& own = symmetry_of(part, threads);
    const auto& driving = symmetry_of(other, threads);
    if (!own || !driving || own->times < least_teeth || driving->times < least_teeth) return false;
    if (!is_same_line(driving->line, other.turning->axis, 2e-3 * size_of(other)) ||
        std::abs(dot(own->line.direction, driving->line.direction)) < 1 - 1e-5 ||
        is_same_line(own->line, driving->line, 2e-3 * size_of(part)))
        return false;
    const double along = dot(own->line.direction, other.turning->axis.direction) > 0 ? -1 : 1;
    const double speed = along * other.turning->degrees_per_s * driving->times / own->times;
    turn(plan, p, {own->line, speed},
         fmt::format("it meshes with {}, {} teeth against {}", other.name, driving->times,
                     own->times));
    return true;
}

void follow_movers(CasePlan& plan)
{
    for (bool changes = true; changes;)
    {
        changes = false;
        for (std::size_t p = 0; p < plan.parts.size() && !changes; ++p)
            for (std::size_t m = 0; m < plan.parts.size() && !changes; ++m)
                if (p != m && may_follow(plan, plan.parts[p]) && plan.parts[m].turning)
                    changes = follow_on_axis(plan, p, m) || follow_by_teeth(plan, p, m);
    }
}

/// Wheels of a vehicle: round about y, and down to the ground.
void roll_wheels(CasePlan& plan)
{
    if (plan.kind != CaseKind::Wading || !plan.speed) return;
    double ground = plan.parts[0].box().min.z;
    for (const NewPart& part : plan.parts) ground = std::min(ground, part.box().min.z);
    for (std::size_t p = 0; p < plan.parts.size(); ++p)
    {
        NewPart& part = plan.parts[p];
        const Vec3 size = part.box().max - part.box().min;
        if (!may_follow(plan, part) || part.box().min.z - ground > 0.1 * size.z ||
            std::abs(size.x - size.z) > 0.05 * size.z)
            continue;
        const auto& found = symmetry_of(part, plan.options->threads);
        if (!found || (found->times > 0 && found->times < 4)) continue;
        if (std::abs(found->line.direction.y) < 0.99)
        {
            plan.warnings.push_back(fmt::format(
                "{} stands on the ground, but its axis is not y: it does not roll. The vehicle "
                "drives along x; turn the parts so that wheels turn about y.",
                part.name));
            continue;
        }
        const double radius = found->line.point.z - part.box().min.z;
        turn(plan, p, {found->line, *plan.speed / radius * 180 / std::numbers::pi},
             fmt::format("a wheel: it stands on the ground and {}; it rolls at {} m/s, its radius "
                         "is {} m",
                         times_text(*found), short_number(*plan.speed), short_number(radius)));
    }
}

void list_fixed(CasePlan& plan)
{
    for (NewPart& part : plan.parts)
    {
        if (part.role == PartRole::Housing)
            plan.propose(part.name, "holds the fluid, stands", part.role_reason,
                         "--housing PART chooses another one.");
        else if (part.role == PartRole::Fixed)
            plan.propose(part.name, "stands", "nothing moves it",
                         "--rotate PART=3000deg/s or --float PART=400 does.");
    }
}

} // namespace

void choose_motion(CasePlan& plan)
{
    apply_rotations(plan);
    roll_wheels(plan);
    follow_movers(plan);
    list_fixed(plan);
}

} // namespace fppg
