#include "fppg/relax_volume.h"

#include "core/parallel.h"
#include "fppg/error.h"
#include "relax/continuum.h"
#include "relax/kernel.h"
#include "relax/neighbour_list.h"
#include "relax/wall_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace fppg
{

namespace
{

// All lengths below are in dp, unless they are of Vec3.

constexpr double behind_wall = 0.5; ///< where the continuum begins
/// Lists hold the neighbours within 2.1 dp at h = dp and are made anew when a particle has moved by
/// half of the skin. A pair that comes from beyond 2.1 to below 1.7 in between, which takes two of
/// the fastest on course for one another, is missed; its force is a fiftieth of that at h.
constexpr double list_reach = 1.5;
constexpr float list_skin = 0.6f;
constexpr float momentum = 0.9f;
constexpr float longest_step = 0.1f;
constexpr float push_reach = 0.8f;
constexpr float push_strength = 5.6f; ///< in units of the kernel's factor, a dp
/// Walls are looked for again when a particle has moved so far: on a wall of curvature radius R
/// the plane is off by 0.02 / R.
constexpr float wall_renewal = 0.2f;
constexpr int most_iterations = 100;
/// The count is fitted at these iterations: when forces have evened out what they can.
constexpr int first_count_change = 5;
constexpr int count_change_interval = 5;
constexpr int last_count_change = 15;
/// A stretch of so many particles that together make up for less than half of one is even enough.
constexpr std::size_t even_stretch = 40;
constexpr std::size_t chunk_size = NeighbourList::rows_a_chunk;
constexpr std::uint32_t no_meeting = 0xFFFFFFFF;

/// A wall as a plane.
struct Plane
{
    float x, y, z;  ///< normal, towards the wall
    float distance; ///< from the particle, as of when walls were last looked for
};

/// The walls that meet the nearest one near a particle.
struct MeetingWalls
{
    std::array<Plane, 2> planes;
    std::uint32_t count = 0;
};

/// Particles as the loops need them: those that may move along a Morton curve, then the held ones,
/// then the walls.
struct Band
{
    Vec3 origin;
    double dp = 0;
    std::size_t moving = 0;
    std::size_t volume_end = 0;         ///< where the walls begin
    std::vector<std::uint32_t> sources; ///< of the moving ones, the caller's index
    std::vector<char> is_inserted;
    PointArrays points;
    PointArrays velocities;
    std::vector<char> is_held;

    // Walls as of the last look, per particle that may move:
    std::vector<float> wall_distances;   ///< to the nearest
    PointArrays wall_normals;            ///< towards it; zero where it is out of reach
    PointArrays moved;                   ///< since the last look
    std::vector<char> light_looks;       ///< at the nearest wall only, since all were looked for
    std::vector<std::uint32_t> meetings; ///< index of `meeting_walls`, or none
    std::vector<MeetingWalls> meeting_walls;

    Vec3 place(std::size_t i) const
    {
        return origin + dp * Vec3{points.x[i], points.y[i], points.z[i]};
    }
    /// Where a step leads, rounded as the positions are.
    Vec3 place_after(std::size_t i, const Vec3& step) const
    {
        return origin + dp * Vec3{points.x[i] + static_cast<float>(step.x),
                                  points.y[i] + static_cast<float>(step.y),
                                  points.z[i] + static_cast<float>(step.z)};
    }
    float moved_by(std::size_t i) const
    {
        return std::sqrt(moved.x[i] * moved.x[i] + moved.y[i] * moved.y[i] +
                         moved.z[i] * moved.z[i]);
    }
};

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

void append(PointArrays& points, std::span<const Vec3> positions, const Vec3& origin, double dp)
{
    for (const Vec3& position : positions)
    {
        const Vec3 p = (position - origin) / dp;
        points.x.push_back(static_cast<float>(p.x));
        points.y.push_back(static_cast<float>(p.y));
        points.z.push_back(static_cast<float>(p.z));
    }
}

/// Appends positions along a Morton curve; returns their order.
std::vector<std::uint32_t> append_sorted(PointArrays& points, std::span<const Vec3> positions,
                                         const Vec3& origin, double dp, int threads)
{
    PointArrays unsorted;
    append(unsorted, positions, origin, dp);
    std::vector<std::uint32_t> order = morton_order(unsorted, 1, threads);
    for (const std::uint32_t i : order)
    {
        points.x.push_back(unsorted.x[i]);
        points.y.push_back(unsorted.y[i]);
        points.z.push_back(unsorted.z[i]);
    }
    return order;
}

Band make_band(std::span<const Vec3> positions, const VolumeSurroundings& surroundings,
               const RelaxVolumeOptions& options, int threads)
{
    Band band;
    band.dp = options.dp;
    Box3 box;
    for (const Vec3& p : positions) box.add(p);
    band.origin = 0.5 * (box.min + box.max);
    band.moving = positions.size();
    band.sources = append_sorted(band.points, positions, band.origin, band.dp, threads);
    append_sorted(band.points, surroundings.held, band.origin, band.dp, threads);
    band.volume_end = band.points.size();
    append_sorted(band.points, surroundings.walls, band.origin, band.dp, threads);
    // In the plane all particles are at one y, so that distances are those of the plane.
    if (options.is_2d) std::fill(band.points.y.begin(), band.points.y.end(), 0.0f);
    for (auto* arrays : {&band.velocities, &band.moved, &band.wall_normals})
        arrays->resize(band.moving);
    band.is_held.assign(band.moving, 0);
    band.is_inserted.assign(band.moving, 0);
    band.wall_distances.assign(band.moving, std::numeric_limits<float>::infinity());
    band.light_looks.assign(band.moving, 0);
    band.meetings.assign(band.moving, no_meeting);
    return band;
}

void build_list(NeighbourList& list, const Band& band, double h, int threads)
{
    // The old lists go first, so that both are never there together.
    list = NeighbourList(static_cast<float>(list_reach * h), list_skin);
    list.build(
        band.points, threads,
        [&](std::uint32_t i) { return i < band.moving && band.is_held[i] == 0; },
        [](std::uint32_t, std::uint32_t) { return true; });
}

/// Which of the six neighbours along the axes a particle has, as bits.
unsigned axis_neighbours(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near)
{
    unsigned found = 0;
    for (const std::uint32_t j : near)
    {
        if (j >= band.volume_end) continue;
        const std::array<float, 3> d{band.points.x[j] - band.points.x[i],
                                     band.points.y[j] - band.points.y[i],
                                     band.points.z[j] - band.points.z[i]};
        for (unsigned axis = 0; axis < 3; ++axis)
        {
            const float across = std::abs(d[(axis + 1) % 3]) + std::abs(d[(axis + 2) % 3]);
            const float along = std::abs(d[axis]);
            if (across < 0.2f && std::abs(along - 1) < 0.1f)
                found |= 1u << (2 * axis + (d[axis] > 0 ? 1 : 0));
        }
    }
    return found;
}

/// Marks the particles at a free surface and those within 2 h of them as held.
std::size_t hold_free_surface(Band& band, NeighbourList& list, const VolumeSurroundings& around,
                              const RelaxVolumeOptions& options, int threads)
{
    std::vector<char> is_surface(band.moving, 0);
    const auto is_explained = [&](std::size_t i, unsigned side)
    {
        if (!around.closest) return false;
        Vec3 node = band.place(i);
        node[static_cast<int>(side / 2)] += side % 2 == 1 ? band.dp : -band.dp;
        return norm(around.closest(node) - node) <= (options.clearance_dp + 1e-4) * band.dp;
    };
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= band.moving) return;
            const unsigned found = axis_neighbours(band, i, list.neighbours(row));
            for (unsigned side = 0; side < 6; ++side)
            {
                if (options.is_2d && side / 2 == 1) continue;
                if ((found >> side & 1) == 0 && !is_explained(i, side)) is_surface[i] = 1;
            }
        },
        chunk_size);
    // A little less than 2 h, where the kernel has ended: rows at just that distance are free.
    const auto reach = static_cast<float>(1.999 * options.h_dp);
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= band.moving) return;
            band.is_held[i] = is_surface[i];
            for (const std::uint32_t j : list.neighbours(row))
            {
                if (j >= band.moving || is_surface[j] == 0) continue;
                const float x = band.points.x[j] - band.points.x[i];
                const float y = band.points.y[j] - band.points.y[i];
                const float z = band.points.z[j] - band.points.z[i];
                if (x * x + y * y + z * z < reach * reach) band.is_held[i] = 1;
            }
        },
        chunk_size);
    return static_cast<std::size_t>(std::count(band.is_held.begin(), band.is_held.end(), 1));
}

