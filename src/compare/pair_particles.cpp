#include "compare/pair_particles.h"

#include "core/parallel.h"

#include <atomic>
#include <tuple>

namespace fppg
{

namespace
{

constexpr int rounds = 4;
constexpr std::size_t columns_per_chunk = 16;

/// How well two particles fit; less is better. No two pairs are alike, and a pair has the same
/// rank from both sides.
struct Rank
{
    int group = 3; ///< 0 same place and mk, 1 same place, 2 same mk, 3 no pair
    double by = 0; ///< 0 and 1: whether the ids differ; 2: squared distance
    std::uint32_t a = 0;
    std::uint32_t b = 0;

    bool operator<(const Rank& o) const
    {
        return std::tie(group, by, a, b) < std::tie(o.group, o.by, o.a, o.b);
    }
};

struct Rule
{
    const ParticleSource* a;
    const ParticleSource* b;
    bool has_ids;
    double same_place_squared;
    double reach_squared;

    Rank rank(const SlabParticle& of_a, const SlabParticle& of_b) const
    {
        const Vec3 way = of_a.position - of_b.position;
        const double squared = dot(way, way);
        if (squared > reach_squared && squared > same_place_squared) return {};
        Rank rank{2, squared, of_a.index, of_b.index};
        if (squared <= same_place_squared)
        {
            rank.group = of_a.mk == of_b.mk ? 0 : 1;
            rank.by = has_ids && a->id(of_a.index) != b->id(of_b.index) ? 1 : 0;
        }
        else if (of_a.mk != of_b.mk)
            rank.group = 3;
        return rank;
    }
};

/// Particles of a result, and the partners that they have so far.
struct Side
{
    const CellGrid& grid;
    const std::vector<std::uint32_t>& partners;
};

/// For every particle of `home` without partner, the one of `other` that fits best.
template <typename RankOf>
void find_best(const Side& home_side, const Side& other_side, std::vector<std::uint32_t>& best,
               const RankOf& rank_of, int threads)
{
    const CellGrid& home = home_side.grid;
    const CellGrid& other = other_side.grid;
    const std::vector<std::uint32_t>& partners = home_side.partners;
    const std::vector<std::uint32_t>& other_partners = other_side.partners;
    const auto search = [&](std::uint32_t i, const CellGrid::Stretch* stretches, std::size_t n)
    {
        best[i] = no_partner;
        if (partners[i] != no_partner) return;
        Rank least;
        for (std::size_t s = 0; s < n; ++s)
            for (std::uint32_t j = stretches[s].begin; j < stretches[s].end; ++j)
            {
                if (other_partners[j] != no_partner) continue;
                const Rank rank = rank_of(home.particles()[i], other.particles()[j]);
                if (rank.group == 3 || !(rank < least)) continue;
                least = rank;
                best[i] = j;
            }
    };
    parallel_for(
        home.columns(), threads,
        [&](std::size_t c) { home.for_each_in_column(c, other, 1, search); }, columns_per_chunk);
}

} // namespace

Partners pair_particles(const GridOfFile& a, const GridOfFile& b, double same_place, double reach,
                        int threads)
{
    const Rule rule{&a.file.source(), &b.file.source(),
                    a.file.source().has_ids() && b.file.source().has_ids(), same_place * same_place,
                    reach * reach};
    Partners out;
    out.of_a.assign(a.grid.particles().size(), no_partner);
    out.of_b.assign(b.grid.particles().size(), no_partner);
    std::vector<std::uint32_t> best_of_a(out.of_a.size());
    std::vector<std::uint32_t> best_of_b(out.of_b.size());
    const auto from_a = [&](const SlabParticle& p, const SlabParticle& q)
    { return rule.rank(p, q); };
    const auto from_b = [&](const SlabParticle& p, const SlabParticle& q)
    { return rule.rank(q, p); };
    for (int round = 0; round < rounds; ++round)
    {
        const Side side_a{a.grid, out.of_a};
        const Side side_b{b.grid, out.of_b};
        find_best(side_a, side_b, best_of_a, from_a, threads);
        find_best(side_b, side_a, best_of_b, from_b, threads);
        std::atomic<bool> is_settled = true;
        parallel_for(
            out.of_a.size(), threads,
            [&](std::size_t i)
            {
                const std::uint32_t j = best_of_a[i];
                if (j == no_partner || best_of_b[j] != i) return;
                out.of_a[i] = j;
                out.of_b[j] = static_cast<std::uint32_t>(i);
                is_settled = false;
            },
            4096);
        if (is_settled) break;
    }
    return out;
}

} // namespace fppg
