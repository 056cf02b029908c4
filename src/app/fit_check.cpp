#include "app/fit_check.h"

#include "fppg/files.h"

#include "app/relax_stage.h"
#include "app/run_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

namespace fppg
{
namespace
{

/// Of volumes and masses; with room for rounding.
constexpr double largest_deviation = 0.01 + 1e-9;
/// Of the number of particles on a surface. Gaps let fluid through; closing them leaves some
/// particles too many on round surfaces, which nodes under them make up for.
constexpr double most_lacking = 0.02 + 1e-9;
constexpr double most_surplus = 0.05 + 1e-9;
/// Of the nodes in a body that fills gave particles.
constexpr double nearly_all = 0.98;
/// A plate of this mean thickness or less has no room for nodes between the particles of its sides.
constexpr double thin_dp = 2;
/// Below this many dp^2 the particles of edges and corners are a share of all that counts.
constexpr double small_surface = 1000;
/// Of a body that its wall's particles stand for, so that nodes make up the rest.
constexpr double room_left = 0.9;
/// Of the particles of a wall: its edges are close to one another.
constexpr double many_on_edges = 0.25;

std::string percent(double share)
{
    constexpr double nothing = 1e-9;
    return fmt::format("{:+.3g} %", std::abs(share) < nothing ? 0 : 100 * share);
}

class FitCheck
{
public:
    FitCheck(const FitDef& settings, const FittedWalls& walls, const LatticeGrid& grid)
        : settings_(settings),
          walls_(walls),
          dp_(grid.dp),
          depth_(grid.is_2d ? grid.dp : 1),
          size_unit_(grid.is_2d ? "m^2" : "m^3"),
          area_unit_(grid.is_2d ? "m" : "m^2"),
          of_kind_(walls.bodies.size())
    {
        for (std::size_t i = 0; i < walls.particles.size(); ++i)
            ++of_kind_[walls.particles.bodies[i]]
                      [static_cast<std::size_t>(walls.particles.kinds[i])];
    }

    /// returns  the line of the log, with those of its layers
    std::string look_at(std::size_t b)
    {
        const FittedBody& body = walls_.bodies[b];
        std::string line = fmt::format("  {} (xml row:{}, mk:{}):", body.name, body.line, body.mk);
        note_if_gone(b);
        const std::string layers =
            layers_text(walls_, b, [&](std::size_t l) { return count_of_layer(l); });
        if (!layers.empty()) line += fmt::format(" layers of {} particles;", layers);
        return line + count_of(b) + volume_of(b);
    }

    std::vector<std::string> warnings() const
    {
        std::vector<std::string> out = gone_;
        for (const auto& [why, group] : counts_)
            out.push_back(fmt::format(
                "particles on fitted surfaces are more or fewer than one per dp^2, {}: {}.", why,
                group.text("mk")));
        for (const auto& [why, group] : volumes_)
            out.push_back(
                fmt::format("fitted particles do not have the volume of their solids, "
                            "{}: {}.",
                            why, group.text("mk")));
        return out;
    }

private:
    /// A body whose last particles gave way to those of others.
    void note_if_gone(std::size_t b)
    {
        const FittedBody& body = walls_.bodies[b];
        std::uint64_t left = 0;
        for (std::size_t l = b; l < walls_.bodies.size() && (l == b || walls_.bodies[l].owner == b);
             ++l)
            for (const std::uint64_t n : of_kind_[l]) left += n;
        const std::size_t crowded =
            std::accumulate(body.left_out.begin(), body.left_out.end(), std::size_t{0});
        if (left > 0 || crowded == 0) return;
        gone_.push_back(fmt::format(
            "no particle is left on the surface of <{}> of line {} (mk {}): what other draws do "
            "not cover is nearer than {:g} dp to their particles. Draw it that far from them, or "
            "thicker.",
            body.name, body.line, body.mk, least_pair_dp));
    }

    std::string count_of(std::size_t b)
    {
        const FittedBody& body = walls_.bodies[b];
        const FitMeasures& measures = body.measures;
        const double expected = measures.area / (dp_ * dp_);
        if (!(expected > 0) || has_layers(b)) return {};
        const double share = measures.wall_particles / expected - 1;
        // A strip that is left of a layer in a corner is no wall of its own.
        const double off =
            (measures.wall_particles - expected) / std::max(expected, mean_of_layers(b));
        if ((off > most_surplus || off < -most_lacking) && !body.is_inside)
            counts_[why_count(b, expected, share)].add(
                body.mk, share,
                fmt::format("<{}> of line {} has {:.0f} particles on {:.4g} {}, {:.0f} would be "
                            "one per dp^2",
                            body.name, body.line, measures.wall_particles, measures.area / depth_,
                            area_unit_, expected));
        return fmt::format(" {:.0f} particles on {:.4g} {}, {} of one per dp^2;",
                           measures.wall_particles, measures.area / depth_, area_unit_,
                           percent(share));
    }

    std::string count_of_layer(std::size_t l)
    {
        std::uint64_t count = 0;
        for (const std::uint64_t n : of_kind_[l]) count += n;
        const double expected = walls_.bodies[l].measures.area / (dp_ * dp_);
        if (!walls_.bodies[l].is_layer() || !(expected > 0)) return fmt::format("{}", count);
        count_of(l);
        return fmt::format("{} ({})", count,
                           percent(walls_.bodies[l].measures.wall_particles / expected - 1));
    }

    /// The particles that a layer of the wall of a layer should have, the mean; 0 of other bodies.
    double mean_of_layers(std::size_t b) const
    {
        if (!walls_.bodies[b].is_layer()) return 0;
        const std::uint32_t owner = walls_.bodies[b].owner;
        double area = 0;
        std::size_t n = 0;
        for (std::size_t l = owner + std::size_t{1}; l < walls_.bodies.size(); ++l)
        {
            if (walls_.bodies[l].owner != owner) break;
            area += walls_.bodies[l].measures.area;
            ++n;
        }
        return area / (static_cast<double>(n) * dp_ * dp_);
    }