/// Whether what is known of the walls near a particle may be too old for the force.
bool has_old_walls(const Band& band, std::size_t i, float reach)
{
    const float moved = band.moved_by(i);
    return moved > wall_renewal && band.wall_distances[i] - moved < reach;
}

/// Whether no wall particle around a particle is in front of the plane of the nearest wall: then no
/// second wall meets it there.
bool is_alone(const Band& band, std::size_t i, std::span<const std::uint32_t> near,
              const WallPlane& plane)
{
    constexpr float flatness = 0.3f;
    const auto x = static_cast<float>(plane.normal.x);
    const auto y = static_cast<float>(plane.normal.y);
    const auto z = static_cast<float>(plane.normal.z);
    const auto distance = static_cast<float>(plane.distance / band.dp);
    return std::all_of(near.begin(), near.end(),
                       [&](std::uint32_t j)
                       {
                           if (j < band.volume_end) return true;
                           const float off = (band.points.x[j] - band.points.x[i]) * x +
                                             (band.points.y[j] - band.points.y[i]) * y +
                                             (band.points.z[j] - band.points.z[i]) * z - distance;
                           return off > -flatness;
                       });
}

Plane as_plane(const WallPlane& plane, double dp)
{
    return {static_cast<float>(plane.normal.x), static_cast<float>(plane.normal.y),
            static_cast<float>(plane.normal.z), static_cast<float>(plane.distance / dp)};
}

