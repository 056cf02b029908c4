#include "particles/floating.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

using Moments = std::array<std::array<double, 3>, 3>;

/// Sums over particles off the lattice, each by its share, in steps of dp from the node `from`.
class FreeSums
{
public:
    FreeSums(const LatticeGrid& grid, const std::array<std::int64_t, 3>& from)
        : grid_(grid),
          from_{static_cast<double>(from[0]), static_cast<double>(from[1]),
                static_cast<double>(from[2])}
    {
    }

    void add(const Vec3& position, double share)
    {
        Vec3 p = (position - grid_.origin) / grid_.dp - from_;
        if (grid_.is_2d) p.y = 0;
        places_.push_back(p);
        shares_.push_back(share);
        sum_ = sum_ + p * share;
        count_ += share;
    }
    bool is_empty() const { return places_.empty(); }
    const Vec3& sum() const { return sum_; }
    double count() const { return count_; }
    Moments moments(const Vec3& about) const
    {
        Moments out{};
        for (std::size_t k = 0; k < places_.size(); ++k)
        {
            const Vec3 d = places_[k] - about;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = i; j < 3; ++j)
                    out[i][j] += shares_[k] * d[static_cast<int>(i)] * d[static_cast<int>(j)];
        }
        return out;
    }

private:
    const LatticeGrid& grid_;
    Vec3 from_;
    Vec3 sum_;
    double count_ = 0;
    std::vector<Vec3> places_;
    std::vector<double> shares_;
};

} // namespace

FloatingBody floating_body(const FloatingDef& def, const CaseParticles& particles,
                           std::size_t block_index, double mass_bound)
{
    const ParticleBlock& block = particles.blocks[block_index];
    const LatticeGrid& grid = particles.grid;

    // Sums over the nodes, indices taken from the first node so that they stay small.
    using Whole = __int128;
    std::array<std::int64_t, 3> from{0, 0, 0};
    const auto first = std::find_if(block.runs.begin(), block.runs.end(),
                                    [](const ParticleRun& r) { return !r.is_free(); });
    if (first != block.runs.end()) from = {first->x, first->y, first->z};
    std::uint64_t nodes = 0;
    FreeSums free(grid, from);
    std::array<Whole, 3> sum{};
    std::array<std::array<Whole, 3>, 3> product{};
    for (const ParticleRun& run : block.runs)
    {
        if (run.is_free())
        {
            for (std::uint32_t i = 0; i < run.count; ++i)
            {
                const std::size_t at = run.free_begin() + i;
                const std::vector<float>& shares = particles.free.shares;
                free.add(particles.free.positions[at], shares.empty() ? 1 : double{shares[at]});
            }
            continue;
        }
        nodes += run.count;
        // A run's nodes differ in z only, whichever way they follow one another.
        const std::int64_t low =
            block.run_descending ? static_cast<std::int64_t>(run.z) - run.count + 1 : run.z;
        const Whole x = static_cast<std::int64_t>(run.x) - from[0];
        const Whole y = static_cast<std::int64_t>(run.y) - from[1];
        const Whole count = run.count;
        const Whole z = low - from[2];
        const Whole z_sum = count * z + count * (count - 1) / 2;
        const Whole z_squares =
            count * z * z + z * count * (count - 1) + (count - 1) * count * (2 * count - 1) / 6;
        sum[0] += count * x;
        sum[1] += count * y;
        sum[2] += z_sum;
        product[0][0] += count * x * x;
        product[1][1] += count * y * y;
        product[2][2] += z_squares;
        product[0][1] += count * x * y;
        product[0][2] += x * z_sum;
        product[1][2] += y * z_sum;
    }

    FloatingBody body;
    body.block = block_index;
    const auto n_nodes = static_cast<double>(nodes);
    const double n = n_nodes + free.count(); // of whole particles
    const double volume = grid.is_2d ? grid.dp * grid.dp : grid.dp * grid.dp * grid.dp;
    body.mass_body = def.mass_body ? *def.mass_body : def.rhop_body.value_or(0) * n * volume;
    body.mass_part = def.distribute_mass ? body.mass_body / static_cast<double>(block.count)
                                         : def.mass_part.value_or(mass_bound);
    Vec3 mean; // of the indices, from `from`
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        mean[axis] = free.is_empty() ? static_cast<double>(sum[k]) / n
                                     : (static_cast<double>(sum[k]) + free.sum()[axis]) / n;
        body.center[axis] =
            grid.origin[axis] + (static_cast<double>(from[k]) + mean[axis]) * grid.dp;
    }
    Vec3 offset; // from the centre that the inertia is about to the mean, metres
    if (def.center)
    {
        offset = body.center - *def.center;
        body.center = *def.center;
    }
    if (grid.is_2d) offset.y = 0;
    if (def.inertia)
    {
        body.inertia = *def.inertia;
        return body;
    }
    // Second moments about the mean, in steps: those of the nodes about their own mean are
    // n * product - sum * sum in whole numbers. Then about the centre, in metres.
    const Moments of_free = free.moments(mean);
    Moments moment{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j)
        {
            const Whole exact = static_cast<Whole>(nodes) * product[i][j] - sum[i] * sum[j];
            double about_mean = nodes > 0 ? static_cast<double>(exact) / n_nodes : 0;
            if (!free.is_empty())
            {
                const auto shift = [&](std::size_t k) {
                    return nodes > 0
                               ? static_cast<double>(sum[k]) / n_nodes - mean[static_cast<int>(k)]
                               : 0;
                };
                about_mean += n_nodes * shift(i) * shift(j) + of_free[i][j];
            }
            moment[i][j] = about_mean * (grid.dp * grid.dp) +
                           n * offset[static_cast<int>(i)] * offset[static_cast<int>(j)];
            moment[j][i] = moment[i][j];
        }
    const double m = body.mass_body / n;
    const double trace = moment[0][0] + moment[1][1] + moment[2][2];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            const double value = moment[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
            // A zero stays a plain zero, so that Case.xml shows a diagonal tensor as one.
            const double entry = i == j ? m * (trace - value) : value == 0 ? 0 : -m * value;
            body.inertia[static_cast<std::size_t>(i)][j] = entry;
        }
    return body;
}

} // namespace fppg
