#include "relax/all_surfaces.h"

#include "core/parallel.h"
#include "meshes/crowded_points.h"
#include "meshes/point_grid.h"
#include "meshes/round_surface.h"
#include "offset/offset_surface.h"
#include "relax/regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

/// Cells in which places of particles that were taken out are sorted, dp.
constexpr double cell_of_cuts_dp = 3;
/// None is put so near to it again, dp.
constexpr double reach_of_insertion_dp = 1.5;
/// The same where layers of another body stand instead, dp: less than a step of what was taken out.
constexpr double reach_of_replaced_dp = 0.75;
constexpr int surface_iterations = 100;
/// Value of WallParticles::held of those that are there for a relaxation only.
constexpr char of_border = 2;
/// Particles with none nearer count as if one were so far, dp.
constexpr double alone_dp = 2;
/// Particles within this reach crowd one another; of them one is taken out at most, dp.
constexpr double reach_of_crowd_dp = 2;
/// No more than this share of the particles in the layers of a body is taken out.
constexpr double most_thinned = 0.15;

/// The positions of two sets, in `joined` where both have some.
const std::vector<Vec3>& positions_of_both(const WallParticles& particles,
                                           const WallParticles& others, std::vector<Vec3>& joined)
{
    if (others.size() == 0) return particles.positions;
    joined.reserve(particles.size() + others.size());
    joined.insert(joined.end(), particles.positions.begin(), particles.positions.end());
    joined.insert(joined.end(), others.positions.begin(), others.positions.end());
    return joined;
}

class AllSurfaces
{
public:
    AllSurfaces(const CaseDef& def, RunField& field, int threads, const RelaxObserver& observe,
                RelaxReport& report, const RelaxSnapshot& snapshot)
        : def_(def),
          field_(field),
          threads_(threads),
          observe_(observe),
          report_(report),
          snapshot_(snapshot)
    {
    }

    /// All bodies whose mks are relaxed alike are one call.
    void relax_surfaces()
    {
        struct Kind
        {
            RelaxSettings relax;
            double spacing_dp = 1;
            bool operator==(const Kind&) const = default;
        };
        std::vector<Kind> kinds;
        std::vector<std::size_t> kind_of_body;
        for (const FittedBody& body : field_.walls.bodies)
        {
            const FitSettings* settings = settings_of(body.mk);
            const Kind own{settings != nullptr ? settings->relax : RelaxSettings{},
                           body.spacing_dp};
            const auto known = std::find(kinds.begin(), kinds.end(), own);
            kind_of_body.push_back(static_cast<std::size_t>(known - kinds.begin()));
            if (known == kinds.end()) kinds.push_back(own);
        }
        for (std::size_t kind = 0; kind < kinds.size(); ++kind)
        {
            if (report_.is_stopped || !kinds[kind].relax.is_active) continue;
            std::vector<char> is_meant;
            // A layer that two sides share is even as it was made.
            for (std::size_t b = 0; b < kind_of_body.size(); ++b)
                is_meant.push_back(kind_of_body[b] == kind &&
                                   !field_.walls.bodies[b].mesh.facets.empty());
            if (std::all_of(is_meant.begin(), is_meant.end(), [](char m) { return m != 0; }))
                relax_surface_of(field_.walls.particles, {}, kinds[kind].relax,
                                 kinds[kind].spacing_dp);
            else
            {
                WallParticles meant = take(is_meant, true);
                const WallParticles others = take(is_meant, false);
                relax_surface_of(meant, others, kinds[kind].relax, kinds[kind].spacing_dp);
                field_.walls.particles = join(meant, others);
            }
        }
    }

private:
    WallParticles take(const std::vector<char>& is_meant, bool meant) const
    {
        const WallParticles& all = field_.walls.particles;
        WallParticles out;
        for (std::size_t i = 0; i < all.size(); ++i)
            if ((is_meant[all.bodies[i]] != 0) == meant) out.append(all, i);
        return out;
    }