float approach_to(const Band& band, std::size_t i, const Plane& plane)
{
    return band.moved.x[i] * plane.x + band.moved.y[i] * plane.y + band.moved.z[i] * plane.z;
}

/// Calls visit(plane, distance) for the walls near a particle, with the distance from where it is.
template <typename Visit>
void for_each_wall(const Band& band, std::size_t i, const Visit& visit)
{
    const auto visit_plane = [&](const Plane& plane)
    { visit(plane, std::max(0.0f, plane.distance - approach_to(band, i, plane))); };
    visit_plane({band.wall_normals.x[i], band.wall_normals.y[i], band.wall_normals.z[i],
                 band.wall_distances[i]});
    if (band.meetings[i] == no_meeting) return;
    const MeetingWalls& meeting = band.meeting_walls[band.meetings[i]];
    for (std::uint32_t w = 0; w < meeting.count; ++w) visit_plane(meeting.planes[w]);
}

/// Takes the nearest wall over: the distance counts from here.
void set_nearest_wall(Band& band, std::size_t i, const WallPlanes& found)
{
    const Vec3 normal = found.count > 0 ? found.planes[0].normal : Vec3{};
    band.wall_normals.x[i] = static_cast<float>(normal.x);
    band.wall_normals.y[i] = static_cast<float>(normal.y);
    band.wall_normals.z[i] = static_cast<float>(normal.z);
    band.wall_distances[i] = static_cast<float>(found.distance / band.dp);
    band.moved.x[i] = band.moved.y[i] = band.moved.z[i] = 0;
}

/// Takes over the nearest wall where it is the one that was nearest; the others remain planes,
/// which the particle has come nearer to or farther from. False where walls must be looked for
/// again.
bool renew_nearest_wall(Band& band, std::size_t i, const WallPlanes& found)
{
    constexpr double same_wall = 0.9;
    constexpr char most_light_looks = 3;
    if (found.count == 0 || band.light_looks[i] >= most_light_looks) return false;
    const Vec3 old{band.wall_normals.x[i], band.wall_normals.y[i], band.wall_normals.z[i]};
    if (dot(found.planes[0].normal, old) < same_wall) return false;
    if (band.meetings[i] != no_meeting)
        for (Plane& plane : band.meeting_walls[band.meetings[i]].planes)
            plane.distance -= approach_to(band, i, plane);
    ++band.light_looks[i];
    set_nearest_wall(band, i, found);
    return true;
}

