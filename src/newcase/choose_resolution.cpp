#include "newcase/plan.h"

#include "fppg/error.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fppg
{

namespace
{

constexpr double wall_layers = 3;       // of mDBC with coefh 1
constexpr double usual_particles = 5e5; // minutes on a graphics card
constexpr double most_of_a_case = 2e9;

double moving_speed(const NewPart& part)
{
    if (!part.turning) return 0;
    double farthest = 0;
    for (const Vec3& v : part.mesh.vertices)
    {
        const Vec3 way = v - part.turning->axis.point;
        farthest = std::max(farthest, norm(cross(part.turning->axis.direction, way)));
    }
    return farthest * std::abs(part.turning->degrees_per_s) * std::numbers::pi / 180;
}

/// Parts that turn into each other are no passage, however narrow it is between them.
bool mesh_as_gears(const CasePlan& plan, const PartPair& pair)
{
    const NewPart& a = plan.parts[pair.first];
    const NewPart& b = plan.parts[pair.second];
    const double size = std::min(norm(a.box().max - a.box().min), norm(b.box().max - b.box().min));
    return pair.gap.distance < 0.05 * size && a.turning && b.turning &&
           !(a.turning->axis.point == b.turning->axis.point &&
             a.turning->axis.direction == b.turning->axis.direction);
}

void find_passage(CasePlan& plan)
{
    const PartPair* thinnest = nullptr;
    const PartPair* backlash = nullptr;
    for (const PartPair& pair : plan.pairs)
    {
        if (pair.touches || plan.parts[pair.first].role == PartRole::Inlet ||
            plan.parts[pair.second].role == PartRole::Inlet)
            continue;
        const PartPair*& least = mesh_as_gears(plan, pair) ? backlash : thinnest;
        if (least == nullptr || pair.gap.distance < least->gap.distance) least = &pair;
    }
    if (thinnest != nullptr)
    {
        plan.passage = thinnest->gap.distance;
        plan.passage_at = (thinnest->gap.on_first + thinnest->gap.on_second) * 0.5;
        plan.propose(
            "passage",
            fmt::format("{} mm between {} and {}", short_number(1000 * plan.passage, 3),
                        plan.parts[thinnest->first].name, plan.parts[thinnest->second].name),
            fmt::format("the thinnest between parts that do not touch, at {}",
                        place_text(plan.passage_at)),
            "--across N makes it N dp wide. `fppg check CASE --motion` measures all "
            "gaps while the parts move.");
    }
    if (backlash != nullptr)
        plan.propose(
            "backlash",
            fmt::format("{} mm between {} and {}", short_number(1000 * backlash->gap.distance, 3),
                        plan.parts[backlash->first].name, plan.parts[backlash->second].name),
            "parts that turn into each other, as the files have them",
            "Fluid cannot flow through less than 2 dp; where teeth mesh it is pushed out "
            "sideways.");
}

struct Counted
{
    double fluid = 0;
    double walls = 0;
    double all() const { return fluid + walls; }
};

Counted particles_at(const CasePlan& plan, double dp)
{
    Counted out;
    out.fluid = (plan.fill    ? plan.fill->volume
                 : plan.water ? plan.water->volume
                              : 0) /
                (dp * dp * dp);
    for (const NewPart& part : plan.parts)
    {
        if (part.role == PartRole::Inlet) continue;
        const double layers = wall_layers * part.report.area / (dp * dp);
        const double solid = std::abs(part.report.volume) / (dp * dp * dp);
        // Floating parts are full; layers of a thin wall are all that fits into it.
        const double full = solid + 0.5 * part.report.area / (dp * dp);
        out.walls += part.role == PartRole::Floating ? full
                     : part.report.is_watertight     ? std::min(layers, full)
                                                     : layers;
    }
    if (plan.water)
    {
        const Vec3 s = plan.water->box.max - plan.water->box.min;
        const double sides = plan.water->flows ? 2 * s.x * s.z : 2 * (s.x + s.y) * s.z;
        out.walls += wall_layers * (s.x * s.y + sides) / (dp * dp);
    }
    return out;
}

double dp_for(const CasePlan& plan, double particles)
{
    double low = 1e-9, high = 1e6;
    for (int k = 0; k < 200; ++k)
    {
        const double middle = std::sqrt(low * high);
        (particles_at(plan, middle).all() > particles ? low : high) = middle;
    }
    return high;
}

} // namespace

void choose_resolution(CasePlan& plan)
{
    const NewCaseOptions& o = *plan.options;
    find_passage(plan);
    std::string reason = "given";
    if (o.dp > 0)
        plan.dp = o.dp;
    else if (o.across > 0)
    {
        if (!(plan.passage > 0))
            throw UsageError(
                "--across: no two parts have a passage between them; give --dp or "
                "--particles");
        plan.dp = round_nearest(plan.passage / o.across, 3);
        reason = fmt::format("{} particles across the thinnest passage", short_number(o.across));
    }
    else
    {
        const double wanted = o.particles > 0 ? o.particles : usual_particles;
        plan.dp = round_nearest(dp_for(plan, wanted), 3);
        reason = o.particles > 0 ? fmt::format("for about {:.0f} particles", wanted)
                                 : fmt::format(
                                       "for about {:.0f} particles, as neither --dp, "
                                       "--particles nor --across is given",
                                       wanted);
    }
    const Counted counted = particles_at(plan, plan.dp);
    plan.expected = counted.all();
    if (plan.expected > most_of_a_case)
        throw UsageError(fmt::format(
            "dp {} m makes about {:.2g} particles, more than a case can hold ({:.1g}); is it in "
            "metres? dp {} m makes a million",
            plan.dp, plan.expected, most_of_a_case, short_number(dp_for(plan, 1e6), 3)));
    plan.propose("dp", fmt::format("{} m", plan.dp), reason,
                 fmt::format("About {:.2g} particles of fluid and {:.2g} of walls. A million: dp "
                             "{} m.",
                             counted.fluid, counted.walls, short_number(dp_for(plan, 1e6), 3)));
    plan.propose("particles", fmt::format("about {:.0f}", round_nearest(plan.expected, 2)),
                 fmt::format("{:.0f} of fluid, the others are walls in {} layers",
                             round_nearest(counted.fluid, 2), wall_layers));
    if (plan.depth > 0 && plan.depth < 6 * plan.dp)
        plan.warnings.push_back(
            fmt::format("The fluid is only {} dp deep; expected 6 at least: dp {} m or smaller.",
                        short_number(plan.depth / plan.dp, 2), short_number(plan.depth / 8, 2)));
    if (plan.passage > 0 && plan.passage < 3 * plan.dp)
        plan.warnings.push_back(fmt::format(
            "The thinnest passage between parts, at {}, is {} dp wide: fluid needs 3 or more to "
            "flow through it. dp {} m would do, with about {:.2g} particles (--across 4).",
            place_text(plan.passage_at), short_number(plan.passage / plan.dp, 2),
            short_number(plan.passage / 4, 3), particles_at(plan, plan.passage / 4).all()));
}

void choose_constants(CasePlan& plan)
{
    constexpr double gravity = 9.81;
    const double by_depth = std::sqrt(2 * gravity * std::max(plan.depth, plan.dp));
    double by_parts = 0;
    std::string fastest_part;
    for (const NewPart& part : plan.parts)
        if (moving_speed(part) > by_parts)
        {
            by_parts = moving_speed(part);
            fastest_part = part.name;
        }
    const double stream = std::abs(plan.speed.value_or(0));
    double by_inlets = 0;
    for (const FluidInlet& inlet : plan.inlets) by_inlets = std::max(by_inlets, inlet.speed);
    plan.fastest = std::max({by_depth, by_parts, stream, by_inlets});
    plan.speed_sound = round_up(10 * plan.fastest, 2);
    const std::string of = plan.fastest == stream     ? "the stream"
                           : plan.fastest == by_parts ? "the outermost places of " + fastest_part
                                                      : "fluid that falls by its depth";
    plan.propose(
        "speed of sound", fmt::format("{} m/s", plan.speed_sound),
        fmt::format("ten times the largest speed, {} m/s of {}", short_number(plan.fastest, 3), of),
        "So densities change by about 1 %; that of the real liquid would cost a time "
        "step a hundred times smaller.");
    const double h = std::sqrt(3.0) * plan.dp;
    const double for_liquid = 10 * plan.liquid.viscosity / (h * plan.speed_sound);
    plan.visco = std::max(0.01, round_nearest(for_liquid, 2));
    plan.propose("viscosity", fmt::format("artificial, {}", plan.visco),
                 for_liquid > 0.01
                     ? fmt::format("stands for the {} m2/s of the {} (a h c / 10)",
                                   plan.liquid.viscosity, plan.liquid.name)
                     : fmt::format("the least that keeps particles even; it stands for {} m2/s, "
                                   "more than the {} m2/s of the {}, at this dp",
                                   short_number(plan.visco * h * plan.speed_sound / 10, 2),
                                   plan.liquid.viscosity, plan.liquid.name));
    Box3 all;
    double slowest = std::numeric_limits<double>::infinity();
    for (const NewPart& part : plan.parts)
    {
        all.add(part.box().min);
        all.add(part.box().max);
        if (part.turning) slowest = std::min(slowest, std::abs(part.turning->degrees_per_s));
    }
    const Vec3 size = all.max - all.min;
    std::string reason = "given";
    if (plan.options->duration)
        plan.duration = *plan.options->duration;
    else if (stream > 0)
    {
        const Vec3 channel = plan.water ? plan.water->box.max - plan.water->box.min : size;
        plan.duration = 2 * channel.x / stream;
        reason = "the stream passes through the channel twice";
    }
    else if (std::isfinite(slowest) && slowest > 0)
    {
        plan.duration = 3 * 360 / slowest;
        reason = "the slowest part turns three times";
    }
    else
    {
        plan.duration = 20 * std::sqrt(std::max(plan.depth, 0.1 * norm(size)) / gravity);
        reason = "twenty times what fluid needs to fall by its depth";
    }
    if (!plan.options->duration) plan.duration = round_nearest(plan.duration, 2);
    plan.time_out = round_nearest(plan.duration / 100, 2);
    plan.propose(
        "duration", fmt::format("{} s", plan.duration), reason,
        fmt::format("An output every {} s: a hundred of them. --time decides.", plan.time_out));
}

} // namespace fppg
