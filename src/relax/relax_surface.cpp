#include "fppg/relax.h"

#include "core/parallel_sort.h"
#include "fppg/error.h"
#include "relax/surface_layer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

namespace fppg
{

namespace
{

/// Iterations after which holes are filled and particles that are too near taken out: relaxation
/// closes most holes by itself, so the first come late.
constexpr std::array<int, 6> renewals{10, 25, 40, 55, 70, 85};
/// No renewal this few iterations before the end, where the last one is.
constexpr int quiet_end = 8;

// Lengths in dp.
constexpr double hole_radius = 0.74;
constexpr double last_hole_radius = 0.735;
constexpr double least_distance = 0.70;
constexpr double last_least_distance = 0.62;

/// Iterations over which an improvement is judged: two renewals and what follows them.
constexpr int judged_iterations = 30;
/// Before this the first renewals, which fill most holes, hide what the rest improves.
constexpr int first_judged = 60;
/// Iterations in which the spacing recovers from a renewal.
constexpr int recovery = 14;

std::vector<std::vector<std::uint32_t>> split_by_body(const WallParticles& particles,
                                                      std::size_t bodies)
{
    std::vector<std::vector<std::uint32_t>> result(bodies);
    for (std::uint32_t i = 0; i < particles.size(); ++i) result[particles.bodies[i]].push_back(i);
    return result;
}

class SurfaceRelaxation
{
public:
    SurfaceRelaxation(const std::vector<FittedBody>& bodies, const WallParticles& particles,
                      const std::vector<char>& held, const RelaxSurfaceOptions& options,
                      int threads)
        : bodies_(bodies), options_(options), threads_(threads)
    {
        const auto members = split_by_body(particles, bodies.size());
        for (std::size_t b = 0; b < bodies.size(); ++b)
        {
            if (members[b].empty()) continue;
            std::vector<LayerParticle> own;
            own.resize(members[b].size());
            parallel_for(
                own.size(), threads,
                [&](std::size_t k)
                {
                    const std::uint32_t i = members[b][k];
                    LayerParticle& p = own[k];
                    p.place = {particles.positions[i], particles.facets[i]};
                    p.source = i;
                    p.kind = particles.kinds[i];
                    p.is_moving = p.kind == FitKind::Surface && (held.empty() || !held[i]);
                },
                NeighbourList::rows_per_chunk);
            layers_.emplace_back(bodies[b], std::move(own), options.dp, options.h, threads);
            body_of_layer_.push_back(b);
        }
    }

    void run(const WallParticles& given, const std::vector<char>& held)
    {
        LayerState state = look_around();
        report_.before = progress(0, state, 0);
        report_.after = report_.before;
        const int count = options_.iterations > 0 ? options_.iterations : options_.max_iterations;
        std::vector<double> variations{report_.before.spacing_variation};
        for (int iteration = 1; iteration <= count; ++iteration)
        {
            const bool is_restart = iteration == 1 || state.power < 0;
            double largest = 0;
            for (SurfaceLayer& layer : layers_) largest = std::max(largest, layer.step(is_restart));
            if (std::find(renewals.begin(), renewals.end(), iteration) != renewals.end() &&
                iteration + quiet_end <= count)
                renew(least_distance, hole_radius);
            state = look_around();
            report_.after = progress(iteration, state, largest);
            if (options_.snapshot_interval > 0 && iteration % options_.snapshot_interval == 0)
            {
                std::vector<char> held_now;
                WallParticles now = gather(given, held, held_now);
                now.held = std::move(held_now);
                options_.on_snapshot(iteration, now);
            }
            if (options_.on_progress && !options_.on_progress(report_.after)) break;
            variations.push_back(report_.after.spacing_variation);
            if (options_.iterations == 0 && is_settled(variations)) break;
        }
        if (report_.after.iteration > 0) renew(last_least_distance, last_hole_radius);
        const int iteration = report_.after.iteration;
        report_.after = progress(iteration, look_around(), report_.after.largest_displacement);
        for (const SurfaceLayer& layer : layers_)
        {
            report_.projected += layer.projected();
            report_.returned += layer.returned();
        }
    }

    /// The particles in their old order, new ones at the end of their body.
    WallParticles gather(const WallParticles& given, const std::vector<char>& given_held,
                         std::vector<char>& held) const
    {
        WallParticles particles;
        for (std::size_t l = 0; l < layers_.size(); ++l)
        {
            const auto body = static_cast<std::uint32_t>(body_of_layer_[l]);
            const std::vector<LayerParticle>& own = layers_[l].particles();
            std::vector<std::uint32_t> order(own.size());
            std::iota(order.begin(), order.end(), 0u);
            parallel_sort(order, threads_,
                          [&](std::uint32_t a, std::uint32_t b)
                          { return comes_before(own[a], own[b]); });
            for (const std::uint32_t i : order)
            {
                const LayerParticle& p = own[i];
                const bool is_fixed = !p.is_moving && !p.is_new;
                particles.positions.push_back(is_fixed ? given.positions[p.source]
                                                       : p.place.position);
                particles.kinds.push_back(p.kind);
                particles.bodies.push_back(body);
                particles.facets.push_back(is_fixed ? given.facets[p.source]
                                                    : layers_[l].mesh_facet(p.place.facet));
                particles.mk.push_back(mk_of(p, given, bodies_[body], particles.facets.back()));
                if (!given_held.empty())
                    held.push_back(p.is_new ? !p.is_moving : given_held[p.source]);
            }
        }
        return particles;
    }