/// Looks for all walls near a particle. Returns those that meet the nearest.
MeetingWalls look_for_walls(Band& band, std::size_t i, std::span<const std::uint32_t> near,
                            double reach, const ClosestWallPoint& closest)
{
    MeetingWalls meeting;
    const Vec3 place = band.place(i);
    WallPlanes found = find_nearest_wall(place, reach * band.dp, closest);
    if (renew_nearest_wall(band, i, found))
        return band.meetings[i] == no_meeting ? meeting : band.meeting_walls[band.meetings[i]];
    if (found.count > 0 && !is_alone(band, i, near, found.planes[0]))
        add_further_walls(found, place, reach * band.dp, closest);
    set_nearest_wall(band, i, found);
    band.light_looks[i] = 0;
    for (int w = 1; w < found.count; ++w)
        meeting.planes[meeting.count++] =
            as_plane(found.planes[static_cast<std::size_t>(w)], band.dp);
    return meeting;
}

/// Looks for walls where needed.
void renew_walls(Band& band, const NeighbourList& list, double reach, bool is_first,
                 const ClosestWallPoint& closest, int threads)
{
    if (!closest) return;
    const std::size_t chunks = (list.rows() + chunk_size - 1) / chunk_size;
    // Particles that come to where walls meet are given a place for them after the loop, in order.
    std::vector<std::vector<std::pair<std::uint32_t, MeetingWalls>>> newly_met(chunks);
    const auto look = [&](std::size_t row, std::size_t chunk)
    {
        const std::uint32_t i = list.point(row);
        if (i >= band.moving || band.is_held[i] != 0) return;
        if (!is_first && !has_old_walls(band, i, static_cast<float>(reach))) return;
        const MeetingWalls meeting = look_for_walls(band, i, list.neighbours(row), reach, closest);
        if (band.meetings[i] != no_meeting)
            band.meeting_walls[band.meetings[i]] = meeting;
        else if (meeting.count > 0)
            newly_met[chunk].emplace_back(i, meeting);
    };
    parallel_for(chunks, threads,
                 [&](std::size_t chunk)
                 {
                     const std::size_t end = std::min(list.rows(), (chunk + 1) * chunk_size);
                     for (std::size_t row = chunk * chunk_size; row < end; ++row) look(row, chunk);
                 });
    for (const auto& chunk : newly_met)
        for (const auto& [i, meeting] : chunk)
        {
            band.meetings[i] = static_cast<std::uint32_t>(band.meeting_walls.size());
            band.meeting_walls.push_back(meeting);
        }
}

