#include "fppg/relax_volume.h"

#include "fppg/features.h"

#include "core/parallel.h"
#include "core/parallel_sort.h"
#include "fppg/error.h"
#include "meshes/crowded_points.h"
#include "relax/fit_count.h"
#include "relax/free_surface.h"
#include "relax/volume_band.h"
#include "relax/volume_forces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace fppg
{

namespace
{

// All lengths below are in dp, unless they are of Vec3.

constexpr float volume_momentum = 0.9f;
constexpr float longest_step = 0.1f;
constexpr int most_iterations = 100;
/// The count is fitted at these iterations: when forces have evened out what they can.
constexpr int first_count_change = 5;
constexpr int count_change_interval = 5;
constexpr int last_count_change = 15;
constexpr int last_rest = 25;
/// Sliding particles go along tangents for so many iterations.
constexpr int slides_between = 5;

/// What one chunk of particles adds up to.
struct ChunkSums
{
    double work = 0; ///< force times velocity
    double shepard = 0;
    double shepard_squared = 0;
    std::size_t count = 0;
    float largest_step = 0;
    std::size_t pushed_back = 0;
};

void check(const RelaxVolumeOptions& o, std::span<const Vec3> positions,
           const VolumeSurroundings& surroundings)
{
    const auto require = [](bool is_met, const char* name, double value, const char* range)
    {
        if (!is_met)
            throw GeometryError(fmt::format("relaxation of volume particles: {} is {}, not {}",
                                            name, value, range));
    };
    require(o.dp > 0 && std::isfinite(o.dp), "dp", o.dp, "above 0");
    require(o.h_dp >= 0.6 && o.h_dp <= 2, "h_dp", o.h_dp, "from 0.6 to 2");
    require(o.iterations >= 0, "iterations", o.iterations, "at least 0");
    require(o.min_wall_distance_dp >= 0 && o.min_wall_distance_dp <= 1, "min_wall_distance_dp",
            o.min_wall_distance_dp, "from 0 to 1");
    require(o.clearance_dp >= 0 && o.clearance_dp <= 2, "clearance_dp", o.clearance_dp,
            "from 0 to 2");
    for (const auto& some : {positions, surroundings.held, surroundings.walls})
        for (const Vec3& p : some)
            if (!is_finite(p))
                throw GeometryError(fmt::format(
                    "relaxation of volume particles: ({}, {}, {}) is no position", p.x, p.y, p.z));
}

ChunkSums add_up(const std::vector<ChunkSums>& chunks)
{
    ChunkSums total;
    for (const ChunkSums& c : chunks)
    {
        total.work += c.work;
        total.shepard += c.shepard;
        total.shepard_squared += c.shepard_squared;
        total.count += c.count;
        total.largest_step = std::max(total.largest_step, c.largest_step);
        total.pushed_back += c.pushed_back;
    }
    return total;
}

template <typename Body>
ChunkSums sum_over_chunks(std::size_t n, int threads, const Body& body)
{
    std::vector<ChunkSums> chunks((n + NeighbourList::rows_per_chunk - 1) /
                                  NeighbourList::rows_per_chunk);
    parallel_for(chunks.size(), threads,
                 [&](std::size_t c)
                 {
                     const std::size_t end = std::min(n, (c + 1) * NeighbourList::rows_per_chunk);
                     for (std::size_t k = c * NeighbourList::rows_per_chunk; k < end; ++k)
                         body(k, chunks[c]);
                 });
    return add_up(chunks);
}

/// Adds the forces to the velocities, of which `kept` remains.
ChunkSums accelerate(Band& band, const NeighbourList& list, const VolumeForces& forces,
                     float step_length, float kept, int threads)
{
    return sum_over_chunks(list.rows(), threads,
                           [&](std::size_t row, ChunkSums& sums)
                           {
                               const std::uint32_t i = list.point(row);
                               if (i >= band.moving || band.is_held[i] != 0) return;
                               const VolumeForces::Result f =
                                   forces.on(band, i, list.neighbours(row));
                               sums.shepard += f.shepard;
                               sums.shepard_squared += (f.shepard - 1) * (f.shepard - 1);
                               ++sums.count;
                               float& x = band.velocities.x[i];
                               float& y = band.velocities.y[i];
                               float& z = band.velocities.z[i];
                               sums.work += static_cast<double>(f.x * x + f.y * y + f.z * z);
                               x = kept * x + step_length * f.x;
                               y = kept * y + step_length * f.y;
                               z = kept * z + step_length * f.z;
                           });
}

bool slides(VolumeMotion motion)
{
    return motion == VolumeMotion::AlongWall || motion == VolumeMotion::AlongEdge;
}

/// Particles that slide along a wall are put back to their depth after each step; a step may bring
/// them this near to it, dp.
constexpr double limit_of_sliding_dp = 0.4;

/// A step that may come too near to a wall: checked with the exact distance, taken back where it
/// does, and given up where that does not help.
class WallGuard
{
public:
    WallGuard(const ClosestWallPoint& closest, const RelaxVolumeOptions& options)
        : closest_(closest), limit_(options.min_wall_distance_dp), is_2d_(options.is_2d)
    {
    }

    bool is_safe(const Band& band, std::size_t i, const Vec3& step) const
    {
        if (!closest_) return true;
        const Vec3 moved = Vec3{band.moved.x[i], band.moved.y[i], band.moved.z[i]} + step;
        return static_cast<double>(band.wall_distances[i]) - norm(moved) > limit_of(band, i) + 1e-3;
    }

    /// Returns the step to make instead, in dp.
    Vec3 allowed_step(Band& band, std::size_t i, Vec3 step) const
    {
        const Vec3 start = band.place(i);
        const WallPlanes nearest = find_nearest_wall(start, (2 * limit_ + 1) * band.dp, closest_,
                                                     band.wall_within(i) * band.dp);
        renew_nearest_wall(band, i, nearest);
        const double distance = nearest.distance / band.dp;
        const double limit = std::min(limit_of(band, i), distance);
        if (norm(step) > 0.9 * distance) step = step * (0.9 * distance / norm(step));
        for (int attempt = 0; attempt < 3; ++attempt)
        {
            const Vec3 end = band.place_after(i, step);
            const Vec3 to_wall = (closest_(end, norm(nearest.nearest - end)) - end) / band.dp;
            const double left = norm(to_wall);
            if (left >= limit && norm(step) < distance) return step;
            if (!(left > 0)) break;
            Vec3 back = to_wall * ((limit - left + 1e-3) / left);
            if (is_2d_) back.y = 0;
            step = step - back;
        }
        return {};
    }

private:
    double limit_of(const Band& band, std::size_t i) const
    {
        return slides(band.slides[i]) ? std::min(limit_, limit_of_sliding_dp) : limit_;
    }

    const ClosestWallPoint& closest_;
    double limit_;
    bool is_2d_;
};

/// The part of a step that leads along the walls on which a particle slides: those no farther from
/// it than the nearest and a little more.
Vec3 along_walls(const Band& band, std::size_t i, Vec3 step)
{
    constexpr float little_more = 0.3f;
    std::array<Vec3, 3> sideways;
    std::size_t count = 0;
    const auto take = [&](const BandPlane& plane, float distance)
    {
        if (count > 0 && (band.slides[i] != VolumeMotion::AlongEdge || count == sideways.size() ||
                          distance > band.wall_distances[i] + little_more))
            return;
        Vec3 normal{plane.x, plane.y, plane.z};
        for (std::size_t k = 0; k < count; ++k)
            normal = normal - dot(normal, sideways[k]) * sideways[k];
        const double size = norm(normal);
        if (size > 0.2) sideways[count++] = normal / size;
    };
    for_each_wall(band, i, take);
    for (std::size_t k = 0; k < count; ++k) step = step - dot(step, sideways[k]) * sideways[k];
    return count < sideways.size() ? step : Vec3{};
}

ChunkSums move(Band& band, const WallGuard& guard, const VolumeSurroundings& surroundings,
               const RelaxVolumeOptions& options, int threads)
{
    return sum_over_chunks(
        band.moving, threads,
        [&](std::size_t i, ChunkSums& sums)
        {
            if (band.is_held[i] != 0) return;
            Vec3 step{band.velocities.x[i], band.velocities.y[i], band.velocities.z[i]};
            if (options.is_2d) step.y = 0;
            if (slides(band.slides[i])) step = along_walls(band, i, step);
            const double length = norm(step);
            if (length > double{longest_step}) step = step * (double{longest_step} / length);
            if (!guard.is_safe(band, i, step))
            {
                const Vec3 allowed = guard.allowed_step(band, i, step);
                if (!(allowed == step)) ++sums.pushed_back;
                step = allowed;
            }
            if (surroundings.may_come &&
                !surroundings.may_come(band.sources[i], band.place_after(i, step)))
                step = {};
            const auto x = static_cast<float>(step.x);
            const auto y = static_cast<float>(step.y);
            const auto z = static_cast<float>(step.z);
            band.velocities.x[i] = x;
            band.velocities.y[i] = y;
            band.velocities.z[i] = z;
            band.points.x[i] += x;
            band.points.y[i] += y;
            band.points.z[i] += z;
            band.moved.x[i] += x;
            band.moved.y[i] += y;
            band.moved.z[i] += z;
            sums.largest_step = std::max(sums.largest_step, static_cast<float>(norm(step)));
        });
}

/// Puts sliding particles back on their surfaces.
void put_back(Band& band, const VolumeSurroundings& surroundings, bool is_2d, int threads)
{
    if (surroundings.slides.empty()) return;
    parallel_for(
        band.moving, threads,
        [&](std::size_t i)
        {
            if (!slides(band.slides[i]) || band.is_held[i] != 0) return;
            const Vec3 to = surroundings.put_back(band.sources[i], band.place(i));
            Vec3 step = (to - band.place(i)) / band.dp;
            if (is_2d) step.y = 0;
            for (auto* of : {&band.points, &band.moved})
            {
                of->x[i] += static_cast<float>(step.x);
                of->y[i] += static_cast<float>(step.y);
                of->z[i] += static_cast<float>(step.z);
            }
        },
        64);
}

/// Gives the positions back in the caller's order, inserted ones last.
void give_back(const Band& band, const VolumeSurroundings& surroundings,
               const RelaxVolumeOptions& options, int threads, std::vector<Vec3>& positions,
               RelaxVolumeReport& report)
{
    std::vector<std::uint32_t> order(band.moving);
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i)
    { return std::tuple(band.is_inserted[i], band.sources[i], i); };
    parallel_sort(order, threads,
                  [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<Vec3> result(band.moving);
    if (options.fit_count) report.sources.resize(band.moving);
    parallel_for(
        order.size(), threads,
        [&](std::size_t k)
        {
            const std::uint32_t i = order[k];
            const Vec3& start = positions[band.sources[i]];
            result[k] = band.is_held[i] != 0 ? start : band.place(i);
            if (slides(band.slides[i]) && band.is_held[i] == 0)
                result[k] = surroundings.put_back(band.sources[i], result[k]);
            if (options.is_2d) result[k].y = start.y;
            if (options.fit_count) report.sources[k] = band.sources[i];
        },
        1024);
    report.kept = static_cast<std::size_t>(
        std::count(band.is_inserted.begin(),
                   band.is_inserted.begin() + static_cast<std::ptrdiff_t>(band.moving), 0));
    positions = std::move(result);
}

/// Takes out what was squeezed into gaps that are too narrow; inserted particles first.
void drop_crowded(const VolumeSurroundings& surroundings, double least_pair, int threads,
                  std::vector<Vec3>& positions, RelaxVolumeReport& report)
{
    std::vector<Vec3> all = positions;
    all.insert(all.end(), surroundings.held.begin(), surroundings.held.end());
    all.insert(all.end(), surroundings.walls.begin(), surroundings.walls.end());
    constexpr std::uint32_t stays = 0, moved = 1, inserted = 2;
    std::vector<std::uint32_t> rank(all.size(), stays);
    for (std::size_t i = 0; i < positions.size(); ++i) rank[i] = i < report.kept ? moved : inserted;
    const auto may_stay = [&](std::size_t i, std::size_t j)
    { return rank[i] == stays && rank[j] == stays; };
    const std::vector<char> goes = find_crowded(all, rank, least_pair, may_stay, threads);
    std::size_t left = 0, kept = 0;
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        if (goes[i] != 0) continue;
        positions[left] = positions[i];
        report.sources[left++] = report.sources[i];
        if (i < report.kept) ++kept;
    }
    report.removed += positions.size() - left;
    report.kept = kept;
    positions.resize(left);
    report.sources.resize(left);
}

/// An upper bound of the largest eigenvalue of the forces' derivative on square and cubic lattices.
/// Source: computed over the Brillouin zone for h from 0.7 to 1.5, rounded up.
double stiffness(double h, bool is_2d)
{
    return (is_2d ? 4.2 : 5.0) / (h * h * h);
}

bool is_count_due(int iteration)
{
    return iteration >= first_count_change && iteration <= last_count_change &&
           (iteration - first_count_change) % count_change_interval == 0;
}

/// Whether the number wanted was not reached when it was fitted.
bool is_rest_due(const Band& band, const RelaxVolumeOptions& options, int iteration)
{
    return options.wanted && iteration > last_count_change && iteration <= last_rest &&
           iteration % count_change_interval == 0 &&
           std::abs(static_cast<double>(band.moving) - *options.wanted) > 0.5;
}

/// Whether the coefficient of variation has fallen by less than 5 per cent over ten iterations.
bool has_settled(const std::vector<double>& variations)
{
    constexpr std::size_t apart = 10;
    return variations.size() > std::size_t{last_count_change} + apart &&
           variations.back() > 0.95 * variations[variations.size() - 1 - apart];
}

} // namespace

RelaxVolumeReport relax_volume(std::vector<Vec3>& positions, const VolumeSurroundings& surroundings,
                               const RelaxVolumeOptions& options, int threads)
{
    check(options, positions, surroundings);
    RelaxVolumeReport report;
    if (positions.empty()) return report;
    const std::vector<Vec3> before = surroundings.slides.empty() ? std::vector<Vec3>{} : positions;
    Band band = make_band(positions, surroundings, options, threads);
    NeighbourList list(0, 0);
    build_list(list, band, options.h_dp, threads);
    if (options.has_free_surface)
        report.held_at_surface = hold_free_surface(band, list, surroundings, options, threads);

    const VolumeForces forces(options.h_dp, options.behind_wall_dp, options.is_2d);
    const WallGuard guard(surroundings.closest, options);
    const double wall_reach = 2 * options.h_dp - options.behind_wall_dp;
    const auto step_length = static_cast<float>(1 / stiffness(options.h_dp, options.is_2d));
    const int last = options.iterations > 0 ? options.iterations : most_iterations;
    std::vector<double> variations;
    float kept = volume_momentum;
    renew_walls(band, list, wall_reach, true, surroundings.closest, threads);
    for (int iteration = 1; iteration <= last; ++iteration)
    {
        if (list.is_outdated(band.points, threads)) build_list(list, band, options.h_dp, threads);
        const bool is_due = is_count_due(iteration);
        if (options.fit_count && (is_due || is_rest_due(band, options, iteration)))
        {
            const CountChange change =
                find_count_change(band, list, options, surroundings, !is_due, threads);
            report.removed += change.removed;
            report.inserted += change.inserted.size();
            change_count(band, change);
            build_list(list, band, options.h_dp, threads);
        }
        if (iteration > 1)
            renew_walls(band, list, wall_reach, false, surroundings.closest, threads);
        const ChunkSums sums = accelerate(band, list, forces, step_length, kept, threads);
        if (sums.count == 0) break;
        kept = sums.work < 0 ? 0 : volume_momentum;
        const ChunkSums steps = move(band, guard, surroundings, options, threads);
        if (iteration % slides_between == 0) put_back(band, surroundings, options.is_2d, threads);
        const auto n = static_cast<double>(sums.count);
        const double mean = sums.shepard / n;
        const double variance = sums.shepard_squared / n - (mean - 1) * (mean - 1);
        report.iterations = iteration;
        report.pushed_back += steps.pushed_back;
        report.shepard_mean = mean;
        report.shepard_variation = std::sqrt(std::max(0.0, variance)) / mean;
        variations.push_back(report.shepard_variation);
        if (options.on_iteration &&
            !options.on_iteration({iteration, report.shepard_mean, report.shepard_variation,
                                   static_cast<double>(steps.largest_step)}))
            break;
        if (options.iterations == 0 && has_settled(variations)) break;
    }
    list = NeighbourList(0, 0); // its memory is needed for the result
    give_back(band, surroundings, options, threads, positions, report);
    if (options.fit_count && options.least_pair_dp > 0)
        drop_crowded(surroundings, options.least_pair_dp * options.dp, threads, positions, report);
    if (!before.empty())
    {
        // In thin parts particles that slide on layers may be put back to one place of these.
        std::vector<Vec3> starts = positions;
        const std::size_t there = report.sources.empty() ? positions.size() : report.kept;
        for (std::size_t i = 0; i < there; ++i)
            starts[i] = before[report.sources.empty() ? i : report.sources[i]];
        put_back_crowded(positions, starts, least_pair_dp * options.dp, threads);
    }
    return report;
}

} // namespace fppg
