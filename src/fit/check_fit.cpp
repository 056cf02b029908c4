#include "fit/check_fit.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace fppg
{
namespace
{

/// With room for rounding.
constexpr double largest_deviation = 0.02 + 1e-9;
/// Of the nodes in a body that fills gave particles.
constexpr double nearly_all = 0.98;
/// A plate of this mean thickness or less has no room for nodes between the particles of its sides.
constexpr double thin_dp = 2;
/// Below so many dp^2 the particles of edges and corners are a share of all that counts.
constexpr double small_surface = 1000;

struct Deviation
{
    double share = 0; ///< what came out over what was expected, less 1
    std::string text;
};

std::string percent(double share)
{
    return fmt::format("{:+.3g} %", 100 * share);
}

std::string why_volume(const FitSettings* settings, const FittedBody& body, double dp)
{
    const FitFigures& figures = body.figures;
    const double thickness = 2 * figures.volume / ((figures.area + figures.second_sheet) * dp);
    if (settings != nullptr && settings->clearance_dp)
        return fmt::format("its clearance is given, {:g} dp", *settings->clearance_dp);
    if (thickness < thin_dp && figures.second_sheet > 0)
        return fmt::format("it is thin, {:.2g} dp on average, and a sheet is as if dp thick",
                           thickness);
    if (thickness < thin_dp)
        return fmt::format("it is thin, {:.2g} dp on average, and both of its sides have particles",
                           thickness);
    if (!body.report.is_watertight) return "its mesh is not closed, and what is inside is a guess";
    return "it is small against dp, or thin in places";
}

/// Of the volume of a solid.
Deviation volume_deviation(const FitSettings* settings, const FittedBody& body, double dp)
{
    const FitFigures& figures = body.figures;
    if (figures.filled < nearly_all) return {};
    const double got = figures.node_volume + figures.wall_volume;
    Deviation out;
    out.share = got / figures.volume - 1;
    out.text = fmt::format(
        "its particles stand for {:.4g} m^3, those on its surface for half of dp^3 each; its "
        "shape has {:.4g} m^3 ({}): {}.",
        got, figures.volume, percent(out.share), why_volume(settings, body, dp));
    return out;
}

Deviation area_deviation(const FitSettings* settings, const FittedBody& body, double dp)
{
    const FitFigures& figures = body.figures;
    const double expected = figures.area / (dp * dp);
    if (!(expected > 0)) return {};
    std::string why = "its edges stand nearer to one another than particles do";
    if (settings != nullptr && settings->density == FitDensity::Cell)
        why = "density=\"cell\" asks for one a cell";
    else if (expected < small_surface)
        why = "it is small against dp";
    Deviation out;
    out.share = figures.wall_particles / expected - 1;
    out.text = fmt::format(
        "{:.0f} particles stand on its surface of {:.4g} m^2, one a dp^2 would "
        "be {:.0f} ({}): {}.",
        figures.wall_particles, figures.area, expected, percent(out.share), why);
    return out;
}

} // namespace

std::vector<std::string> check_fit(const FitDef& settings, const FittedWalls& walls, double dp)
{
    struct Group
    {
        std::size_t worst = 0;
        std::size_t count = 0;
        Deviation deviation;
    };
    using Key = std::tuple<int, std::string, int>; ///< line, name, what deviates
    std::map<Key, Group> groups;
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
    {
        const FittedBody& body = walls.bodies[b];
        const FitSettings* of_mk = fit_settings(settings, body.mk);
        const auto note = [&](int what, Deviation deviation)
        {
            if (!(std::abs(deviation.share) > largest_deviation)) return;
            Group& group = groups[{body.line, body.name, what}];
            if (++group.count > 1 && std::abs(deviation.share) <= std::abs(group.deviation.share))
                return;
            group.worst = b;
            group.deviation = std::move(deviation);
        };
        note(0, volume_deviation(of_mk, body, dp));
        note(1, area_deviation(of_mk, body, dp));
    }
    std::vector<std::string> out;
    for (const auto& [key, group] : groups)
    {
        const FittedBody& body = walls.bodies[group.worst];
        out.push_back(fmt::format("{}: <{}>, mk {}: {}", body.line, body.name, body.mk,
                                  group.deviation.text));
        if (group.count > 1)
            out.back() += fmt::format(" {} bodies of this line differ like this, most this one.",
                                      group.count);
    }
    return out;
}

} // namespace fppg