    RelaxSurfaceReport report() const { return report_; }

private:
    /// The mk of the particle itself or of the one nearest to it, unless its facet belongs to
    /// another part of a combination.
    static std::uint16_t mk_of(const LayerParticle& p, const WallParticles& given,
                               const FittedBody& body, std::uint32_t facet)
    {
        if (body.facet_mk.empty()) return p.source == no_index ? body.mk : given.mk[p.source];
        const std::uint16_t of_facet = body.facet_mk[facet];
        const bool is_of_source =
            p.source != no_index && body.facet_mk[given.facets[p.source]] == of_facet;
        return is_of_source ? given.mk[p.source] : of_facet;
    }

    static bool comes_before(const LayerParticle& a, const LayerParticle& b)
    {
        if (a.is_new != b.is_new) return b.is_new;
        if (!a.is_new) return a.source < b.source;
        const auto key = [](const LayerParticle& p)
        {
            return std::make_tuple(p.place.facet, p.place.position.x, p.place.position.y,
                                   p.place.position.z);
        };
        return key(a) < key(b);
    }

    /// Judged when the last renewal is well past: each makes the spacing worse for a while.
    bool is_settled(const std::vector<double>& variations) const
    {
        const auto now = static_cast<int>(variations.size()) - 1;
        if (now < first_judged) return false;
        const bool is_recovering =
            std::any_of(renewals.begin(), renewals.end(),
                        [&](int r) { return now >= r && now < r + recovery; });
        const double before = variations[variations.size() - 1 - judged_iterations];
        return !is_recovering && before - variations.back() < options_.tolerance;
    }

    LayerState look_around()
    {
        LayerState sum;
        for (SurfaceLayer& layer : layers_)
        {
            const LayerState state = layer.look_around();
            sum.moving += state.moving;
            sum.spacing_sum += state.spacing_sum;
            sum.spacing_square_sum += state.spacing_square_sum;
            sum.power += state.power;
        }
        return sum;
    }

    RelaxProgress progress(int iteration, const LayerState& state, double largest) const
    {
        RelaxProgress result;
        result.iteration = iteration;
        result.largest_displacement = largest;
        for (const SurfaceLayer& layer : layers_) result.particles += layer.size();
        if (state.moving == 0) return result;
        const auto n = static_cast<double>(state.moving);
        result.spacing_mean = state.spacing_sum / n;
        const double variance =
            state.spacing_square_sum / n - result.spacing_mean * result.spacing_mean;
        result.spacing_variation = std::sqrt(std::max(0.0, variance)) / result.spacing_mean;
        return result;
    }

    void renew(double least, double radius)
    {
        for (std::size_t l = 0; l < layers_.size(); ++l)
        {
            report_.removed += layers_[l].thin(least);
            std::function<bool(const Vec3&, const Vec3&)> may_fill;
            if (options_.may_insert)
                may_fill = [&, body = body_of_layer_[l]](const Vec3& p, const Vec3& normal)
                { return options_.may_insert(body, p, normal); };
            report_.inserted += layers_[l].fill(radius, may_fill);
        }
    }

    const std::vector<FittedBody>& bodies_;
    const RelaxSurfaceOptions& options_;
    int threads_;
    std::vector<SurfaceLayer> layers_;
    std::vector<std::size_t> body_of_layer_;
    RelaxSurfaceReport report_;
};

} // namespace

RelaxSurfaceReport relax_surface(const std::vector<FittedBody>& bodies, WallParticles& particles,
                                 std::vector<char>& held, const RelaxSurfaceOptions& options,
                                 int threads)
{
    if (!(options.dp > 0))
        throw GeometryError("relaxation: dp is " + std::to_string(options.dp) +
                            ", expected a distance above 0");
    if (!(options.h >= 0.5 && options.h <= 2))
        throw GeometryError("relaxation: h is " + std::to_string(options.h) +
                            " dp, expected 0.5 to 2");
    SurfaceRelaxation relaxation(bodies, particles, held, options, threads);
    relaxation.run(particles, held);
    std::vector<char> held_now;
    particles = relaxation.gather(particles, held, held_now);
    held = std::move(held_now);
    return relaxation.report();
}

} // namespace fppg