    /// Its layers follow it.
    bool has_layers(std::size_t b) const
    {
        return b + 1 < walls_.bodies.size() && walls_.bodies[b + 1].owner == b;
    }

    std::string volume_of(std::size_t b)
    {
        const FittedBody& body = walls_.bodies[b];
        const FitMeasures& measures = body.measures;
        if (!(measures.volume > 0)) return " no volume";
        if (!body.is_solid || measures.filled < nearly_all)
            return fmt::format(" {:.4g} {}, not filled by its draw", measures.volume / depth_,
                               size_unit_);
        const double got = measures.node_volume + measures.wall_volume;
        const double share = got / measures.volume - 1;
        const std::string both =
            fmt::format("{:.4g} of {:.4g} {}", got / depth_, measures.volume / depth_, size_unit_);
        if (is_off(share))
            volumes_[why_volume(body)].add(
                body.mk, share,
                fmt::format("<{}> of line {} has {}{}", body.name, body.line, both, finer(body)));
        return fmt::format(" {} ({})", both, percent(share));
    }

    std::string why_count(std::size_t b, double expected, double share) const
    {
        const FitSettings* settings = fit_settings(settings_, walls_.bodies[b].mk);
        if (settings != nullptr && settings->density == FitDensity::Cell)
            return "as density=\"cell\" asks for one per cell";
        if (expected < small_surface) return "as they are small against dp";
        const std::array<std::uint64_t, 4>& kinds = of_kind_[b];
        const auto on_edges = static_cast<double>(kinds[0] + kinds[1]);
        if (on_edges > many_on_edges * (on_edges + static_cast<double>(kinds[2])))
            return "as their edges are few dp from one another";
        return share > 0 ? "as holes between particles are filled"
                         : "as rows of particles meet with gaps";
    }

    /// The dp with which the particles of a wall leave room for nodes, as words.
    std::string finer(const FittedBody& body) const
    {
        const FitMeasures& measures = body.measures;
        double length = 0;
        for (const FeatureLine& line : body.features.lines) length += line.length;
        const double area = measures.area + measures.second_sheet;
        const auto corners = static_cast<double>(body.features.singular.size());
        const auto has_room = [&](double dp)
        {
            const double on_surface = std::max(area / (dp * dp), corners + length / dp);
            return 0.5 * on_surface * dp * dp * dp <= room_left * measures.volume;
        };
        double dp = dp_;
        while (!has_room(dp) && dp > 1e-3 * dp_) dp *= 0.98;
        if (dp >= 0.97 * dp_ || depth_ != 1) return {};
        return fmt::format(", for which a dp of {:.2g} m would do", dp);
    }

    std::string why_volume(const FittedBody& body) const
    {
        const FitSettings* settings = fit_settings(settings_, body.mk);
        const FitMeasures& measures = body.measures;
        if (body.is_inside) return "as they are only a few dp in size";
        if (settings != nullptr && settings->clearance_dp)
            return fmt::format("as clearance=\"{:g}\" is given", *settings->clearance_dp);
        const double thickness =
            2 * measures.volume / ((measures.area + measures.second_sheet) * dp_);
        if (thickness < thin_dp && measures.second_sheet > 0)
            return "as they are thinner than dp and a sheet counts as if dp thick";
        if (thickness < thin_dp)
            return "as they are thinner than 2 dp and both of their sides have particles";
        if (!body.report.is_watertight)
            return "as their mesh is not closed and what is inside is a guess";
        return "as they are small against dp, or thin in places";
    }

    const FitDef& settings_;
    const FittedWalls& walls_;
    double dp_;
    double depth_; ///< of what counts as a volume, metres in 2D
    const char* size_unit_;
    const char* area_unit_;
    std::vector<std::array<std::uint64_t, 4>> of_kind_;
    std::vector<std::string> gone_; ///< a warning for each
    std::map<std::string, DeviationGroup> counts_;
    std::map<std::string, DeviationGroup> volumes_;
};

} // namespace

bool is_off(double share)
{
    return std::abs(share) > largest_deviation;
}

void DeviationGroup::add(int mk, double share, std::string most)
{
    least_ = mks_.empty() ? share : std::min(least_, share);
    greatest_ = mks_.empty() ? share : std::max(greatest_, share);
    if (mks_.empty() || std::abs(share) > std::abs(most_))
    {
        most_ = share;
        mk_of_most_ = mk;
        text_of_most_ = std::move(most);
    }
    mks_.push_back(mk);
}

std::string DeviationGroup::text(const std::string& name_of_mk) const
{
    const std::string all =
        fmt::format("{} {}: {}", name_of_mk, format_ranges(mks_), percent(least_));
    if (mks_.size() == 1) return fmt::format("{}; its {}", all, text_of_most_);
    const std::string most =
        fmt::format("the most at {} {}, whose {}", name_of_mk, mk_of_most_, text_of_most_);
    if (percent(least_) == percent(greatest_)) return fmt::format("{} each, {}", all, most);
    return fmt::format("{} to {}, {}", all, percent(greatest_), most);
}

std::vector<std::string> check_fit(const FitDef& settings, const FittedWalls& walls,
                                   const LatticeGrid& grid, RunLog& log)
{
    FitCheck check(settings, walls, grid);
    log.line("Fitted bodies against their shapes:");
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
        if (!walls.bodies[b].is_layer()) log.line(check.look_at(b));
    log.line();
    return check.warnings();
}

} // namespace fppg
