#include "particles/exact_volumes.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "meshes/inside_by_vote.h"
#include "meshes/point_grid.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fppg
{
namespace
{

/// Points along a dp, in space and in the plane.
constexpr int samples_in_space = 5;
constexpr int samples_in_plane = 9;

/// Calls visit(id, place, share) for the particles of a block before `<initials>`.
template <typename Visit>
void for_each_particle(const CaseParticles& particles, const ParticleBlock& block,
                       const Visit& visit)
{
    std::uint64_t id = block.begin;
    const std::vector<float>& shares = particles.off_lattice.shares;
    for (const ParticleRun& run : block.runs)
        for (std::uint32_t k = 0; k < run.count; ++k)
        {
            const bool has_share = run.is_off_lattice && !shares.empty();
            visit(id++, place_in_run(particles, block, run, k),
                  has_share ? double{shares[run.off_lattice_begin() + k]} : 1.0);
        }
}

/// Farther from all particles of its body a point belongs to none of them: other draws took them.
constexpr double most_distance = 10; ///< dp

/// What of a body lies in the domain, half a dp around its nodes.
Box3 box_in_domain(const SurfaceMesh& mesh, const LatticeGrid& grid, bool& is_cut)
{
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.add(v);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (grid.is_2d && axis == 1) continue;
        const double low = grid.origin[axis] - 0.5 * grid.step(axis);
        const double high = low + grid.step(axis) * grid.n[static_cast<std::size_t>(axis)];
        is_cut = is_cut || box.min[axis] < low || box.max[axis] > high;
        box.min[axis] = std::clamp(box.min[axis], low, high);
        box.max[axis] = std::clamp(box.max[axis], low, high);
    }
    return box;
}

/// The fine lattice over a body.
LatticeGrid sample_grid(const Box3& box, const LatticeGrid& grid)
{
    LatticeGrid out;
    out.is_2d = grid.is_2d;
    out.dp = grid.dp / (grid.is_2d ? samples_in_plane : samples_in_space);
    for (int axis = 0; axis < 3; ++axis)
    {
        out.origin[axis] = box.min[axis] + 0.5 * out.dp;
        out.n[static_cast<std::size_t>(axis)] =
            1 + static_cast<std::uint32_t>((box.max[axis] - box.min[axis]) / out.dp);
    }
    if (!out.is_2d) return out;
    out.origin.y = grid.origin.y;
    out.n[1] = 1;
    return out;
}

/// The particle nearest to each sample of a body, and how many samples each has.
class NearestCounter
{
public:
    NearestCounter(const std::vector<Vec3>& places, double dp)
        : dp_(dp), grid_(dp, places.size()), counts_(places.size(), 0)
    {
        for (const Vec3& p : places) grid_.add(p);
    }

    /// Adds the volume of a body to its particles.
    void add(const FittedBody& body, const LatticeGrid& lattice, int threads)
    {
        bool is_cut = false;
        const LatticeGrid samples = sample_grid(box_in_domain(body.mesh, lattice, is_cut), lattice);
        const InsideVote vote = vote_inside(soup_of(body.mesh), samples, threads);
        std::vector<std::vector<std::uint32_t>> nearest(vote.inside.slabs.size());
        parallel_for(nearest.size(), threads,
                     [&](std::size_t s)
                     {
                         for (const Span& span : vote.inside.slabs[s])
                             for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
                                 nearest[s].push_back(nearest_to(
                                     samples.origin +
                                     samples.dp * Vec3{static_cast<double>(vote.inside.x_begin + s),
                                                       static_cast<double>(span.y),
                                                       static_cast<double>(z)}));
                     });
        double all = 0;
        for (const auto& of_slab : nearest) all += static_cast<double>(of_slab.size());
        if (!(all > 0)) return;
        const double part = is_cut ? std::pow(samples.dp, lattice.is_2d ? 2 : 3)
                                   : body.measures.volume / (lattice.is_2d ? lattice.dp : 1) / all;
        for (const auto& of_slab : nearest)
            for (const std::uint32_t i : of_slab)
                if (i != no_index) counts_[i] += part;
    }

    const std::vector<double>& volumes() const { return counts_; }

private:
    std::uint32_t nearest_to(const Vec3& p) const
    {
        std::uint32_t best = no_index;
        double least = 1e300;
        for (double reach = 1.2 * dp_; least > reach * reach && reach < most_distance * dp_;
             reach *= 2)
            grid_.for_each_near(p, reach,
                                [&](std::uint32_t i, double squared)
                                {
                                    if (squared > least || (squared == least && i > best)) return;
                                    least = squared;
                                    best = i;
                                });
        return best;
    }

    double dp_;
    PointGrid grid_;
    std::vector<double> counts_;
};

bool asks_for_volumes(const CaseDef& def, const FittedBody& body)
{
    const FitSettings* settings = fit_settings(def.fit, body.mk);
    return settings != nullptr && settings->has_exact_volumes && !body.is_layer();
}

} // namespace

std::vector<double> exact_volumes(const CaseDef& def, const FittedWalls& walls,
                                  const CaseParticles& particles, int threads)
{
    std::vector<double> out;
    const double whole = std::pow(particles.grid.dp, particles.grid.is_2d ? 2 : 3);
    std::vector<char> is_done(walls.bodies.size(), 0);
    for (std::size_t b = 0; b < walls.bodies.size(); ++b)
    {
        const FittedBody& body = walls.bodies[b];
        if (is_done[b] != 0 || !asks_for_volumes(def, body)) continue;
        if (!(body.measures.volume > 0) || !(body.measures.filled > 0))
            throw GeometryError(fmt::format(
                "volume=\"exact\": the <{}> of line {} has no inside that is filled; expected a "
                "closed solid",
                body.name, body.line));
        if (out.empty())
        {
            out.assign(particles.np, whole);
            for (const ParticleBlock& block : particles.blocks)
                for_each_particle(particles, block,
                                  [&](std::uint64_t id, const Vec3&, double share)
                                  { out[id] = share * whole; });
        }
        std::vector<char> is_own(65536, 0);
        is_own[body.mk] = 1;
        for (const std::uint16_t mk : body.facet_mk) is_own[mk] = 1;
        std::vector<Vec3> places;
        std::vector<std::uint64_t> ids;
        for (const ParticleBlock& block : particles.blocks)
            if (is_own[block.mk] != 0)
                for_each_particle(particles, block,
                                  [&](std::uint64_t id, const Vec3& p, double)
                                  {
                                      places.push_back(p);
                                      ids.push_back(id);
                                  });
        if (places.empty()) continue;
        NearestCounter counter(places, particles.grid.dp);
        // All bodies of these mks share their particles.
        for (std::size_t other = b; other < walls.bodies.size(); ++other)
        {
            if (walls.bodies[other].is_layer() || is_own[walls.bodies[other].mk] == 0) continue;
            is_done[other] = 1;
            counter.add(walls.bodies[other], particles.grid, threads);
        }
        for (std::size_t i = 0; i < ids.size(); ++i) out[ids[i]] = counter.volumes()[i];
    }
    return out;
}

} // namespace fppg
