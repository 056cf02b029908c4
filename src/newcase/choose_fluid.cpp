#include "newcase/plan.h"

#include "core/nearest_word.h"
#include "core/text.h"
#include "fppg/error.h"
#include "newcase/vessel_space.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace fppg
{

namespace
{

struct LiquidRow
{
    const char* name;
    double rhop0;     ///< kg/m3
    double viscosity; ///< m2/s
    const char* about;
};

constexpr std::array<LiquidRow, 7> liquids{{
    {"water", 1000, 1e-6, "water at 20 degrees C"},
    {"seawater", 1025, 1.05e-6, "sea water at 20 degrees C"},
    {"oil", 850, 5e-5, "gear oil in service, 50 mm2/s"},
    {"gearoil", 850, 5e-5, "gear oil in service, 50 mm2/s"},
    {"atf", 840, 3e-5, "transmission fluid at 40 degrees C"},
    {"petrol", 745, 6e-7, "petrol at 20 degrees C"},
    {"diesel", 835, 3e-6, "diesel at 40 degrees C"},
}};

Liquid liquid_named(const std::string& name)
{
    std::vector<std::string_view> names;
    for (const LiquidRow& row : liquids)
    {
        names.emplace_back(row.name);
        if (lower_case(name) == row.name) return {row.name, row.rhop0, row.viscosity, row.about};
    }
    throw UsageError(fmt::format("--fill: the liquid \"{}\" is not known{}, expected {}", name,
                                 did_you_mean(name, names), fmt::join(names, ", ")));
}

/// "oil=2.5l@housing": the amount. The part behind @ is found before.
void read_fill(CasePlan& plan, const std::string& text, VesselFill& fill)
{
    const char* expected = "oil=2.5l, oil=60% or oil=0.12m (its level), and @PART for the housing";
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos)
        throw UsageError(fmt::format("--fill: \"{}\" is invalid, expected {}", text, expected));
    plan.liquid = liquid_named(text.substr(0, equal));
    const Quantity q =
        split_quantity(text.substr(equal + 1, text.find('@') - equal - 1), "--fill", expected);
    const std::string unit = lower_case(q.unit);
    if (unit == "l" || unit == "ml")
        fill.amount = FluidAmount::Litres;
    else if (unit == "%")
        fill.amount = FluidAmount::Percent;
    else if (unit == "m" || unit == "mm")
        fill.amount = FluidAmount::Level;
    else
        throw UsageError(fmt::format("--fill: \"{}\" is invalid, expected {}", text, expected));
    fill.value = q.value * (unit == "ml" || unit == "mm" ? 1e-3 : 1);
    if (fill.amount != FluidAmount::Level && !(fill.value > 0))
        throw UsageError(fmt::format("--fill: \"{}\" fills nothing, expected {}", text, expected));
}

std::string open_edges_text(const NewPart& part)
{
    if (part.report.is_watertight) return "";
    for (std::size_t e = 0; e < part.mesh.edges.size(); ++e)
        if (part.mesh.edge_facets[e][1] == no_index)
            return fmt::format("; its mesh has {} open edges, the first at {}",
                               part.report.open_edges,
                               place_text(part.mesh.vertices[part.mesh.edges[e][0]]));
    return "";
}

/// The level and volume of a fill in its vessel.
void measure_fill(CasePlan& plan, VesselFill& fill, const VesselSpace& room)
{
    const NewPart& vessel = plan.parts[fill.vessel];
    const double all = room.capacity();
    const std::string holds = fmt::format("{} l", short_number(1000 * all, 3));
    fill.volume = fill.amount == FluidAmount::Litres    ? fill.value / 1000
                  : fill.amount == FluidAmount::Percent ? fill.value / 100 * all
                                                        : room.volume_below(fill.value);
    fill.level = fill.amount == FluidAmount::Level ? fill.value : room.level_of(fill.volume);
    fill.bottom = room.bottom();
    const bool is_below = fill.amount == FluidAmount::Level && fill.level <= room.bottom();
    if (is_below)
        throw UsageError(fmt::format(
            "the level z = {} m is below the bottom of the room in {}, which is from z = {} to {} "
            "m; levels are heights along z",
            short_number(fill.level), vessel.name, short_number(room.bottom()),
            short_number(room.rim())));
    const bool is_over = fill.volume > 1.02 * all || (fill.amount == FluidAmount::Level &&
                                                      fill.level > room.rim() + room.spacing());
    if (!is_over) return;
    if (room.is_closed())
        throw UsageError(fmt::format("{} holds {} at most, {} l are asked for", vessel.name, holds,
                                     short_number(1000 * fill.volume, 3)));
    throw GeometryError(fmt::format(
        "{}: the part is open: fluid runs out over z = {} m near {}, and below that it holds {}{}. "
        "Expected a closed housing, or less fluid. Add the lid or close the opening, or give less",
        vessel.path, short_number(room.rim()), place_text(room.rim_place()), holds,
        open_edges_text(vessel)));
}

void fill_vessel(CasePlan& plan, std::size_t vessel, VesselFill fill)
{
    const VesselSpace room(plan, vessel);
    NewPart& part = plan.parts[vessel];
    const Vec3 size = part.box().max - part.box().min;
    if (room.is_empty() || room.capacity() < 1e-3 * size.x * size.y * size.z)
        throw GeometryError(fmt::format(
            "{}: the part encloses no room that holds fluid, it is open below or solid{}. Expected "
            "a "
            "housing with its inner walls, closed below along z; --up y where the files have y "
            "upwards, --housing PART for another one",
            part.path, open_edges_text(part)));
    fill.vessel = vessel;
    measure_fill(plan, fill, room);
    // The share of a vessel that is open is known here only; <fill> wants litres of it then.
    if (fill.amount == FluidAmount::Percent && !room.is_closed())
    {
        fill.amount = FluidAmount::Litres;
        fill.value = round_nearest(1000 * fill.volume, 4);
    }
    fill.seed = room.seed(fill.level);
    for (int axis = 0; axis < 3; ++axis) fill.seed[axis] = round_nearest(fill.seed[axis], 4);
    plan.fill = fill;
    plan.depth = fill.level - fill.bottom;
    plan.propose(
        plan.liquid.name,
        fmt::format("{} l in {}, up to z = {} m", short_number(1000 * fill.volume, 4), part.name,
                    short_number(fill.level)),
        fmt::format("{} holds {} l {}", part.name, short_number(1000 * room.capacity(), 3),
                    room.is_closed() ? "and is closed"
                                     : fmt::format("up to where it is open, z = {} m",
                                                   short_number(room.rim()))),
        fmt::format("{}: {} kg/m3, {} m2/s. The room is measured on {} mm; the program fills it to "
                    "its dp. --fill {}=60% or ={}m give a share or a level.",
                    plan.liquid.about, plan.liquid.rhop0, plan.liquid.viscosity,
                    short_number(1000 * room.spacing(), 3), plan.liquid.name,
                    short_number(fill.level, 3)));
    if (!room.is_closed())
        plan.warnings.push_back(
            fmt::format("{} is open above z = {} m, near {}: fluid that splashes gets out there.",
                        part.name, short_number(room.rim()), place_text(room.rim_place())));
    if (!part.report.is_watertight)
        plan.warnings.push_back(fmt::format(
            "{}: the part is no closed solid{}: its walls are sheets, whose particles stand on the "
            "side away from the fluid. Close it where it was made for walls as thick as they are.",
            part.path, open_edges_text(part)));
}

double asked_water(CasePlan& plan, double ground)
{
    if (plan.options->water) return *plan.options->water;
    if (!plan.options->ask)
        throw UsageError("--water Z is missing: the height of the water along z, metres");
    const std::string answer = plan.options->ask(
        fmt::format("How high is the water, along z in metres? The parts stand at z = {}",
                    short_number(ground)),
        "");
    const Quantity q = split_quantity(answer, "water", "metres");
    return q.value;
}

/// The box round the parts, with margins of their size.
void place_water_box(CasePlan& plan)
{
    Box3 all;
    for (const NewPart& part : plan.parts)
    {
        all.add(part.box().min);
        all.add(part.box().max);
    }
    const Vec3 size = all.max - all.min;
    const bool flows = plan.kind == CaseKind::Wading || plan.kind == CaseKind::Obstacle;
    WaterBox out;
    out.flows = flows;
    out.level = asked_water(plan, all.min.z);
    double ground = all.min.z;
    if (plan.kind == CaseKind::Floating)
        ground = std::min(all.min.z, out.level) - std::max({size.x, size.y, size.z}) / 2;
    ground = round_nearest(ground, 4);
    if (out.level <= ground)
        throw UsageError(fmt::format(
            "--water: z = {} m is not above the ground, z = {} m, where the parts stand; it is the "
            "height of the water along z",
            short_number(out.level), short_number(ground)));
    plan.depth = out.level - ground;
    const double wide = std::max(size.x, size.y);
    const double side = plan.kind == CaseKind::Wading     ? 0.5 * size.y
                        : plan.kind == CaseKind::Obstacle ? 1.5 * std::max(size.y, 0.3 * size.x)
                                                          : 0.75 * wide;
    const double front = plan.kind == CaseKind::Wading     ? 0.5 * size.x
                         : plan.kind == CaseKind::Obstacle ? 2.0 * std::max(size.x, 0.5 * size.y)
                                                           : 0.75 * wide;
    out.box = {{all.min.x - front, all.min.y - side, ground},
               {all.max.x + front, all.max.y + side,
                out.level + std::max(0.5 * plan.depth, 0.25 * size.z)}};
    for (int axis = 0; axis < 2; ++axis)
    {
        out.box.min[axis] = round_nearest(out.box.min[axis], 3);
        out.box.max[axis] = round_nearest(out.box.max[axis], 3);
    }
    out.box.max.z = round_up(out.box.max.z, 3);
    const Vec3 inner = out.box.max - out.box.min;
    double displaced = 0;
    for (const NewPart& part : plan.parts)
    {
        const double height = part.box().max.z - part.box().min.z;
        const double wet = std::clamp((out.level - part.box().min.z) / height, 0.0, 1.0);
        displaced += wet * std::abs(part.report.volume);
    }
    out.volume = std::max(inner.x * inner.y * plan.depth - displaced, 0.0);
    out.seed = {out.box.max.x - 0.3 * front, (out.box.min.y + out.box.max.y) / 2,
                ground + 0.5 * plan.depth};
    for (int axis = 0; axis < 3; ++axis) out.seed[axis] = round_nearest(out.seed[axis], 4);
    plan.water = out;
    plan.propose(
        plan.liquid.name,
        fmt::format("{} m deep, up to z = {} m", short_number(plan.depth), short_number(out.level)),
        plan.options->water ? "given" : "answered",
        fmt::format("{}: {} kg/m3, {} m2/s.", plan.liquid.about, plan.liquid.rhop0,
                    plan.liquid.viscosity));
    plan.propose(flows ? "channel" : "basin",
                 fmt::format("{} x {} m, walls up to z = {} m", short_number(inner.x),
                             short_number(inner.y), short_number(out.box.max.z)),
                 flows
                     ? "no part holds the water: a bed with two walls along x, its ends are joined"
                     : "no part holds the water: walls round the parts, three quarters of their "
                       "size away",
                 "Edit the box in the definition to move its walls; --housing PART takes a part in "
                 "its place.");
}

} // namespace