/// The forces of equation 15 and the Shepard sums, with what is the same for all particles.
struct Forces
{
    Forces(double h, bool is_2d)
        : beyond(h, is_2d), alpha(is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h))
    {
        inverse_h = static_cast<float>(1 / h);
        slope = static_cast<float>(5 * alpha / (h * h));
        push = static_cast<float>(push_strength * alpha);
    }

    HalfSpace beyond;
    double alpha;
    float inverse_h;
    float slope;
    float push;

    /// Offsets of neighbours, read one by one so that the sums can be vectorised.
    struct Offsets
    {
        std::vector<float> x, y, z;
    };

    struct Result
    {
        float x, y, z;
        double shepard;
    };

    /// The force on particle i and its Shepard sum.
    Result on(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near,
              Offsets& offsets) const
    {
        const std::size_t n = near.size();
        if (offsets.x.size() < n)
            for (auto* v : {&offsets.x, &offsets.y, &offsets.z}) v->resize(2 * n);
        float* const dx = offsets.x.data();
        float* const dy = offsets.y.data();
        float* const dz = offsets.z.data();
        const PointArrays& points = band.points;
        for (std::size_t k = 0; k < n; ++k)
        {
            const std::uint32_t j = near[k];
            dx[k] = points.x[i] - points.x[j];
            dy[k] = points.y[i] - points.y[j];
            dz[k] = points.z[i] - points.z[j];
        }
        float fx = 0, fy = 0, fz = 0, sum = 0;
#pragma omp simd reduction(+ : fx, fy, fz, sum)
        for (std::size_t k = 0; k < n; ++k)
        {
            const float squared = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
            const float r = std::sqrt(squared);
            const float q = r * inverse_h;
            const float s = std::max(0.0f, 1 - 0.5f * q);
            const float s3 = s * s * s;
            const float closeness = std::max(0.0f, 1 - r * (1 / push_reach));
            const float size = slope * s3 + push * closeness;
            fx += size * dx[k];
            fy += size * dy[k];
            fz += size * dz[k];
            sum += s3 * s * (2 * q + 1);
        }
        double shepard = alpha * (1 + static_cast<double>(sum));
        for_each_wall(band, i,
                      [&](const Plane& plane, float distance)
                      {
                          const double way = double{distance} + behind_wall;
                          if (way >= beyond.reach()) return;
                          const auto size = static_cast<float>(beyond.force(way));
                          fx -= size * plane.x;
                          fy -= size * plane.y;
                          fz -= size * plane.z;
                          shepard += beyond.share(way);
                      });
        return {fx, fy, fz, shepard};
    }
};

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
    std::vector<ChunkSums> chunks((n + chunk_size - 1) / chunk_size);
    parallel_for(chunks.size(), threads,
                 [&](std::size_t c)
                 {
                     const std::size_t end = std::min(n, (c + 1) * chunk_size);
                     for (std::size_t k = c * chunk_size; k < end; ++k) body(k, chunks[c]);
                 });
    return add_up(chunks);
}

