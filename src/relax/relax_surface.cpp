#include "fppg/relax.h"

#include "core/parallel.h"
#include "fppg/error.h"
#include "meshes/point_slabs.h"
#include "relax/relax_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{
namespace
{

/// Particles of the slab before that move once more, as far as this from the border, dp.
constexpr double overlap_dp = 10;
/// Of those around a slab as many stand still around it as its lists reach twice, and this, dp.
constexpr double beyond_lists_dp = 2;
/// Slabs are no thinner, dp.
constexpr double thinnest_slab_dp = 40;
constexpr std::size_t particles_per_chunk = 4096;
/// Sums of reports; mean and variation as over all their particles.
class ReportSum
{
public:
    void add(const RelaxSurfaceReport& part)
    {
        add(part.before, sum_.before, before_);
        add(part.after, sum_.after, after_);
        sum_.inserted += part.inserted;
        sum_.removed += part.removed;
        sum_.projected += part.projected;
        sum_.returned += part.returned;
    }
    RelaxSurfaceReport report(std::size_t particles) const
    {
        RelaxSurfaceReport out = sum_;
        finish(before_, out.before);
        finish(after_, out.after);
        out.after.particles = particles;
        return out;
    }

private:
    struct Moments
    {
        double count = 0, sum = 0, squares = 0;
    };
    static void add(const RelaxProgress& part, RelaxProgress& all, Moments& moments)
    {
        const auto n = static_cast<double>(part.particles);
        const double deviation = part.spacing_variation * part.spacing_mean;
        moments.count += n;
        moments.sum += n * part.spacing_mean;
        moments.squares += n * (part.spacing_mean * part.spacing_mean + deviation * deviation);
        all.iteration = std::max(all.iteration, part.iteration);
        all.particles += part.particles;
        all.largest_displacement = std::max(all.largest_displacement, part.largest_displacement);
    }
    static void finish(const Moments& moments, RelaxProgress& out)
    {
        if (moments.sum <= 0) return;
        out.spacing_mean = moments.sum / moments.count;
        const double variance =
            moments.squares / moments.count - out.spacing_mean * out.spacing_mean;
        out.spacing_variation = std::sqrt(std::max(0.0, variance)) / out.spacing_mean;
    }

    RelaxSurfaceReport sum_;
    Moments before_, after_;
};

/// Relaxes one piece of the particles after the other: bodies of few particles together, those of
/// many in slabs. A slab moves its own particles and, once more, those of the slab before that are
/// near; what is around them stands still.
class PieceRelaxation
{
public:
    PieceRelaxation(const std::vector<FittedBody>& bodies, WallParticles& particles,
                    std::vector<char>& held, const RelaxSurfaceOptions& options, int threads)
        : bodies_(bodies),
          particles_(particles),
          held_(held),
          options_(options),
          threads_(threads),
          given_(particles.size()),
          is_out_(given_, 0),
          work_meshes_(bodies.size())
    {
        border_ = (2 * (std::max(2 * options.h, 1.6) + 0.4) + beyond_lists_dp) * options.dp;
        make_room();
    }

    RelaxSurfaceReport run()
    {
        std::vector<std::size_t> count(bodies_.size(), 0);
        for (const std::uint32_t b : particles_.bodies) ++count[b];
        std::vector<std::vector<std::uint32_t>> groups = groups_of(count);
        std::vector<std::vector<PointSlab>> slabs_of_bodies(bodies_.size());
        pieces_ = groups.size();
        for (std::uint32_t b = 0; b < bodies_.size(); ++b)
            if (count[b] > options_.together) slabs_of_bodies[b] = slabs_of(b);
        for (const auto& slabs : slabs_of_bodies) pieces_ += slabs.size();
        for (std::vector<std::uint32_t>& members : groups) relax_piece(members, {}, nullptr);
        for (std::size_t b = 0; b < bodies_.size(); ++b)
        {
            for (std::size_t k = 0; k < slabs_of_bodies[b].size(); ++k)
                relax_slab(slabs_of_bodies[b], k);
            slabs_of_bodies[b] = {};
            work_meshes_[b] = nullptr;
        }
        finish();
        return sum_.report(particles_.size());
    }

private:
    /// Particles are added behind all others: memory for them is asked for once.
    void make_room()
    {
        const std::size_t room = given_ + given_ / 20;
        particles_.positions.reserve(room);
        particles_.kinds.reserve(room);
        particles_.bodies.reserve(room);
        particles_.facets.reserve(room);
        particles_.mk.reserve(room);
        if (!held_.empty()) held_.reserve(room);
        is_out_.reserve(room);
    }