    void relax_surface_of(WallParticles& particles, const WallParticles& others,
                          const RelaxSettings& settings, double spacing_dp)
    {
        const double dp = field_.grid.dp;
        const FittedWalls& walls = field_.walls;
        RelaxSurfaceOptions options;
        options.dp = dp * spacing_dp;
        options.h = settings.surface_h_dp;
        options.iterations = settings.iterations.value_or(0);
        options.max_iterations = surface_iterations;
        options.tolerance = settings.tolerance;
        options.on_progress = [&](const RelaxProgress& p)
        {
            return observe({"surface", p.iteration,
                            settings.iterations.value_or(surface_iterations), p.particles,
                            p.spacing_mean, p.spacing_variation, p.largest_displacement, p.piece,
                            p.pieces});
        };
        options.snapshot_interval = snapshot_ ? settings.snapshots : 0;
        options.on_snapshot = [&](int iteration, const WallParticles& now)
        { snapshot_(surface_iterations_done_ + iteration, join(now, others)); };
        const PointGrid cut = grid_of(walls.cut, cell_of_cuts_dp * dp);
        const PointGrid replaced = grid_of(walls.replaced, reach_of_replaced_dp * dp);
        const WallParticles& second = walls.second_sheets;
        const PointGrid second_sheets = grid_of(second.positions, cell_of_cuts_dp * dp);
        const WallParticles all =
            walls.bodies.size() > 1 ? join(particles, others) : WallParticles{};
        const PointGrid of_others = grid_of(all.positions, least_pair_dp * dp);
        const auto is_apart = [&](std::size_t body, const Vec3& p)
        {
            bool out = true;
            replaced.for_each_near(p, reach_of_replaced_dp * dp,
                                   [&](std::uint32_t c, double)
                                   { out = out && walls.replaced_bodies[c] != body; });
            of_others.for_each_near(p, least_pair_dp * dp,
                                    [&](std::uint32_t i, double)
                                    { out = out && all.bodies[i] == body; });
            return out;
        };
        const bool is_limited = !walls.cut.empty() || second.size() > 0 || all.size() > 0;
        if (is_limited || has_fixed_numbers(particles))
            options.may_insert = [&](std::size_t body, const Vec3& p, const Vec3& normal)
            {
                return !has_fixed_number(walls.owner_of(body)) && is_apart(body, p) &&
                       is_free(cut, second_sheets, body, p, normal);
            };
        const std::vector<double> before = count_by_body(particles);
        const double variation_before = spacing_of(particles, others).variation;
        // Layers go on as far as they were laid, so that they stay even where another side takes
        // over.
        const bool has_border = add_borders(particles);
        std::vector<char> held = std::move(particles.held);
        const RelaxSurfaceReport done =
            relax_surface(walls.bodies, particles, held, options, threads_);
        particles.held = std::move(held);
        particles.held.resize(particles.size(), 0);
        if (has_border) take_borders_out(particles);
        parallel_for(
            particles.size(), threads_,
            [&](std::size_t i)
            {
                const FittedBody& body = walls.bodies[particles.bodies[i]];
                if (!body.is_layer())
                    project_to_exact(body, particles.positions[i], particles.facets[i]);
                else if (particles.kinds[i] == FitKind::Surface)
                    particles.positions[i] =
                        project_to_depth(*body.wall, particles.positions[i], body.depth);
            },
            1024);
        const std::size_t crowded =
            leave_out_crowded(particles, others) + thin_shells(particles, others);
        take_new_counts(before, count_by_body(particles));
        add_report(done, spacing_of(particles, others), variation_before);
        report_.parts.back().particles = particles.size();
        report_.parts.back().removed += crowded;
    }

    /// Whether a body has no nodes to make up for particles that come or go.
    static bool has_fixed_number(const FittedBody& body)
    {
        return body.is_inside && body.measures.node_volume < 0.1 * body.measures.volume;
    }

    bool has_fixed_numbers(const WallParticles& particles) const
    {
        return std::any_of(particles.bodies.begin(), particles.bodies.end(),
                           [&](std::uint32_t body)
                           { return has_fixed_number(field_.walls.owner_of(body)); });
    }

    struct Spacing
    {
        double variation = 0;
        double nearest_pair_dp = alone_dp;
    };

    void add_report(const RelaxSurfaceReport& done, const Spacing& spacing, double variation_before)
    {
        surface_iterations_done_ += done.after.iteration;
        RelaxedPart part;
        part.what = "surface";
        part.iterations = done.after.iteration;
        part.inserted = done.inserted;
        part.removed = done.removed;
        part.mean = done.after.spacing_mean;
        part.variation_before = variation_before;
        part.variation = spacing.variation;
        part.smooth_variation = done.after.spacing_variation;
        part.nearest_pair_dp = spacing.nearest_pair_dp;
        report_.parts.push_back(part);
    }

