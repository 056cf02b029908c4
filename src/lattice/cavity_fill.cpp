#include "lattice/cavity_fill.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "core/text.h"
#include "lattice/cavity.h"
#include "lattice/fill_level.h"
#include "lattice/point_text.h"
#include "platform/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

constexpr std::size_t gaps_logged = 50;
constexpr std::size_t gaps_warned_of = 5;
/// Of what is asked for, by which whole rows are off.
constexpr double largest_of_rows = 0.01;
/// Ways out up to so much wider than what is closed anyway are looked for.
constexpr int widest_leak_nodes = 12;
/// Of all sets of spans that are held at the same time, a column of the box.
constexpr double bytes_per_column = 160;

std::string text(const CavityGap& gap)
{
    return fmt::format("{} nodes near {}{}", gap.nodes, text(gap.center),
                       gap.leads_outside ? ", to the outside" : ", to another closed space");
}

class CavityFill
{
public:
    CavityFill(const RunField& field, const CavityFillOp& op, int threads, CavityFillReport& report)
        : field_(field), op_(op), threads_(threads), report_(report)
    {
        options_.seed = snap(op.seed, field.grid);
        options_.up = op.up;
        options_.gap_nodes = op.gap_nodes;
    }

    std::vector<Spans> run()
    {
        if (!is_inside(options_.seed, field_.grid))
            throw GeometryError(fmt::format("the seed {} lies outside the domain", text(op_.seed)));
        check_memory();
        Cavity cavity = find_cavity(field_, options_, threads_);
        if (cavity.opening && cavity.node_count == 0)
            fail_open(cavity, "nothing below the seed is enclosed");
        const FillLevel level = level_of(cavity);
        tell(cavity, level);
        std::vector<Spans> nodes(cavity.nodes.size());
        parallel_for(nodes.size(), threads_,
                     [&](std::size_t x)
                     {
                         if (level.nodes == 0) return;
                         nodes[x] = nodes_up_to(cavity.nodes[x], static_cast<std::int64_t>(x),
                                                heights_, level.height + NodeHeights::tolerance);
                     });
        return nodes;
    }

private:
    /// Metres along `up` of a height in dp, and back.
    double metres(double height) const
    {
        return dot(field_.grid.origin, op_.up) + height * field_.grid.dp;
    }
    double in_dp(double level) const
    {
        return (level - dot(field_.grid.origin, op_.up)) / field_.grid.dp;
    }

    double litres_per_node() const
    {
        const double dp = field_.grid.dp;
        return 1000 * dp * dp * (field_.grid.is_2d ? 1 : dp);
    }
    double litres(std::uint64_t nodes) const
    {
        return static_cast<double>(nodes) * litres_per_node();
    }
    const char* litre_name() const
    {
        return field_.grid.is_2d ? "litres a metre of width" : "litres";
    }

    void check_memory() const
    {
        Box3 drawn;
        for (std::size_t x = 0; x < field_.slabs.size(); ++x)
            for (const Run& r : field_.slabs[x])
                drawn.add({static_cast<double>(x), static_cast<double>(r.y), 0});
        if (drawn.is_empty()) return;
        const double room = 2.0 * op_.gap_nodes + 3;
        const double columns =
            (drawn.max.x - drawn.min.x + room) * (drawn.max.y - drawn.min.y + room);
        if (columns * bytes_per_column > static_cast<double>(available_memory()))
            throw GeometryError(fmt::format(
                "the box around all that is drawn has {:g} columns of nodes, more than fit into "
                "this machine's memory; a larger dp needs less",
                columns));
    }

    FillLevel level_of(const Cavity& cavity) const
    {
        const auto count = static_cast<double>(cavity.node_count);
        switch (op_.measure)
        {
            case FillMeasure::Level:
            {
                const double limit = in_dp(op_.amount);
                if (cavity.opening && limit > cavity.opening->height - NodeHeights::tolerance)
                    fail_open(cavity, fmt::format("the level {:g} is not below it", op_.amount));
                return level_at(cavity.nodes, heights_, limit, threads_);
            }
            case FillMeasure::Litres:
            {
                const double wanted = op_.amount / litres_per_node();
                // Half a node is what rounding can be about.
                if (wanted > count + 0.5)
                {
                    const std::string holds = fmt::format(
                        "the cavity of the seed {} holds {:.6g} {}{}, {:g} are wanted",
                        text(op_.seed), litres(cavity.node_count), litre_name(),
                        cavity.opening ? fmt::format(" up to its lowest way out at height {:g} "
                                                     "near {}",
                                                     metres(cavity.opening->height),
                                                     text(cavity.opening->place))
                                       : "",
                        op_.amount);
                    if (cavity.opening) throw GeometryError(holds + narrowest_place());
                    throw GeometryError(holds +
                                        (cavity.gaps.empty() ? "" : "; " + closed_gaps(cavity)));
                }
                return level_of_count(cavity.nodes, heights_, wanted, threads_);
            }
            case FillMeasure::Percent:
                break;
        }
        if (cavity.opening)
            fail_open(cavity, "percent needs a closed cavity (a level or litres do not)");
        return level_of_count(cavity.nodes, heights_, op_.amount / 100 * count, threads_);
    }

    [[noreturn]] void fail_open(const Cavity& cavity, const std::string& why) const
    {
        throw GeometryError(fmt::format(
            "the cavity of the seed {} is not closed: the lowest way out is at height {:g} near "
            "{}, and {}{}",
            text(op_.seed), metres(cavity.opening->height), text(cavity.opening->place), why,
            narrowest_place()));
    }

