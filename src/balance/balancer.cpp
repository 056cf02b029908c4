#include "balance/balancer.h"

#include "balance/anderson_mixing.h"
#include "balance/iterations.h"
#include "balance/pressure_sums.h"
#include "core/parallel.h"
#include "relax/group_list.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace fppg
{
namespace
{

// Lengths in dp.
constexpr double list_skin = 0.5;
constexpr double longest_step = 0.05;
/// From where a particle starts, on the lattice of the case.
constexpr double farthest_of_case = 1.0;
/// On another lattice, whose nodes are nobody's choice: with 1 dp, particles along the border of
/// the surface in round vessels kept 0.03 g, and the mean 0.0028 g instead of 0.0012.
constexpr double farthest_packed = 4.0;
/// To walls whose particles stand on the surface; nearer, fluid is squeezed between these where it
/// is crowded, as at the inside of a bend.
constexpr double least_distance_dbc = 0.5;
/// To walls whose first particles stand half a dp behind the surface. With 0.5 dp, fluid beside
/// floating bodies was held off them (public SteppedTank: 0.009 g left, 0.002 so).
constexpr double least_distance_behind = 0.2;
constexpr double reach_of_walls = 2.5;
constexpr double face_to_face = -0.8; ///< cosine between the normals of walls beside a pocket
/// Nearer particles are pushed apart: high up, where pressures do not, and where they press what
/// moves against fluid that is held. The push grows with the depth from here on, in dp.
constexpr float least_pair = 0.6F;
constexpr double depth_of_pushes = 2;
/// Walls are looked for again where a particle has moved so far, when lists are made anew.
constexpr double look_again = 0.1;
/// Below the level of its column; the highest particles start half a dp below it.
constexpr double least_depth = 0.25;
constexpr double touching = 1e-3; ///< from what is allowed of a wall
/// Rows of the lattice that start nearer to their level keep their height, so that the surface
/// stays flat.
constexpr double surface_depth = 2;
/// First with mixing, which comes near to rest in few iterations, but ends at the least force in
/// sight; then with momentum (heavy ball), which finds its way on from there. Where walls hold the
/// fluid badly only the first ones count (public SloshingMotion: 0.022 g left, 0.050 without).
constexpr int mixed_iterations = 40;
/// What a particle moves for a force, over h^2 rho / p; with momentum, steps overshoot from 0.5 on.
constexpr double mobility = 0.64;
constexpr double step_factor = 0.3;
constexpr double momentum = 0.9;
constexpr double momentum_against = 0.5; ///< of the momentum that leads against the force
constexpr int iterations_per_look = 10;  ///< at mDBC's pressures; each time gains nothing
constexpr int iterations_per_check = 10;
/// Mean acceleration over gravity at which all is done.
constexpr double calm = 0.0003;
/// Where the mean is below this by first_settled, or later, the fluid keeps what it has: rows of
/// the lattice that go on moving lose their order for 0.0005 g less (2D, 20 dp deep, after 0.1 s:
/// 0.0029 instead of 0.0013 m/s). Fluid on a stable lattice goes on while that is cheap (2D,
/// stairs, after 0.3 s: 0.0006 instead of 0.0010 m/s).
constexpr double settled = 0.002;
/// Where the least mean has fallen by less than this share in so many iterations, more gain little;
/// those that cost little are made all the same.
constexpr double slow_fall = 0.15;
constexpr int iterations_of_fall = 30;
constexpr int first_judged = 20; ///< iteration at which hopeless_mean decides
constexpr std::size_t chunk_of_sums = 4096;
/// Where the mean acceleration stays above this, over gravity, walls do not hold the fluid at rest.
constexpr double calm_mean = 0.1;
/// And where it is above this at the first check: in all cases tried those that came to rest were
/// below 0.09 then, the others above 0.4.
constexpr double hopeless_mean = 0.25;

/// Moves particles along their accelerations until these are small.
class Balancer
{
public:
    Balancer(FluidAtRest& rest, const LatticeFall& fall, const RestWalls& walls, int threads)
        : rest_(rest),
          fall_(fall),
          closest_(walls.closest),
          is_behind_(walls.is_behind),
          keep_out_(walls.keep_out),
          threads_(threads),
          list_(static_cast<float>(rest_reach_dp(rest)), static_cast<float>(list_skin)),
          ghosts_(rest, walls.boundary),
          has_ghosts_(walls.boundary != RestBoundary::Dbc),
          least_distance_(least_distance_dp(walls.boundary)),
          pocket_((has_ghosts_ ? pocket_of_layers_dp : pocket_dp) * rest.dp),
          mixing_(rest.size(), threads)
    {
    }

    void run(BalanceReport& report, const std::function<bool(const BalanceProgress&)>& on_iteration)
    {
        farthest_ = (report.is_packed ? farthest_packed : farthest_of_case) * rest_.dp;
        set_depth_pressures(rest_, threads_);
        start_at_rest();
        renew_lists(true);
        keep_first_distances();
        renew_pressures();
        accelerate();
        report.before = judge();
        const State even = state(report.before.mean);
        State best = state(report.before.mean);
        std::vector<double> least; // mean, up to each check
        std::size_t moving = 0;
        for (std::size_t i = 0; i < rest_.size(); ++i) moving += moves(i) ? 1 : 0;
        const int last = last_iteration(moving);
        for (int it = 1; it <= last && report.particles > report.held; ++it)
        {
            is_mixed_ = it <= mixed_iterations;
            step();
            set_points();
            if (list_.is_outdated(field_.points, threads_)) renew_lists(false);
            if (it % iterations_per_look == 0) renew_pressures();
            accelerate();
            report.iterations = it;
            const double mean = mean_acceleration();
            if (on_iteration && !on_iteration({it, last, mean})) break;
            if (it % iterations_per_check != 0) continue;
            if (it == first_judged && mean > hopeless_mean) break;
            if (mean < best.mean) best = state(mean);
            least.push_back(best.mean);
            const bool is_cheap = static_cast<double>(moving) * it < least_work;
            const bool is_over = best.mean < settled && it >= first_settled;
            if (mean < calm || (is_over && !(report.is_packed && is_cheap)) ||
                (is_slow(least) && !is_cheap))
                break;
        }
        report.is_balanced = best.mean <= calm_mean;
        // On another lattice nothing has a place that it could keep.
        const bool holds_falling = !report.is_balanced && !report.is_packed;
        const std::vector<char> falls = holds_falling ? falling(report) : std::vector<char>{};
        return_to(report.is_balanced ? best : even);
        report.after = judge();
        sum_up_moves(report);
        if (holds_falling) report.falling = hold_around(rest_, falls, threads_);
    }

private:
    struct Mean
    {
        double sum = 0;
        std::size_t count = 0;

        void add(double x, std::size_t n)
        {
            sum += x;
            count += n;
        }
        double value() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
    };
    struct State
    {
        RawArray<Vec3> positions;
        RawArray<Vec3> looked_at; ///< places when walls were looked for
        RawArray<double> pressures;
        double mean = 0; ///< acceleration
    };

    State state(double mean) const
    {
        State out;
        out.positions.resize(rest_.size());
        out.looked_at.resize(rest_.size());
        out.pressures.resize(rest_.size());
        out.mean = mean;
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                out.positions[i] = rest_.positions[i];
                out.looked_at[i] = looked_at_[i];
                out.pressures[i] = rest_.pressures[i];
            },
            4096);
        return out;
    }

    /// What walls do not hold.
    std::vector<char> falling(BalanceReport& report) const
    {
        double largest = hopeless_mean * norm(rest_.gravity);
        const double most = largest;
        std::vector<char> out(rest_.size(), 0);
        for (std::size_t i = 0; i < rest_.size(); ++i)
        {
            const double size = moves(i) ? norm(unheld(i)) : 0;
            out[i] = size > most ? 1 : 0;
            if (size <= largest) continue;
            largest = size;
            report.fastest = rest_.positions[i];
        }
        return out;
    }

    /// least  mean acceleration up to each check
    static bool is_slow(const std::vector<double>& least)
    {
        constexpr std::size_t checks = iterations_of_fall / iterations_per_check;
        return least.size() > checks &&
               least.back() > (1 - slow_fall) * least[least.size() - 1 - checks];
    }

    void start_at_rest()
    {
        start_.resize(rest_.size());
        looked_at_.resize(rest_.size());
        forces_.resize(rest_.size());
        accelerations_.resize(rest_.size());
        allowed_.resize(rest_.size());
        walls_.resize(rest_.size());
        velocities_.resize(rest_.size());
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                start_[i] = looked_at_[i] = rest_.positions[i];
                velocities_[i] = forces_[i] = accelerations_[i] = {};
                allowed_[i] = least_distance_ * rest_.dp;
            },
            4096);
    }

    void return_to(const State& state)
    {
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                // Whether it passed a wall is asked from where that state had last looked for
                // walls.
                rest_.positions[i] = state.looked_at[i];
                if (moves(i)) look_for_walls(i, true);
                rest_.positions[i] = state.positions[i];
                if (moves(i)) look_for_walls(i, false);
                rest_.pressures[i] = state.pressures[i];
                rest_.densities[i] = rest_.density(rest_.pressures[i]);
            },
            64);
        keep_off_walls();
        renew_lists(false);
        renew_pressures();
        accelerate();
    }

    /// Exactly: curved walls bend away from the planes that stand for them.
    void keep_off_walls()
    {
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                if (!moves(i) || walls_[i].distance > allowed_[i] + farthest_) return;
                for (const WallPlane& plane :
                     find_nearest_wall(rest_.positions[i], allowed_[i], closest_))
                    rest_.positions[i] =
                        rest_.positions[i] - (allowed_[i] - plane.distance) * plane.normal;
            },
            64);
    }

    bool moves(std::size_t i) const { return rest_.moves(i); }
    bool is_judged(std::size_t i) const { return rest_.roles[i] == RestRole::Moving; }

    /// Of walls and of neighbours, where the particles are then.
    void renew_lists(bool is_first)
    {
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                if (moves(i)) look_for_walls(i, is_first);
            },
            64);
        set_points();
        list_.build(
            field_.points, threads_, [&](std::size_t i) { return moves(i); },
            [](std::size_t) { return true; });
    }

    /// Looks for the walls around a particle again where it may have come near to others.
    void look_for_walls(std::size_t i, bool is_first)
    {
        const double reach = reach_of_walls * rest_.dp;
        double within = std::numeric_limits<double>::infinity();
        if (!is_first)
        {
            const double moved = norm(rest_.positions[i] - looked_at_[i]);
            if (moved < look_again * rest_.dp || walls_[i].distance - moved > reach) return;
            within = (walls_[i].distance + moved) * (1 + 1e-9);
        }
        WallPlanes found = find_nearest_wall(rest_.positions[i], reach, closest_, within);
        add_further_walls(found, rest_.positions[i], reach, closest_);
        if (!is_first && (passed_wall(i) || (is_in_pocket(found) && !is_in_pocket(walls_[i]))))
        {
            rest_.positions[i] = looked_at_[i];
            velocities_[i] = {};
            return;
        }
        looked_at_[i] = rest_.positions[i];
        walls_[i] = found;
        const double behind = least_distance_behind * rest_.dp;
        if (is_behind_ && allowed_[i] > behind && walls_[i].distance < reach &&
            is_behind_(rest_.positions[i], walls_[i].distance * (1 + 1e-9)))
            allowed_[i] = behind;
    }

    /// What begins nearer to a wall than others may come stays no nearer.
    void keep_first_distances()
    {
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                if (moves(i)) allowed_[i] = std::min(allowed_[i], walls_[i].distance);
            },
            4096);
    }

    /// Whether a particle came through a wall, as in the narrow end of a groove that more walls
    /// bound than are known of.
    bool passed_wall(std::size_t i) const
    {
        const Vec3& from = looked_at_[i];
        const Vec3& to = rest_.positions[i];
        return norm(to - from) > walls_[i].distance &&
               !is_way_free(from, to, touching * rest_.dp, closest_);
    }

    /// Whether a place is between walls that are too near to one another for fluid. Gaps up to 2 dp
    /// beside walls that move are not looked for.
    bool is_in_pocket(const WallPlanes& walls) const
    {
        for (const WallPlane& a : walls)
            for (const WallPlane& b : walls)
                if (dot(a.normal, b.normal) < face_to_face && a.distance + b.distance < pocket_)
                    return true;
        return false;
    }

    /// Of walls, from the fluid where it is now.
    void renew_pressures()
    {
        if (!has_ghosts_) return;
        set_field();
        ghosts_.set(rest_, threads_);
    }

    /// Pressures of their depth, then accelerations.
    void accelerate()
    {
        set_field();
        const double scale = rest_.slope_scale();
        PairShape shape{static_cast<float>(rest_.h / rest_.dp), rest_.is_cubic};
        shape.least_pair = least_pair;
        const double g = norm(rest_.gravity);
        const double deep = rest_.pressure(depth_of_pushes * rest_.dp);
        list_.for_each_group(
            threads_,
            [&](const PointGroup& group)
            {
                const PressureSums sums = pressure_sums(field_, group, shape);
                for (std::size_t l = 0; l < group.count; ++l)
                {
                    const std::uint32_t i = group.points[l];
                    if (!moves(i)) continue;
                    const double depth = rest_.levels[i] - rest_.height(rest_.positions[i]);
                    accelerations_[i] =
                        at_surface(i, rest_.gravity - scale / rest_.densities[i] * sums.of(l) -
                                          fall_.at(depth));
                    forces_[i] = accelerations_[i] +
                                 at_surface(i, g * std::max(1.0, rest_.pressures[i] / deep) *
                                                   sums.push_of(l));
                }
            });
    }

    /// Of what moves a particle, all but the height of a row at the surface.
    Vec3 at_surface(std::size_t i, const Vec3& force) const
    {
        if (rest_.levels[i] - rest_.height(start_[i]) > surface_depth * rest_.dp ||
            !fall_.is_on_row(start_[i]))
            return force;
        const Vec3 up = rest_.gravity / -norm(rest_.gravity);
        return force - dot(force, up) * up;
    }

    /// Where the particles are, as the lists and the sums take them.
    void set_points()
    {
        field_.resize(rest_.size());
        rest_.set_in_dp([&](std::size_t i) { return rest_.positions[i]; }, threads_, field_.points);
    }

    /// Of all particles, those that move at the pressures of their depth.
    void set_field()
    {
        const double dp = rest_.dp;
        const double unit = rest_.is_2d ? dp * dp : dp * dp * dp;
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                if (moves(i))
                {
                    rest_.pressures[i] =
                        rest_.pressure(rest_.levels[i] - rest_.height(rest_.positions[i]));
                    rest_.densities[i] = rest_.density(rest_.pressures[i]);
                }
                const double volume = rest_.masses[i] / rest_.densities[i] / unit;
                field_.packed[i] = PackedPoint{field_.points.x[i], field_.points.y[i],
                                               field_.points.z[i], static_cast<float>(volume)};
                field_.pressures[i] = static_cast<float>(rest_.pressures[i]);
            },
            1024);
    }

    void step()
    {
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                if (moves(i)) forces_[i] = without_pressing(i, forces_[i]);
            },
            1024);
        if (is_mixed_) mixing_.add(rest_.positions, forces_);
        const double soft = rest_.rhop0 * norm(rest_.gravity) * rest_.dp;
        parallel_for(
            rest_.size(), threads_,
            [&](std::size_t i)
            {
                if (!moves(i)) return;
                const double scale = rest_.h * rest_.h * rest_.rhop0 /
                                     (std::max(rest_.pressures[i], soft / 2) + soft);
                Vec3 v = is_mixed_ ? mixing_.step(i, mobility * scale) : with_momentum(i, scale);
                const double length = norm(v);
                if (length > longest_step * rest_.dp) v = v * (longest_step * rest_.dp / length);
                velocities_[i] = v;
                rest_.positions[i] = allowed_place(i, rest_.positions[i] + v);
            },
            256);
    }

    Vec3 with_momentum(std::size_t i, double scale) const
    {
        const Vec3& v = velocities_[i];
        const double kept = momentum * (dot(v, forces_[i]) < 0 ? momentum_against : 1.0);
        return kept * v + step_factor * scale * forces_[i];
    }

    /// Of a force, all but what presses a particle against a wall that it may not come nearer to.
    Vec3 without_pressing(std::size_t i, Vec3 force) const
    {
        for (const WallPlane& plane : walls_[i])
        {
            const double room = plane.distance - std::min(allowed_[i], plane.distance) -
                                dot(rest_.positions[i] - looked_at_[i], plane.normal);
            const double into = dot(force, plane.normal);
            if (room < touching * rest_.dp && into > 0) force = force - into * plane.normal;
        }
        return force;
    }

    /// What the solver's walls do not take of an acceleration.
    Vec3 unheld(std::size_t i) const
    {
        return keep_out_ ? without_pressing(i, accelerations_[i]) : accelerations_[i];
    }

    /// The place nearest to `to` that keeps its distance from walls, start and surface.
    Vec3 allowed_place(std::size_t i, Vec3 to) const
    {
        for (const WallPlane& plane : walls_[i])
        {
            const double distance = plane.distance - dot(to - looked_at_[i], plane.normal);
            const double allowed = std::min(allowed_[i], plane.distance);
            if (distance < allowed) to = to - (allowed - distance) * plane.normal;
        }
        const Vec3 moved = to - start_[i];
        const double length = norm(moved);
        if (length > farthest_) to = start_[i] + moved * (farthest_ / length);
        const double above = rest_.height(to) - rest_.levels[i] + least_depth * rest_.dp;
        if (above > 0) to = to + rest_.gravity * (above / norm(rest_.gravity));
        return to;
    }

    double mean_acceleration() const
    {
        std::vector<Mean> chunks((rest_.size() + chunk_of_sums - 1) / chunk_of_sums);
        parallel_for(chunks.size(), threads_,
                     [&](std::size_t c)
                     {
                         const std::size_t end = std::min(rest_.size(), (c + 1) * chunk_of_sums);
                         for (std::size_t i = c * chunk_of_sums; i < end; ++i)
                             if (is_judged(i)) chunks[c].add(norm(unheld(i)), 1);
                     });
        Mean all;
        for (const Mean& chunk : chunks) all.add(chunk.sum, chunk.count);
        return all.value() / norm(rest_.gravity);
    }

    Accelerations judge() const
    {
        const double g = norm(rest_.gravity);
        std::vector<double> sizes;
        for (std::size_t i = 0; i < rest_.size(); ++i)
            if (is_judged(i)) sizes.push_back(norm(unheld(i)) / g);
        Accelerations out;
        if (sizes.empty()) return out;
        const auto n = static_cast<double>(sizes.size());
        out.mean = std::accumulate(sizes.begin(), sizes.end(), 0.0) / n;
        out.above_5 = static_cast<double>(std::count_if(sizes.begin(), sizes.end(),
                                                        [](double a) { return a > 0.05; })) /
                      n;
        const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * (n - 1));
        std::nth_element(sizes.begin(), at, sizes.end());
        out.of_99 = *at;
        out.largest = *std::max_element(at, sizes.end());
        return out;
    }

    void sum_up_moves(BalanceReport& report) const
    {
        std::size_t count = 0;
        for (std::size_t i = 0; i < rest_.size(); ++i)
        {
            if (!is_judged(i)) continue;
            const double moved = norm(rest_.positions[i] - start_[i]) / rest_.dp;
            report.mean_move_dp += moved;
            report.largest_move_dp = std::max(report.largest_move_dp, moved);
            ++count;
        }
        if (count > 0) report.mean_move_dp /= static_cast<double>(count);
    }

    FluidAtRest& rest_;
    const LatticeFall& fall_;
    const ClosestWallPoint& closest_;
    const std::function<bool(const Vec3&, double)>& is_behind_;
    bool keep_out_;
    int threads_;
    GroupList list_;
    GhostPressures ghosts_;
    bool has_ghosts_;
    double least_distance_; ///< to a wall, dp
    double pocket_;         ///< metres between walls with a pocket between them
    double farthest_ = 0;   ///< metres from the start
    RawArray<Vec3> accelerations_;
    RawArray<Vec3> forces_; ///< these and pushes, which are only there while particles move
    AndersonMixing mixing_;
    bool is_mixed_ = false;
    RawArray<Vec3> velocities_; ///< metres an iteration
    PressureField field_;
    RawArray<Vec3> start_;
    RawArray<Vec3> looked_at_;   ///< places when walls were looked for
    RawArray<WallPlanes> walls_; ///< of those that move
    RawArray<double> allowed_;   ///< metres to a wall
};

} // namespace

double least_distance_dp(RestBoundary boundary)
{
    return boundary == RestBoundary::Dbc ? least_distance_dbc : least_distance_behind;
}

void bring_to_rest(FluidAtRest& rest, const LatticeFall& fall, const RestWalls& walls, int threads,
                   const std::function<bool(const BalanceProgress&)>& on_iteration,
                   BalanceReport& report)
{
    Balancer(rest, fall, walls, threads).run(report, on_iteration);
}

} // namespace fppg