    /// The particles of bodies that are not cut, in groups of neither few nor too many.
    std::vector<std::vector<std::uint32_t>> groups_of(const std::vector<std::size_t>& count) const
    {
        std::vector<std::size_t> group_of(bodies_.size(), 0);
        std::size_t groups = 0, in_group = 0;
        for (std::size_t b = 0; b < bodies_.size(); ++b)
        {
            if (count[b] == 0 || count[b] > options_.together) continue;
            if (groups == 0 || in_group + count[b] > options_.together)
            {
                ++groups;
                in_group = 0;
            }
            in_group += count[b];
            group_of[b] = groups;
        }
        std::vector<std::vector<std::uint32_t>> out(groups);
        for (std::uint32_t i = 0; i < given_; ++i)
            if (const std::size_t group = group_of[particles_.bodies[i]]; group > 0)
                out[group - 1].push_back(i);
        return out;
    }

    /// Of a body with many particles.
    std::vector<PointSlab> slabs_of(std::uint32_t body) const
    {
        std::vector<std::uint32_t> members;
        for (std::uint32_t i = 0; i < given_; ++i)
            if (particles_.bodies[i] == body) members.push_back(i);
        return cut_into_slabs(particles_.positions, members, options_.together,
                              thinnest_slab_dp * options_.dp);
    }

    void relax_slab(std::vector<PointSlab>& slabs, std::size_t k)
    {
        PointSlab& slab = slabs[k];
        const double overlap = overlap_dp * options_.dp;
        const auto place = [&](std::uint32_t i) { return particles_.positions[i][slab.axis]; };
        std::vector<std::uint32_t> moving = slab.members;
        std::vector<std::uint32_t> around;
        if (k > 0)
            for (const std::uint32_t i : slabs[k - 1].members)
            {
                if (place(i) >= slab.low - overlap)
                    moving.push_back(i);
                else if (place(i) >= slab.low - overlap - border_)
                    around.push_back(i);
            }
        if (k + 1 < slabs.size())
            for (const std::uint32_t i : slabs[k + 1].members)
                if (place(i) < slab.high + border_) around.push_back(i);
        if (k > 0) slabs[k - 1].members = {};
        const PointSlab range{slab.axis, slab.low - overlap, slab.high, {}};
        const std::size_t first_new = particles_.size();
        relax_piece(moving, around, &range);
        for (std::size_t i = first_new; i < particles_.size(); ++i)
            slab.members.push_back(static_cast<std::uint32_t>(i));
    }

    /// moving  those that may move if they are not held
    /// around  that stand still
    /// range   where particles may be put in; null: everywhere
    void relax_piece(std::vector<std::uint32_t>& moving, const std::vector<std::uint32_t>& around,
                     const PointSlab* range)
    {
        ++piece_;
        if (is_stopped_) return;
        std::vector<std::uint32_t> members = std::move(moving);
        std::erase_if(members, [&](std::uint32_t i) { return is_out_[i] != 0; });
        const std::size_t moved = members.size();
        for (const std::uint32_t i : around)
            if (is_out_[i] == 0) members.push_back(i);
        WallParticles piece = take(members);
        std::vector<char> held(members.size(), 1);
        for (std::size_t k = 0; k < moved; ++k) held[k] = held_.empty() ? 0 : held_[members[k]];
        const RelaxedTogether relaxed =
            relax_together(bodies_, work_meshes_, piece, held, options_of(range), threads_);
        sum_.add(relaxed.report);
        keep(piece, relaxed.origins, members);
    }

    RelaxSurfaceOptions options_of(const PointSlab* range)
    {
        RelaxSurfaceOptions out = options_;
        out.on_progress = [&](const RelaxProgress& progress)
        {
            RelaxProgress of_piece = progress;
            of_piece.piece = piece_;
            of_piece.pieces = pieces_;
            is_stopped_ = options_.on_progress && !options_.on_progress(of_piece);
            return !is_stopped_;
        };
        if (range == nullptr) return out;
        out.may_insert = [&, range](std::size_t body, const Vec3& p, const Vec3& normal)
        {
            const double at = p[range->axis];
            return at >= range->low && at < range->high &&
                   (!options_.may_insert || options_.may_insert(body, p, normal));
        };
        return out;
    }