    /// Where the way out of an open cavity is narrowest: what has to be closed so that it is shut.
    std::string narrowest_place() const
    {
        CavityOptions wider = options_;
        for (int more = 0; more < widest_leak_nodes; ++more)
        {
            ++wider.gap_nodes;
            Cavity cavity;
            try
            {
                cavity = find_cavity(field_, wider, threads_);
            }
            catch (const GeometryError&)
            {
                return ""; // the seed does not fit either: there is no narrow place
            }
            if (cavity.opening) continue;
            std::vector<std::string> places;
            for (const CavityGap& gap : cavity.gaps)
                if (gap.leads_outside && places.size() < gaps_warned_of)
                    places.push_back(fmt::format("{} near {}", counted(gap.nodes, "node", "nodes"),
                                                 text(gap.center)));
            return fmt::format("; it leaks through an opening {} wide, gapclose=\"{}\" closes: {}",
                               counted(static_cast<std::size_t>(wider.gap_nodes), "node", "nodes"),
                               wider.gap_nodes, fmt::join(places, "; "));
        }
        return "";
    }

    /// Where that is far from what is asked for.
    void tell_of_whole_rows(const Cavity& cavity, const FillLevel& level)
    {
        if (op_.measure == FillMeasure::Level) return;
        const double wanted = op_.measure == FillMeasure::Litres
                                  ? op_.amount
                                  : op_.amount / 100 * litres(cavity.node_count);
        const double share = litres(level.nodes) / wanted - 1;
        if (std::abs(share) <= largest_of_rows) return;
        report_.warnings.push_back(fmt::format(
            "the fill has {:.4g} {}, {:.1f} % {} than the {:.4g} asked for, as it ends with a "
            "whole "
            "row of nodes. A smaller dp comes nearer; where walls are body-fitted <fluidband "
            "mass=\"exact\"> gives its particles the mass of what is asked for.",
            litres(level.nodes), litre_name(), 100 * std::abs(share), share > 0 ? "more" : "less",
            wanted));
    }

    void tell(const Cavity& cavity, const FillLevel& level)
    {
        const auto share = [&](std::uint64_t nodes)
        { return 100 * static_cast<double>(nodes) / static_cast<double>(cavity.node_count); };
        report_.filled.cavity_nodes = cavity.node_count;
        report_.filled.nodes = level.nodes;
        report_.filled.litres_per_node = litres_per_node();
        report_.filled.level = metres(level.height);
        if (cavity.opening) report_.filled.open_at = metres(cavity.opening->height);
        std::string up;
        if (op_.up != Vec3{0, 0, 1}) up = " along " + text(op_.up);
        report_.log.push_back(fmt::format(
            "the cavity holds {:.6g} {}, {} nodes, {}", litres(cavity.node_count), litre_name(),
            cavity.node_count,
            cavity.opening
                ? fmt::format("open from height {:g} on near {}", metres(cavity.opening->height),
                              text(cavity.opening->place))
                : "closed"));
        report_.log.push_back(
            level.nodes == 0
                ? "nothing filled"
                : fmt::format("filled {} nodes, {:.6g} {}, {:.4g} % of the cavity, level {:g}{}",
                              level.nodes, litres(level.nodes), litre_name(), share(level.nodes),
                              metres(level.height), up));
        if (level.nodes == 0)
            report_.warnings.push_back(fmt::format(
                "the fill added no node: the lowest node of the cavity is at height {:g}{}",
                metres(level.height), up));
        else
            tell_of_whole_rows(cavity, level);
        if (cavity.gaps.empty()) return;
        for (std::size_t i = 0; i < std::min(cavity.gaps.size(), gaps_logged); ++i)
            report_.log.push_back(fmt::format("gap {}: {}", i + 1, text(cavity.gaps[i])));
        if (cavity.gaps.size() > gaps_logged)
            report_.log.push_back(
                fmt::format("and {} gaps more", cavity.gaps.size() - gaps_logged));
        report_.warnings.push_back(fmt::format(
            "{}. gapclose=\"0\" leaves gaps open; a closed space behind one can have a fill of its "
            "own.",
            closed_gaps(cavity)));
    }

    std::string closed_gaps(const Cavity& cavity) const
    {
        const std::size_t n = cavity.gaps.size();
        std::vector<std::string> places;
        for (std::size_t i = 0; i < std::min(n, gaps_warned_of); ++i)
            places.push_back(text(cavity.gaps[i]));
        return fmt::format(
            "{} up to {} wide {} closed, so that the fill does not leak: {}{}",
            counted(n, "gap", "gaps"),
            counted(static_cast<std::size_t>(op_.gap_nodes), "node", "nodes"),
            n == 1 ? "is" : "are", fmt::join(places, "; "),
            n > gaps_warned_of ? fmt::format("; and {} more", n - gaps_warned_of) : "");
    }

    const RunField& field_;
    const CavityFillOp& op_;
    int threads_;
    CavityFillReport& report_;
    CavityOptions options_;
    NodeHeights heights_{up_in_steps(op_.up, field_.grid), {0, 0, 0}};
};

} // namespace

std::vector<Spans> fill_cavity(const RunField& field, const CavityFillOp& op, int threads,
                               CavityFillReport& report)
{
    return CavityFill(field, op, threads, report).run();
}

} // namespace fppg
