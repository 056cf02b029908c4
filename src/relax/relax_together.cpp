#include "relax/relax_together.h"

#include "core/parallel_sort.h"
#include "relax/surface_layer.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace fppg
{

namespace
{

/// After these iterations particles that are too near another are taken out and holes filled.
/// Relaxation closes most holes by itself, so the first come late, and only the widest of them are
/// filled at first.
struct Renewal
{
    int iteration;
    SurfaceLayer::Limits limits;
};
constexpr SurfaceLayer::Limits first_limits{0.70, 0.76, true};
constexpr SurfaceLayer::Limits limits{0.70, 0.735, false};
constexpr std::array<Renewal, 2> renewals{{{7, first_limits}, {14, limits}}};
/// For few_particles, which take longer to find their places where they crowd.
constexpr std::array<Renewal, 2> late_renewals{
    {{30, {0.62, 0.76, false}}, {45, {0.62, 0.75, false}}}};
/// No renewal this few iterations before the end, where the last one is.
constexpr int quiet_end = 6;
/// The last renewal, after which only particles near what has changed move, and what remains then.
constexpr SurfaceLayer::Limits last_limits{0.62, 0.735, false};
constexpr int last_iterations = 5;

/// Iterations over which an improvement is judged, and before which it is not: the spacing recovers
/// from the renewals. The spacing of few particles jumps, and their iterations cost little.
struct Judgement
{
    int iterations;
    int first;
};
constexpr double many_holes = 0.05; ///< of all particles
constexpr Judgement of_many{3, 18};
constexpr Judgement of_few{12, 58};

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
    using WorkMeshes = std::vector<std::shared_ptr<const WorkMesh>>;

    SurfaceRelaxation(const std::vector<FittedBody>& bodies, WorkMeshes& work_meshes,
                      const WallParticles& particles, const std::vector<char>& held,
                      const RelaxSurfaceOptions& options, int threads)
        : bodies_(bodies), options_(options), threads_(threads)
    {
        const auto members = split_by_body(particles, bodies.size());
        for (std::size_t b = 0; b < bodies.size(); ++b)
        {
            if (members[b].empty()) continue;
            std::vector<LayerParticle> own;
            own.reserve(members[b].size() + members[b].size() / 20); // for those to be put in
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
            if (work_meshes[b] == nullptr)
                work_meshes[b] = std::make_shared<WorkMesh>(make_work_mesh(
                    bodies[b].mesh, bodies[b].features, longest_chart_side * options.dp, threads));
            layers_.emplace_back(bodies[b], work_meshes[b], std::move(own), options.dp, options.h,
                                 threads);
            body_of_layer_.push_back(b);
        }
    }

    void run(const WallParticles& given, const std::vector<char>& held)
    {
        report_.before = progress(0, look_around(), 0);
        report_.after = report_.before;
        const int count = options_.iterations > 0 ? options_.iterations : options_.max_iterations;
        const int last_part = count > quiet_end ? last_iterations : 0;
        std::vector<double> variations{report_.before.spacing_variation};
        bool goes_on = true;
        for (int iteration = 1; goes_on && iteration <= count - last_part; ++iteration)
        {
            goes_on = iterate(iteration, given, held);
            variations.push_back(report_.after.spacing_variation);
            if (options_.iterations == 0 && is_settled(variations)) break;
            if (iteration + quiet_end > count - last_part) continue;
            for (const Renewal& renewal : renewals)
                if (renewal.iteration == iteration) renew(renewal.limits, false);
            if (!takes_care()) continue;
            for (const Renewal& renewal : late_renewals)
                if (renewal.iteration == iteration) renew(renewal.limits, false);
        }
        if (report_.after.iteration == 0) return;
        LayerState renewed = renew(last_limits, true);
        for (int n = 0; goes_on && n < last_part; ++n)
            goes_on = iterate(report_.after.iteration + 1, given, held);
        if (last_part > 0) renewed = renew(last_limits, true);
        const int iteration = report_.after.iteration;
        report_.after = progress(iteration, renewed, report_.after.largest_displacement);
        for (const SurfaceLayer& layer : layers_)
        {
            report_.projected += layer.projected();
            report_.returned += layer.returned();
        }
    }

    /// The particles in their old order, new ones at the end of their body.
    WallParticles gather(const WallParticles& given, const std::vector<char>& given_held,
                         std::vector<char>& held, RelaxOrigins& origins) const
    {
        WallParticles particles;
        std::size_t n = 0;
        for (const SurfaceLayer& layer : layers_) n += layer.size();
        particles.positions.resize(n);
        particles.kinds.resize(n);
        particles.bodies.resize(n);
        particles.facets.resize(n);
        particles.mk.resize(n);
        origins.sources.resize(n);
        origins.is_new.resize(n);
        held.resize(given_held.empty() ? 0 : n);
        std::size_t first = 0;
        for (std::size_t l = 0; l < layers_.size(); ++l)
        {
            const auto body = static_cast<std::uint32_t>(body_of_layer_[l]);
            const std::vector<LayerParticle>& own = layers_[l].particles();
            std::vector<std::uint32_t> order(own.size());
            std::iota(order.begin(), order.end(), 0u);
            parallel_sort(order, threads_,
                          [&](std::uint32_t a, std::uint32_t b)
                          { return comes_before(own[a], own[b]); });
            const auto take_over = [&](std::size_t k)
            {
                const LayerParticle& p = own[order[k]];
                const std::size_t to = first + k;
                const bool is_fixed = !p.is_moving && !p.is_new;
                particles.positions[to] = is_fixed ? given.positions[p.source] : p.place.position;
                particles.kinds[to] = p.kind;
                particles.bodies[to] = body;
                particles.facets[to] =
                    is_fixed ? given.facets[p.source] : layers_[l].mesh_facet(p.place.facet);
                particles.mk[to] = mk_of(p, given, bodies_[body], particles.facets[to]);
                origins.sources[to] = p.source;
                origins.is_new[to] = p.is_new ? 1 : 0;
                if (!given_held.empty()) held[to] = p.is_new ? !p.is_moving : given_held[p.source];
            };
            parallel_for(own.size(), threads_, take_over, NeighbourList::rows_per_chunk);
            first += own.size();
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

    /// Moves all particles once; returns whether to go on.
    bool iterate(int iteration, const WallParticles& given, const std::vector<char>& held)
    {
        const bool is_restart = iteration == 1 || power_ < 0;
        double largest = 0;
        for (SurfaceLayer& layer : layers_) largest = std::max(largest, layer.step(is_restart));
        report_.after = progress(iteration, look_around(), largest);
        if (options_.snapshot_interval > 0 && iteration % options_.snapshot_interval == 0)
        {
            for (SurfaceLayer& layer : layers_) layer.settle();
            std::vector<char> held_now;
            RelaxOrigins origins;
            WallParticles now = gather(given, held, held_now, origins);
            now.held = std::move(held_now);
            options_.on_snapshot(iteration, now);
        }
        return !options_.on_progress || options_.on_progress(report_.after);
    }

    /// Few cost little; where many were put into holes, as rows on a cone part from one another,
    /// the places where they are close lie far from those where they are not.
    bool takes_care() const
    {
        return report_.after.particles < few_particles ||
               static_cast<double>(report_.inserted) >
                   many_holes * static_cast<double>(report_.after.particles);
    }

    bool is_settled(const std::vector<double>& variations) const
    {
        const auto [iterations, first] = takes_care() ? of_few : of_many;
        const auto now = static_cast<int>(variations.size()) - 1;
        if (now < first) return false;
        const double before = variations[static_cast<std::size_t>(now - iterations)];
        return before - variations.back() < options_.tolerance;
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
        power_ = sum.power;
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

    /// Returns the state after it.
    LayerState renew(const SurfaceLayer::Limits& of_holes, bool is_local)
    {
        for (std::size_t l = 0; l < layers_.size(); ++l)
        {
            std::function<bool(const Vec3&, const Vec3&)> may_fill;
            if (options_.may_insert)
                may_fill = [&, body = body_of_layer_[l]](const Vec3& p, const Vec3& normal)
                { return options_.may_insert(body, p, normal); };
            const LayerChange change = layers_[l].renew(of_holes, is_local, may_fill);
            report_.inserted += change.inserted;
            report_.removed += change.removed;
        }
        return look_around();
    }

    const std::vector<FittedBody>& bodies_;
    const RelaxSurfaceOptions& options_;
    int threads_;
    std::vector<SurfaceLayer> layers_;
    std::vector<std::size_t> body_of_layer_;
    RelaxSurfaceReport report_;
    double power_ = 0; ///< LayerState::power as of the last look
};

} // namespace

RelaxedTogether relax_together(const std::vector<FittedBody>& bodies,
                               std::vector<std::shared_ptr<const WorkMesh>>& work_meshes,
                               WallParticles& particles, std::vector<char>& held,
                               const RelaxSurfaceOptions& options, int threads)
{
    SurfaceRelaxation relaxation(bodies, work_meshes, particles, held, options, threads);
    relaxation.run(particles, held);
    RelaxedTogether out;
    std::vector<char> held_now;
    particles = relaxation.gather(particles, held, held_now, out.origins);
    held = std::move(held_now);
    out.report = relaxation.report();
    return out;
}

} // namespace fppg