/// Adds the forces to the velocities, of which `kept` remains.
ChunkSums accelerate(Band& band, const NeighbourList& list, const Forces& forces, float step_length,
                     float kept, int threads)
{
    return sum_over_chunks(list.rows(), threads,
                           [&](std::size_t row, ChunkSums& sums)
                           {
                               const std::uint32_t i = list.point(row);
                               if (i >= band.moving || band.is_held[i] != 0) return;
                               thread_local Forces::Offsets offsets;
                               const Forces::Result f =
                                   forces.on(band, i, list.neighbours(row), offsets);
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
        return static_cast<double>(band.wall_distances[i]) - norm(moved) > limit_ + 1e-3;
    }

    /// Returns the step to make instead, in dp.
    Vec3 allowed_step(Band& band, std::size_t i, Vec3 step) const
    {
        const Vec3 start = band.place(i);
        const WallPlanes nearest = find_nearest_wall(start, (2 * limit_ + 1) * band.dp, closest_);
        renew_nearest_wall(band, i, nearest);
        const double distance = nearest.distance / band.dp;
        const double limit = std::min(limit_, distance);
        if (norm(step) > 0.9 * distance) step = step * (0.9 * distance / norm(step));
        for (int attempt = 0; attempt < 3; ++attempt)
        {
            const Vec3 end = band.place_after(i, step);
            const Vec3 to_wall = (closest_(end) - end) / band.dp;
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
    const ClosestWallPoint& closest_;
    double limit_;
    bool is_2d_;
};

ChunkSums move(Band& band, const WallGuard& guard, const RelaxVolumeOptions& options, int threads)
{
    return sum_over_chunks(
        band.moving, threads,
        [&](std::size_t i, ChunkSums& sums)
        {
            if (band.is_held[i] != 0) return;
            Vec3 step{band.velocities.x[i], band.velocities.y[i], band.velocities.z[i]};
            if (options.is_2d) step.y = 0;
            const double length = norm(step);
            if (length > double{longest_step}) step = step * (double{longest_step} / length);
            if (!guard.is_safe(band, i, step))
            {
                const Vec3 allowed = guard.allowed_step(band, i, step);
                if (!(allowed == step)) ++sums.pushed_back;
                step = allowed;
            }
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

/// The share of the kernel's integral that is farther than a radius, by the rule of rectangles.
double share_beyond(double radius, double h, bool is_2d)
{
    constexpr int steps = 200;
    const double width = (2 * h - radius) / steps;
    double sum = 0;
    for (int n = 0; width > 0 && n < steps; ++n)
    {
        const double r = radius + (n + 0.5) * width;
        const double w = wendland(r / h) * width;
        sum += is_2d ? wendland_alpha_2d(h) * w * 2 * std::numbers::pi * r
                     : wendland_alpha_3d(h) * w * 4 * std::numbers::pi * r * r;
    }
    return sum;
}

/// How far the Shepard sum of a particle is from 1, at h 1.3 times as large: there the sum over
/// even particles is 1 to a few thousandths, however they are arranged. What lies beyond the reach
/// of the lists, `cut_off`, is taken as even. Near to a free surface, where the sum tells nothing,
/// it is 0.
double excess_at(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near,
                 const HalfSpace& beyond, double alpha, double h, double cut_off)
{
    double sum = 1;
    for (const std::uint32_t j : near)
    {
        if (j < band.moving && band.is_held[j] != 0) return 0;
        const float x = band.points.x[j] - band.points.x[i];
        const float y = band.points.y[j] - band.points.y[i];
        const float z = band.points.z[j] - band.points.z[i];
        sum += wendland(static_cast<double>(std::sqrt(x * x + y * y + z * z)) / h);
    }
    sum = alpha * sum + cut_off;
    for_each_wall(band, i,
                  [&](const Plane&, float distance)
                  { sum += beyond.share(double{distance} + behind_wall); });
    return sum - 1;
}

/// Whether a straight way of a given length ends and stays off all walls.
bool is_way_free(const Band& band, const Vec3& from, const Vec3& direction, double length,
                 double limit, const ClosestWallPoint& closest)
{
    if (!closest) return true;
    for (double way = 0;;)
    {
        const Vec3 at = from + (band.dp * way) * direction;
        const double distance = norm(closest(at) - at) / band.dp;
        if (distance < limit) return false;
        if (way >= length) return true;
        way = std::min(length, way + 0.9 * distance);
    }
}

/// The place beside a particle that is farthest from others, among 26 directions (8 in 2D); the
/// particle's own where all are too near to others or to a wall.
Vec3 gap_beside(const Band& band, std::uint32_t i, std::span<const std::uint32_t> near,
                const RelaxVolumeOptions& options, const ClosestWallPoint& closest)
{
    constexpr double length = 0.75;
    constexpr double least_gap = 0.5;
    double widest = least_gap;
    Vec3 best = band.place(i);
    for (int number = 0; number < 27; ++number)
    {
        Vec3 direction{static_cast<double>(number % 3 - 1), static_cast<double>(number / 3 % 3 - 1),
                       static_cast<double>(number / 9 - 1)};
        if (number == 13 || (options.is_2d && direction.y != 0)) continue;
        direction = direction / norm(direction);
        double gap = 2;
        for (const std::uint32_t j : near)
            gap = std::min(gap, norm(Vec3{double{band.points.x[j]} - double{band.points.x[i]},
                                          double{band.points.y[j]} - double{band.points.y[i]},
                                          double{band.points.z[j]} - double{band.points.z[i]}} -
                                     length * direction));
        // A gap must be wider by more than rounding, so that equal ones do not hang on it.
        if (gap < widest + 1e-3) continue;
        if (!is_way_free(band, band.place(i), direction, length,
                         std::min(options.min_wall_distance_dp + 0.05,
                                  static_cast<double>(band.wall_distances[i] - band.moved_by(i))),
                         closest))
            continue;
        widest = gap;
        best = band.place(i) + (band.dp * length) * direction;
    }
    return best;
}

/// Which particles go, and where some come.
struct CountChange
{
    std::vector<char> is_removed;
    struct Inserted
    {
        std::uint32_t beside;
        Vec3 place;
    };
    std::vector<Inserted> inserted;
    std::size_t removed = 0;
};

CountChange find_count_change(const Band& band, const NeighbourList& list,
                              const RelaxVolumeOptions& options, const ClosestWallPoint& closest,
                              int threads)
{
    constexpr double wider = 1.3;
    const double h = wider * options.h_dp;
    const HalfSpace beyond(h, options.is_2d);
    const double alpha = options.is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h);
    const double cut_off =
        share_beyond(list_reach * options.h_dp + double{list_skin}, h, options.is_2d);
    std::vector<float> excess(list.rows(), 0.0f);
    parallel_for(
        list.rows(), threads,
        [&](std::size_t row)
        {
            const std::uint32_t i = list.point(row);
            if (i >= band.moving || band.is_held[i] != 0) return;
            excess[row] = static_cast<float>(
                excess_at(band, i, list.neighbours(row), beyond, alpha, h, cut_off));
        },
        chunk_size);
    CountChange change;
    change.is_removed.assign(band.moving, 0);
    double sum = 0;
    std::size_t highest = 0;
    std::size_t lowest = 0;
    std::size_t length = 0;
    for (std::size_t row = 0; row < list.rows(); ++row)
    {
        if (excess[row] == 0) continue;
        ++length;
        sum += static_cast<double>(excess[row]);
        if (excess[row] > excess[highest]) highest = row;
        if (excess[row] < excess[lowest]) lowest = row;
        if (std::abs(sum) < 0.5) continue;
        if (length > even_stretch)
            sum = 0;
        else if (sum > 0)
        {
            change.is_removed[list.point(highest)] = 1;
            ++change.removed;
            sum -= 1;
        }
        else
        {
            const std::uint32_t i = list.point(lowest);
            const Vec3 place = gap_beside(band, i, list.neighbours(lowest), options, closest);
            if (!(place == band.place(i))) change.inserted.push_back({i, place});
            sum += 1;
        }
        length = 0;
        highest = lowest = row + 1 < list.rows() ? row + 1 : row;
    }
    return change;
}

/// Takes removed particles out of an array and puts inserted ones behind those that stay.
template <typename T, typename Value>
void change_array(std::vector<T>& array, const CountChange& change, const Value& inserted)
{
    const std::size_t moving = change.is_removed.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < moving; ++i)
        if (change.is_removed[i] == 0) array[kept++] = array[i];
    std::vector<T> come;
    for (const CountChange::Inserted& one : change.inserted) come.push_back(inserted(one));
    const auto end_of_kept = array.begin() + static_cast<std::ptrdiff_t>(kept);
    array.erase(end_of_kept, array.begin() + static_cast<std::ptrdiff_t>(moving));
    array.insert(array.begin() + static_cast<std::ptrdiff_t>(kept), come.begin(), come.end());
}

void change_count(Band& band, const CountChange& change)
{
    using Inserted = CountChange::Inserted;
    const auto place = [&](const Inserted& one) { return (one.place - band.origin) / band.dp; };
    const auto zero = [](const Inserted&) { return 0.0f; };
    change_array(band.points.x, change,
                 [&](const Inserted& one) { return static_cast<float>(place(one).x); });
    change_array(band.points.y, change,
                 [&](const Inserted& one) { return static_cast<float>(place(one).y); });
    change_array(band.points.z, change,
                 [&](const Inserted& one) { return static_cast<float>(place(one).z); });
    for (auto* array :
         {&band.velocities.x, &band.velocities.y, &band.velocities.z, &band.moved.y, &band.moved.z,
          &band.wall_distances, &band.wall_normals.x, &band.wall_normals.y, &band.wall_normals.z})
        change_array(*array, change, zero);
    // As if moved far from a wall that was near: walls are looked for before it moves.
    change_array(band.moved.x, change, [](const Inserted&) { return 1.0f; });
    const std::vector<std::uint32_t> sources = band.sources;
    change_array(band.sources, change, [&](const Inserted& one) { return sources[one.beside]; });
    change_array(band.is_inserted, change, [](const Inserted&) { return char{1}; });
    change_array(band.is_held, change, [](const Inserted&) { return char{0}; });
    change_array(band.light_looks, change, [](const Inserted&) { return char{0}; });
    change_array(band.meetings, change, [](const Inserted&) { return no_meeting; });
    band.volume_end += band.sources.size() - band.moving;
    band.moving = band.sources.size();
}

/// Gives the positions back in the caller's order, inserted ones last.
void give_back(const Band& band, const RelaxVolumeOptions& options, std::vector<Vec3>& positions,
               RelaxVolumeReport& report)
{
    std::vector<std::uint32_t> order(band.moving);
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i)
    { return std::tuple(band.is_inserted[i], band.sources[i], i); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<Vec3> result(band.moving);
    for (std::size_t k = 0; k < order.size(); ++k)
    {
        const std::uint32_t i = order[k];
        const Vec3& start = positions[band.sources[i]];
        result[k] = band.is_held[i] != 0 ? start : band.place(i);
        if (options.is_2d) result[k].y = start.y;
        if (options.fit_count) report.sources.push_back(band.sources[i]);
    }
    positions = std::move(result);
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

/// Whether the spread has come down by less than 5 per cent over ten iterations.
bool has_settled(const std::vector<double>& spreads)
{
    constexpr std::size_t apart = 10;
    return spreads.size() > std::size_t{last_count_change} + apart &&
           spreads.back() > 0.95 * spreads[spreads.size() - 1 - apart];
}

} // namespace

RelaxVolumeReport relax_volume(std::vector<Vec3>& positions, const VolumeSurroundings& surroundings,
                               const RelaxVolumeOptions& options, int threads)
{
    check(options, positions, surroundings);
    RelaxVolumeReport report;
    if (positions.empty()) return report;
    Band band = make_band(positions, surroundings, options, threads);
    NeighbourList list(static_cast<float>(list_reach * options.h_dp), list_skin);
    build_list(list, band, options.h_dp, threads);
    report.held_at_surface = hold_free_surface(band, list, surroundings, options, threads);

    const Forces forces(options.h_dp, options.is_2d);
    const WallGuard guard(surroundings.closest, options);
    const double wall_reach = 2 * options.h_dp - behind_wall;
    const auto step_length = static_cast<float>(1 / stiffness(options.h_dp, options.is_2d));
    const int last = options.iterations > 0 ? options.iterations : most_iterations;
    std::vector<double> spreads;
    float kept = momentum;
    renew_walls(band, list, wall_reach, true, surroundings.closest, threads);
    for (int iteration = 1; iteration <= last; ++iteration)
    {
        if (list.is_outdated(band.points, threads)) build_list(list, band, options.h_dp, threads);
        if (options.fit_count && is_count_due(iteration))
        {
            const CountChange change =
                find_count_change(band, list, options, surroundings.closest, threads);
            report.removed += change.removed;
            report.inserted += change.inserted.size();
            change_count(band, change);
            build_list(list, band, options.h_dp, threads);
        }
        if (iteration > 1)
            renew_walls(band, list, wall_reach, false, surroundings.closest, threads);
        const ChunkSums sums = accelerate(band, list, forces, step_length, kept, threads);
        if (sums.count == 0) break;
        kept = sums.work < 0 ? 0 : momentum;
        const ChunkSums steps = move(band, guard, options, threads);
        const auto n = static_cast<double>(sums.count);
        const double mean = sums.shepard / n;
        const double variance = sums.shepard_squared / n - (mean - 1) * (mean - 1);
        report.iterations = iteration;
        report.pushed_back += steps.pushed_back;
        report.shepard_mean = mean;
        report.shepard_std = std::sqrt(std::max(0.0, variance)) / mean;
        spreads.push_back(report.shepard_std);
        if (options.on_iteration &&
            !options.on_iteration({iteration, report.shepard_mean, report.shepard_std,
                                   static_cast<double>(steps.largest_step)}))
            break;
        if (options.iterations == 0 && has_settled(spreads)) break;
    }
    give_back(band, options, positions, report);
    return report;
}

} // namespace fppg