    /// From each particle to the nearest one.
    Spacing spacing_of(const WallParticles& particles, const WallParticles& others) const
    {
        Spacing out;
        if (particles.size() == 0) return out;
        const double dp = field_.grid.dp;
        std::vector<Vec3> joined;
        const std::vector<double> nearest = nearest_distances(
            positions_of_both(particles, others, joined), alone_dp * dp, threads_);
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < particles.size(); ++i)
        {
            const double distance = nearest[i] / dp;
            sum += distance;
            squares += distance * distance;
            out.nearest_pair_dp = std::min(out.nearest_pair_dp, distance);
        }
        const auto n = static_cast<double>(particles.size());
        const double mean = sum / n;
        if (mean > 0) out.variation = std::sqrt(std::max(0.0, squares / n - mean * mean)) / mean;
        return out;
    }

    /// Takes out what came too near to particles of other sheets, layers and bodies: the shallower
    /// layer stays, then corners, then edges. Returns how many.
    std::size_t leave_out_crowded(WallParticles& particles, const WallParticles& others)
    {
        FittedWalls& walls = field_.walls;
        std::vector<Vec3> joined;
        const std::vector<Vec3>& points = positions_of_both(particles, others, joined);
        std::vector<std::uint32_t> rank;
        rank.reserve(points.size());
        for (std::size_t i = 0; i < particles.size(); ++i)
            rank.push_back(1 +
                           4 * static_cast<std::uint32_t>(walls.bodies[particles.bodies[i]].layer) +
                           static_cast<std::uint32_t>(particles.kinds[i]));
        rank.resize(points.size(), 0);
        const std::size_t own = particles.size();
        const auto may_stay = [&](std::size_t i, std::size_t j)
        {
            if (i >= own || j >= own) return i >= own && j >= own;
            return are_wanted_sheets(particles, i, j);
        };
        std::vector<char> goes =
            find_crowded(points, rank, least_pair_dp * field_.grid.dp, may_stay, threads_);
        goes.resize(own);
        std::size_t count = 0;
        for (std::size_t i = 0; i < own; ++i)
        {
            if (goes[i] == 0) continue;
            ++walls.owner_of(particles.bodies[i])
                  .left_out[static_cast<std::size_t>(particles.kinds[i])];
            ++count;
        }
        if (count > 0) particles.erase(goes);
        return count;
    }

    /// Closing holes leaves some 3 % too many particles in layers. In bodies that have all
    /// particles inside, the rest would be too sparse then. Takes out the most crowded ones until
    /// each stands for dp^3 of the shell; bodies that were cut keep theirs. Returns how many went.
    ///
    /// others  do not move, as the sheets in the middle of thin parts, and count as well
    std::size_t thin_shells(WallParticles& particles, const WallParticles& others) const
    {
        const FittedWalls& walls = field_.walls;
        const double dp = field_.grid.dp;
        std::set<const FittedBody*> cut;
        for (const std::uint32_t b : walls.cut_bodies) cut.insert(&walls.owner_of(b));
        std::map<const FittedBody*, double> count;
        for (const std::uint32_t b : particles.bodies) ++count[&walls.owner_of(b)];
        for (const std::uint32_t b : others.bodies)
            if (const auto own = count.find(&walls.owner_of(b)); own != count.end()) ++own->second;
        std::map<const FittedBody*, double> excess;
        for (const auto& [body, number] : count)
            if (body->is_inside && !has_fixed_number(*body) && cut.count(body) == 0)
                excess[body] = std::min(most_thinned * number,
                                        number - body->measures.shell_volume / (dp * dp * dp));
        std::size_t all = 0;
        while (const std::size_t taken = thin(particles, excess)) all += taken;
        return all;
    }

    /// Takes out the most crowded particles of bodies that have too many, none within reach of
    /// another one. Returns how many.
    ///
    /// excess  is less by those afterwards
    std::size_t thin(WallParticles& particles, std::map<const FittedBody*, double>& excess) const
    {
        if (std::none_of(excess.begin(), excess.end(), [](auto& e) { return e.second >= 1; }))
            return 0;
        const FittedWalls& walls = field_.walls;
        std::vector<std::uint32_t> order(particles.size());
        std::iota(order.begin(), order.end(), 0u);
        const std::vector<double> crowd = crowds(particles.positions);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return crowd[a] > crowd[b]; });
        std::vector<char> goes(particles.size(), 0);
        PointGrid gone(reach_of_crowd_dp * field_.grid.dp, 64);
        std::size_t taken = 0;
        for (const std::uint32_t i : order)
        {
            const auto left = excess.find(&walls.owner_of(particles.bodies[i]));
            if (left == excess.end() || left->second < 1 || particles.held[i] != 0 ||
                particles.kinds[i] != FitKind::Surface ||
                gone.has_nearer(particles.positions[i], reach_of_crowd_dp * field_.grid.dp))
                continue;
            goes[i] = 1;
            gone.add(particles.positions[i]);
            left->second -= 1;
            ++taken;
        }
        particles.erase(goes);
        return taken;
    }

    /// How crowded points are: the sum of (1 - r / reach)^2 over those around each.
    std::vector<double> crowds(const std::vector<Vec3>& points) const
    {
        const double reach = reach_of_crowd_dp * field_.grid.dp;
        PointGrid grid(reach, points.size());
        for (const Vec3& p : points) grid.add(p);
        std::vector<double> out(points.size());
        parallel_for(
            points.size(), threads_,
            [&](std::size_t i)
            {
                grid.for_each_near(points[i], reach,
                                   [&](std::uint32_t, double squared)
                                   {
                                       const double free = 1 - std::sqrt(squared) / reach;
                                       out[i] += free * free;
                                   });
            },
            256);
        return out;
    }

    /// Whether particles are on the two sheets of a plate, however thin, as plates="both" asks.
    bool are_wanted_sheets(const WallParticles& particles, std::size_t i, std::size_t j) const
    {
        const FittedBody& body = field_.walls.bodies[particles.bodies[i]];
        if (particles.bodies[i] != particles.bodies[j] || body.is_layer() ||
            particles.kinds[i] != FitKind::Surface || particles.kinds[j] != FitKind::Surface)
            return false;
        const FitSettings* settings = settings_of(body.mk);
        return settings != nullptr && settings->one_sheet_dp == 0 &&
               dot(body.mesh.normals[particles.facets[i]], body.mesh.normals[particles.facets[j]]) <
                   -0.5;
    }

    /// Puts the particles of layers that were left out for another side back, held.
    bool add_borders(WallParticles& particles) const
    {
        const FittedWalls& walls = field_.walls;
        const WallParticles& second = walls.second_sheets;
        std::vector<char> is_there(walls.bodies.size(), 0);
        for (const std::uint32_t b : particles.bodies) is_there[b] = 1;
        bool found = false;
        for (std::size_t i = 0; i < second.size(); ++i)
        {
            if (!walls.bodies[second.bodies[i]].is_layer() || is_there[second.bodies[i]] == 0)
                continue;
            particles.append(second, i);
            particles.held.back() = of_border;
            found = true;
        }
        return found;
    }

    static void take_borders_out(WallParticles& particles)
    {
        std::vector<char> is_border(particles.size());
        for (std::size_t i = 0; i < is_border.size(); ++i)
            is_border[i] = particles.held[i] == of_border ? 1 : 0;
        particles.erase(is_border);
    }

    /// Whether no particle of a body was taken out near a place on it.
    bool is_free(const PointGrid& cut, const PointGrid& second_sheets, std::size_t body,
                 const Vec3& p, const Vec3& normal) const
    {
        const FittedWalls& walls = field_.walls;
        const WallParticles& second = walls.second_sheets;
        const double reach = reach_of_insertion_dp * field_.grid.dp;
        bool out = true;
        cut.for_each_near(
            p, reach, [&](std::uint32_t c, double) { out = out && walls.cut_bodies[c] != body; });
        second_sheets.for_each_near(
            p, reach,
            [&](std::uint32_t c, double)
            {
                const SurfaceMesh& mesh = walls.bodies[second.bodies[c]].mesh;
                out = out && (second.bodies[c] != body ||
                              dot(mesh.normals[second.facets[c]], normal) <= 0);
            });
        return out;
    }

    std::vector<double> count_by_body(const WallParticles& particles) const
    {
        std::vector<double> counts(field_.walls.bodies.size(), 0);
        for (const std::uint32_t body : particles.bodies) ++counts[body];
        return counts;
    }

    /// What a cut left of a body is taken for all of it.
    void take_new_counts(const std::vector<double>& before, const std::vector<double>& after)
    {
        for (std::size_t b = 0; b < before.size(); ++b)
        {
            if (before[b] == 0) continue;
            FittedBody& body = field_.walls.bodies[b];
            FittedBody& owner = field_.walls.owner_of(b);
            const double own = body.measures.wall_particles - body.measures.layer_particles;
            const double more = own * (after[b] / before[b] - 1);
            body.measures.wall_particles += more;
            if (body.is_layer())
            {
                owner.measures.wall_particles += more;
                owner.measures.layer_particles += more;
            }
            owner.measures.wall_volume +=
                (body.is_layer() ? 1 : 0.5) * more * std::pow(field_.grid.dp, 3);
            owner.settle_share(field_.grid.dp);
        }
    }

    const FitSettings* settings_of(std::uint16_t mk) const { return fit_settings(def_.fit, mk); }

    bool observe(const RelaxStep& step)
    {
        if (observe_ && !observe_(step)) report_.is_stopped = true;
        return !report_.is_stopped;
    }

    const CaseDef& def_;
    RunField& field_;
    int threads_;
    const RelaxObserver& observe_;
    RelaxReport& report_;
    const RelaxSnapshot& snapshot_;
    int surface_iterations_done_ = 0;
};

} // namespace

void relax_all_surfaces(const CaseDef& def, RunField& field, int threads,
                        const RelaxObserver& observe, RelaxReport& report,
                        const RelaxSnapshot& snapshot)
{
    AllSurfaces(def, field, threads, observe, report, snapshot).relax_surfaces();
}

} // namespace fppg
