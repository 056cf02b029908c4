#include "relax/volume_band.h"

#include "core/parallel.h"

#include <limits>
#include <utility>

namespace fppg
{

namespace
{

/// Walls are looked for again when a particle has moved so far: on a wall of curvature radius R
/// the plane is off by 0.02 / R.
constexpr float wall_renewal = 0.2f;

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

/// Whether what is known of the walls near a particle may be too old for the force.
bool has_old_walls(const Band& band, std::size_t i, float reach)
{
    const float moved = band.moved_by(i);
    return moved > wall_renewal && band.wall_distances[i] - moved < reach;
}

/// Whether no wall particle around a particle is in front of the plane of the nearest wall: then no
/// second wall meets it there. Unknown, and so false, where walls have no particles here.
bool is_alone(const Band& band, std::size_t i, std::span<const std::uint32_t> near,
              const WallPlane& plane)
{
    if (band.volume_end == band.points.size()) return false;
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

BandPlane as_plane(const WallPlane& plane, double dp)
{
    return {static_cast<float>(plane.normal.x), static_cast<float>(plane.normal.y),
            static_cast<float>(plane.normal.z), static_cast<float>(plane.distance / dp)};
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

/// Looks for all walls near a particle. Returns those that meet the nearest.
MeetingWalls look_for_walls(Band& band, std::size_t i, std::span<const std::uint32_t> near,
                            double reach, const ClosestWallPoint& closest, double within)
{
    MeetingWalls meeting;
    const Vec3 place = band.place(i);
    WallPlanes found = find_nearest_wall(place, reach * band.dp, closest, within);
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

} // namespace

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
    band.slides.assign(band.moving, VolumeMotion::Free);
    if (!surroundings.slides.empty())
        for (std::size_t i = 0; i < band.moving; ++i)
            band.slides[i] = surroundings.slides[band.sources[i]];
    band.is_inserted.assign(band.moving, 0);
    band.wall_distances.assign(band.moving, std::numeric_limits<float>::infinity());
    band.light_looks.assign(band.moving, 0);
    band.meetings.assign(band.moving, no_meeting);
    return band;
}

void build_list(NeighbourList& list, const Band& band, double h, int threads)
{
    // The old lists go first, so that both are never there together.
    list = NeighbourList(static_cast<float>(list_radius(h) - list_skin),
                         static_cast<float>(list_skin));
    list.build(
        band.points, threads,
        [&](std::uint32_t i) { return i < band.moving && band.is_held[i] == 0; },
        [](std::uint32_t, std::uint32_t) { return true; });
}

bool renew_nearest_wall(Band& band, std::size_t i, const WallPlanes& found)
{
    constexpr double same_wall = 0.9;
    constexpr char most_light_looks = 3;
    if (found.count == 0 || band.light_looks[i] >= most_light_looks) return false;
    const Vec3 old{band.wall_normals.x[i], band.wall_normals.y[i], band.wall_normals.z[i]};
    if (dot(found.planes[0].normal, old) < same_wall) return false;
    if (band.meetings[i] != no_meeting)
        for (BandPlane& plane : band.meeting_walls[band.meetings[i]].planes)
            plane.distance -= approach_to(band, i, plane);
    ++band.light_looks[i];
    set_nearest_wall(band, i, found);
    return true;
}

void renew_walls(Band& band, const NeighbourList& list, double reach, bool is_first,
                 const ClosestWallPoint& closest, int threads)
{
    if (!closest) return;
    constexpr std::uint32_t none = 0xFFFFFFFF;
    const std::size_t chunks =
        (list.rows() + NeighbourList::rows_per_chunk - 1) / NeighbourList::rows_per_chunk;
    // Particles that come to where walls meet are given a place for them after the loop, in order.
    std::vector<std::vector<std::pair<std::uint32_t, MeetingWalls>>> newly_met(chunks);
    // A wall that was near to the last particle of the chunk cannot be much farther from the next.
    const auto look = [&](std::size_t row, std::size_t chunk, std::uint32_t& last)
    {
        const std::uint32_t i = list.point(row);
        if (i >= band.moving || band.is_held[i] != 0) return;
        if (!is_first && !has_old_walls(band, i, static_cast<float>(reach))) return;
        double within = band.wall_within(i);
        if (is_first && last != none)
            within = band.wall_within(last) + norm(band.place(i) - band.place(last)) / band.dp;
        last = i;
        const MeetingWalls meeting =
            look_for_walls(band, i, list.neighbours(row), reach, closest, within * band.dp);
        if (band.meetings[i] != no_meeting)
            band.meeting_walls[band.meetings[i]] = meeting;
        else if (meeting.count > 0)
            newly_met[chunk].emplace_back(i, meeting);
    };
    parallel_for(chunks, threads,
                 [&](std::size_t chunk)
                 {
                     const std::size_t end =
                         std::min(list.rows(), (chunk + 1) * NeighbourList::rows_per_chunk);
                     std::uint32_t last = none;
                     for (std::size_t row = chunk * NeighbourList::rows_per_chunk; row < end; ++row)
                         look(row, chunk, last);
                 });
    for (const auto& chunk : newly_met)
        for (const auto& [i, meeting] : chunk)
        {
            band.meetings[i] = static_cast<std::uint32_t>(band.meeting_walls.size());
            band.meeting_walls.push_back(meeting);
        }
}

} // namespace fppg
