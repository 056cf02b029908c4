#include "balance/wall_pressure.h"

#include "balance/small_matrix.h"
#include "core/parallel.h"
#include "meshes/point_grid.h"

namespace fppg
{
namespace
{

constexpr float skin_dp = 0.6F;

} // namespace

void set_depth_pressures(FluidAtRest& rest, int threads)
{
    const double reach = 2 * rest.h + rest.dp;
    PointGrid fluid(reach, rest.size());
    std::vector<std::uint32_t> of_point;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (rest.roles[i] != RestRole::Bound && rest.pressures[i] > 0)
        {
            fluid.add(rest.positions[i]);
            of_point.push_back(static_cast<std::uint32_t>(i));
        }
    parallel_for(
        rest.size(), threads,
        [&](std::size_t i)
        {
            // Fluid above the highest nodes says nothing of the level.
            if (rest.roles[i] != RestRole::Bound && rest.pressures[i] > 0) return;
            const auto nearest = fluid.nearest(rest.positions[i], reach);
            rest.levels[i] =
                nearest ? rest.levels[of_point[*nearest]] : rest.height(rest.positions[i]);
            rest.pressures[i] = rest.pressure(rest.levels[i] - rest.height(rest.positions[i]));
            rest.densities[i] = rest.density(rest.pressures[i]);
        },
        64);
}

/// What the solver sums over the fluid around a ghost node. Rows: of the kernel and of the
/// components of its gradient; columns: of the density there and of its gradient. Densities are
/// those over rhop0: a fit of densities that are all the same is exact.
struct GhostPressures::Sums
{
    SmallMatrix matrix;
    std::array<double, SmallMatrix::most_rows> densities{};
    bool has_fluid = false;
};

GhostPressures::GhostPressures(const FluidAtRest& rest, RestBoundary boundary)
    : boundary_(boundary), list_(static_cast<float>(rest_reach_dp(rest)), skin_dp)
{
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (rest.roles[i] == RestRole::Bound && norm(rest.ghosts[i]) > 0)
        {
            owners_.push_back(static_cast<std::uint32_t>(i));
            masses_.push_back(rest.masses[i]);
        }
}

void GhostPressures::set_field(const FluidAtRest& rest, int threads)
{
    first_ghost_ = rest.size();
    field_.resize(rest.size() + owners_.size());
    const double unit = rest.is_2d ? rest.dp * rest.dp : rest.dp * rest.dp * rest.dp;
    parallel_for(
        field_.packed.size(), threads,
        [&](std::size_t i)
        {
            const bool is_ghost = i >= first_ghost_;
            const std::size_t of = is_ghost ? owners_[i - first_ghost_] : i;
            const Vec3 place = is_ghost ? rest.positions[of] + rest.ghosts[of] : rest.positions[i];
            const Vec3 at = (place - rest.origin) / rest.dp;
            field_.points.x[i] = static_cast<float>(at.x);
            field_.points.y[i] = static_cast<float>(at.y);
            field_.points.z[i] = static_cast<float>(at.z);
            const double volume = rest.masses[of] / rest.densities[of] / unit;
            field_.packed[i] = PackedPoint{field_.points.x[i], field_.points.y[i],
                                           field_.points.z[i], static_cast<float>(volume)};
            field_.pressures[i] = static_cast<float>(rest.densities[of] - rest.rhop0);
        },
        1024);
    if (!list_.is_outdated(field_.points, threads)) return;
    list_.build(
        field_.points, threads, [&](std::size_t i) { return i >= first_ghost_; },
        [&](std::size_t j) { return j < first_ghost_ && rest.roles[j] != RestRole::Bound; });
}

GhostPressures::Sums GhostPressures::sums_of(const FluidAtRest& rest,
                                             const DensitySums& dimless) const
{
    // Of sums in dp and dp^3 to those in metres.
    const double dp = rest.dp;
    const double of_w = rest.alpha() * (rest.is_2d ? dp * dp : dp * dp * dp);
    const double of_s = of_w / (rest.h * rest.h) * dp;
    // The matrix is w, -w r; s r, -s r r: its parts are summed once.
    constexpr std::array<std::array<std::size_t, 3>, 3> pairs{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
    Sums sums;
    sums.has_fluid = dimless.w > 0;
    const std::array<std::size_t, 3> axes{0, rest.is_2d ? 2U : 1U, 2}; // 2D: without y
    sums.matrix.n = rest.is_2d ? 3 : 4;
    sums.matrix.at(0, 0) = of_w * double{dimless.w};
    sums.densities[0] = of_w * double{dimless.w_e};
    for (int r = 1; r < sums.matrix.n; ++r)
    {
        const std::size_t a = axes[static_cast<std::size_t>(r - 1)];
        sums.densities[static_cast<std::size_t>(r)] = of_s * double{dimless.s_e_r[a]};
        sums.matrix.at(0, r) = -of_w * dp * double{dimless.w_r[a]};
        sums.matrix.at(r, 0) = of_s * double{dimless.s_r[a]};
        for (int c = 1; c < sums.matrix.n; ++c)
            sums.matrix.at(r, c) =
                -of_s * dp * double{dimless.s_r_r[pairs[a][axes[static_cast<std::size_t>(c - 1)]]]};
    }
    return sums;
}

void GhostPressures::set_one(FluidAtRest& rest, std::uint32_t point,
                             const DensitySums& dimless) const
{
    const std::uint32_t i = owners_[point - first_ghost_];
    // Of JSphCpu_mdbc.cpp.
    constexpr double least_determinant = 1e-3;
    constexpr double least_sum = 0.1;
    constexpr double largest_condition = 50;
    const Vec3 ghost = rest.ghosts[i];
    const Sums sums = sums_of(rest, dimless);
    const bool is_new = boundary_ == RestBoundary::Mdbc2;
    if (!sums.has_fluid)
    {
        rest.pressures[i] = 0;
        rest.densities[i] = rest.rhop0;
        if (is_new) rest.masses[i] = 0;
        return;
    }
    const double shepard = rest.rhop0 + sums.densities[0] / sums.matrix.at(0, 0);
    double density = shepard;
    std::array<double, SmallMatrix::most_rows> fit{};
    bool has_fit = false;
    SmallMatrix inverse;
    if (is_new && sums.matrix.at(0, 0) < least_sum)
        density = std::max(rest.rhop0, shepard);
    else if (std::abs(invert(sums.matrix, inverse)) >= least_determinant &&
             (!is_new ||
              rest.dp * rest.dp * sums.matrix.largest_row_sum() * inverse.largest_row_sum() <=
                  largest_condition))
    {
        has_fit = true;
        for (int r = 0; r < sums.matrix.n; ++r)
            for (int c = 0; c < sums.matrix.n; ++c)
                fit[static_cast<std::size_t>(r)] +=
                    inverse.at(r, c) * sums.densities[static_cast<std::size_t>(c)];
        density = rest.rhop0 + fit[0];
    }
    if (is_new)
    {
        const double c2 = rest.b * rest.gamma / rest.rhop0;
        const Vec3 n = ghost / norm(ghost);
        const double cloned =
            c2 * (density - rest.rhop0) - rest.rhop0 * dot(rest.gravity, n) * norm(ghost);
        density = rest.rhop0 + cloned / c2;
    }
    else if (has_fit)
        density -= fit[1] * ghost.x +
                   (rest.is_2d ? fit[2] * ghost.z : fit[2] * ghost.y + fit[3] * ghost.z);
    rest.masses[i] = masses_[static_cast<std::size_t>(
        std::lower_bound(owners_.begin(), owners_.end(), i) - owners_.begin())];
    rest.densities[i] = density;
    rest.pressures[i] = rest.pressure_of_density(density);
}

void GhostPressures::set(FluidAtRest& rest, int threads)
{
    set_field(rest, threads);
    const PairShape shape{static_cast<float>(rest.h / rest.dp), rest.is_cubic};
    list_.for_each_group(threads,
                         [&](const PointGroup& group)
                         {
                             const auto sums = density_sums(field_, group, shape);
                             for (std::size_t l = 0; l < group.count; ++l)
                                 set_one(rest, group.points[l], sums[l]);
                         });
}

} // namespace fppg