void choose_fluid(CasePlan& plan)
{
    plan.liquid = liquid_named("water");
    const NewCaseOptions& o = *plan.options;
    std::size_t vessel = plan.parts.size();
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
        if (plan.parts[i].role == PartRole::Housing) vessel = i;
    VesselFill fill;
    std::string amount = o.fill;
    if (amount.empty() && !o.water && vessel < plan.parts.size())
    {
        if (!o.ask)
            throw UsageError(fmt::format(
                "--fill is missing: how much fluid is in {}? Expected oil=2.5l, oil=60% or "
                "oil=0.12m (its level along z), or --water Z",
                plan.parts[vessel].name));
        amount = o.ask(fmt::format("How much fluid is in {}, as oil=2.5l, water=60% or oil=0.12m?",
                                   plan.parts[vessel].name),
                       plan.kind == CaseKind::Gearbox ? "oil=30%" : "water=50%");
    }
    if (!amount.empty() && vessel == plan.parts.size())
        throw UsageError("--fill: no part holds the fluid; --fill LIQUID=...@PART names it");
    if (!amount.empty())
        read_fill(plan, amount, fill);
    else if (vessel < plan.parts.size())
        fill = {vessel, FluidAmount::Level, asked_water(plan, 0), {}, 0, 0, 0};
    if (vessel == plan.parts.size())
    {
        place_water_box(plan);
        return;
    }
    // A tank whose parts hold no water is a basin with parts in it.
    if (plan.kind == CaseKind::Tank && o.housing.empty() && o.fill.empty() &&
        VesselSpace(plan, vessel).is_empty())
    {
        plan.parts[vessel].role = PartRole::Fixed;
        for (Proposal& p : plan.proposals)
            if (p.what == plan.parts[vessel].name && p.value.starts_with("holds"))
                p = {p.what, "stands", "it holds no water, and nothing moves it", ""};
        place_water_box(plan);
        return;
    }
    fill_vessel(plan, vessel, fill);
}

} // namespace fppg