    WallParticles take(const std::vector<std::uint32_t>& members) const
    {
        WallParticles out;
        const std::size_t n = members.size();
        out.positions.resize(n);
        out.kinds.resize(n);
        out.bodies.resize(n);
        out.facets.resize(n);
        out.mk.resize(n);
        parallel_for(
            n, threads_,
            [&](std::size_t k)
            {
                const std::uint32_t i = members[k];
                out.positions[k] = particles_.positions[i];
                out.kinds[k] = particles_.kinds[i];
                out.bodies[k] = particles_.bodies[i];
                out.facets[k] = particles_.facets[i];
                out.mk[k] = particles_.mk[i];
            },
            particles_per_chunk);
        return out;
    }

    /// Takes over what a piece came to.
    void keep(const WallParticles& piece, const RelaxOrigins& origins,
              const std::vector<std::uint32_t>& members)
    {
        for (const std::uint32_t i : members) is_out_[i] = 1;
        parallel_for(
            piece.size(), threads_,
            [&](std::size_t k)
            {
                if (origins.is_new[k] != 0) return;
                const std::uint32_t source = members[origins.sources[k]];
                is_out_[source] = 0;
                particles_.positions[source] = piece.positions[k];
                particles_.facets[source] = piece.facets[k];
            },
            particles_per_chunk);
        for (std::size_t k = 0; k < piece.size(); ++k)
        {
            if (origins.is_new[k] == 0) continue;
            particles_.positions.push_back(piece.positions[k]);
            particles_.kinds.push_back(piece.kinds[k]);
            particles_.bodies.push_back(piece.bodies[k]);
            particles_.facets.push_back(piece.facets[k]);
            particles_.mk.push_back(piece.mk[k]);
            is_out_.push_back(0);
            if (held_.empty()) continue;
            const std::uint32_t source = members[origins.sources[k]];
            const bool is_on_feature = particles_.kinds[source] != FitKind::Surface;
            held_.push_back(is_on_feature ? char{0} : held_[source]);
        }
    }

    /// Takes out those that went, and puts those that came to the ends of their bodies.
    void finish()
    {
        std::vector<std::uint32_t> order;
        for (std::uint32_t i = 0; i < is_out_.size(); ++i)
            if (is_out_[i] == 0) order.push_back(i);
        is_out_ = {};
        if (particles_.size() > given_ && bodies_.size() > 1)
            std::stable_sort(order.begin(), order.end(),
                             [&](std::uint32_t a, std::uint32_t b)
                             { return particles_.bodies[a] < particles_.bodies[b]; });
        put_in_order(order, particles_.positions);
        put_in_order(order, particles_.kinds);
        put_in_order(order, particles_.facets);
        put_in_order(order, particles_.mk);
        if (!held_.empty()) put_in_order(order, held_);
        put_in_order(order, particles_.bodies);
        particles_.held = {};
    }
    template <typename T>
    static void put_in_order(const std::vector<std::uint32_t>& order, std::vector<T>& values)
    {
        if (std::is_sorted(order.begin(), order.end()))
        {
            for (std::size_t k = 0; k < order.size(); ++k) values[k] = values[order[k]];
            values.resize(order.size());
            return;
        }
        std::vector<T> out(order.size());
        for (std::size_t k = 0; k < order.size(); ++k) out[k] = values[order[k]];
        values = std::move(out);
    }

    const std::vector<FittedBody>& bodies_;
    WallParticles& particles_;
    std::vector<char>& held_;
    const RelaxSurfaceOptions& options_;
    int threads_;
    std::size_t given_;
    std::vector<char> is_out_; ///< per particle
    double border_ = 0;        ///< metres around a slab
    std::vector<std::shared_ptr<const WorkMesh>> work_meshes_;
    ReportSum sum_;
    std::size_t piece_ = 0, pieces_ = 0;
    bool is_stopped_ = false;
};

} // namespace

RelaxSurfaceReport relax_surface(const std::vector<FittedBody>& bodies, WallParticles& particles,
                                 std::vector<char>& held, const RelaxSurfaceOptions& options,
                                 int threads)
{
    if (!(options.dp > 0))
        throw GeometryError(
            fmt::format("relaxation: dp is {}, expected a distance above 0", options.dp));
    if (!(options.h >= 0.5 && options.h <= 2))
        throw GeometryError(fmt::format("relaxation: h is {} dp, expected 0.5 to 2", options.h));
    if (particles.size() <= options.together || options.snapshot_interval > 0)
    {
        std::vector<std::shared_ptr<const WorkMesh>> work_meshes(bodies.size());
        return relax_together(bodies, work_meshes, particles, held, options, threads).report;
    }
    return PieceRelaxation(bodies, particles, held, options, threads).run();
}

} // namespace fppg
