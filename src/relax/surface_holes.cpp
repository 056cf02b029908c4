#include "relax/surface_holes.h"

#include "core/even_places.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "fit/walk.h"
#include "meshes/point_grid.h"
#include "relax/surface_layer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace fppg
{

namespace
{

/// Half the side of the square that Voronoi cells are cut from, dp.
constexpr float half_square = 1.3f;
/// Places of holes are no farther from the particle that they are found from, dp: the lists reach
/// all that is within the radius of such a place.
constexpr double farthest_place = 1.1;
constexpr int climbing_steps = 8;
constexpr double area_of_sample = 4; // dp squared
constexpr float reach_of_samples = 2;
/// Of its square, what a neighbour is at least away along the plane to count in it.
constexpr float least_beside = 0.04f;

/// The Voronoi cell of the origin in a plane, cut by one neighbour after another.
class VoronoiCell
{
public:
    explicit VoronoiCell(float half_side)
        : x_{-half_side, half_side, half_side, -half_side},
          y_{-half_side, -half_side, half_side, half_side}
    {
    }

    std::size_t corners() const { return count_; }
    float x(std::size_t k) const { return x_[k]; }
    float y(std::size_t k) const { return y_[k]; }

    /// Keeps what is nearer to the origin than to a point over (x, y) whose distance has the square
    /// `squared`.
    void cut(float x, float y, float squared)
    {
        std::array<float, capacity> excess;
        bool is_cut = false;
        for (std::size_t k = 0; k < count_; ++k)
        {
            excess[k] = x_[k] * x + y_[k] * y - 0.5f * squared;
            is_cut |= excess[k] > 0;
        }
        if (!is_cut || count_ + 2 > capacity) return;
        std::array<float, capacity> xs;
        std::array<float, capacity> ys;
        std::size_t n = 0;
        for (std::size_t k = 0; k < count_; ++k)
        {
            const std::size_t next = k + 1 == count_ ? 0 : k + 1;
            if (excess[k] <= 0)
            {
                xs[n] = x_[k];
                ys[n++] = y_[k];
            }
            if ((excess[k] > 0) == (excess[next] > 0)) continue;
            const float t = excess[k] / (excess[k] - excess[next]);
            xs[n] = x_[k] + t * (x_[next] - x_[k]);
            ys[n++] = y_[k] + t * (y_[next] - y_[k]);
        }
        x_ = xs;
        y_ = ys;
        count_ = n;
    }

private:
    /// A convex polygon gains at most one corner a cut; a cell that has too many is left too wide.
    static constexpr std::size_t capacity = 24;
    std::array<float, capacity> x_;
    std::array<float, capacity> y_;
    std::size_t count_ = 4;
};

struct FloatVector
{
    float x, y, z;

    explicit FloatVector(const Vec3& v)
        : x(static_cast<float>(v.x)), y(static_cast<float>(v.y)), z(static_cast<float>(v.z))
    {
    }
    float along(float dx, float dy, float dz) const { return x * dx + y * dy + z * dz; }
};

/// Two axes of a plane.
struct PlaneAxes
{
    FloatVector x, y;

    /// normal  unit
    explicit PlaneAxes(const Vec3& normal) : PlaneAxes(normal, across(normal)) {}

    Vec3 direction(double along_x, double along_y) const
    {
        return Vec3{x.x, x.y, x.z} * along_x + Vec3{y.x, y.y, y.z} * along_y;
    }

private:
    PlaneAxes(const Vec3& normal, const Vec3& x_axis) : x(x_axis), y(cross(normal, x_axis)) {}

    static Vec3 across(const Vec3& normal)
    {
        const Vec3 other = cross(normal, std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
        return other / norm(other);
    }
};

/// Points around a particle, over the plane of a facet; lengths in dp.
struct PlanePoints
{
    static constexpr std::size_t most = 64; ///< further ones leave the cell too wide
    std::array<float, most> x, y, squared;  ///< squared: of the distance, also across the plane
    std::size_t count = 0;
};

/// In 32 directions; the corners of a cell that the points between two of them miss are nearer to
/// the particle than the circle's radius over 0.95, but for sharp ones, which the cells of other
/// particles have as blunt ones.
constexpr float share_of_radius = 0.95f;
struct Directions
{
    static constexpr std::size_t eighths = 4;
    std::array<std::array<float, lane_count>, eighths> x, y;

    Directions()
    {
        for (std::size_t k = 0; k < eighths * lane_count; ++k)
        {
            const double angle = 2 * std::numbers::pi * static_cast<double>(k) /
                                 static_cast<double>(eighths * lane_count);
            x[k / lane_count][k % lane_count] = static_cast<float>(std::cos(angle));
            y[k / lane_count][k % lane_count] = static_cast<float>(std::sin(angle));
        }
    }
};
const Directions directions;

/// Whether every place on a circle around the particle is nearer to one of the points.
FPPG_LANES bool is_circle_covered(const PlanePoints& points, float radius)
{
    const float half_inverse = 0.5f / radius;
    for (std::size_t k = 0; k < Directions::eighths; ++k)
    {
        const auto& dx = directions.x[k];
        const auto& dy = directions.y[k];
        const Lanes x{dx[0], dx[1], dx[2], dx[3], dx[4], dx[5], dx[6], dx[7]};
        const Lanes y{dy[0], dy[1], dy[2], dy[3], dy[4], dy[5], dy[6], dy[7]};
        Lanes excess{};
        for (std::size_t n = 0; n < points.count; ++n)
            excess = larger(excess,
                            x * points.x[n] + y * points.y[n] - points.squared[n] * half_inverse);
        if (!(smallest_of(excess) > 0)) return false;
    }
    return true;
}

bool is_covered_plain(const PlanePoints& points, float radius)
{
    return is_circle_covered(points, radius);
}

FPPG_AVX2 bool is_covered_avx2(const PlanePoints& points, float radius)
{
    return is_circle_covered(points, radius);
}

/// Whether its neighbours leave no place on a circle around a particle, in a plane, that is nearer
/// to it. False where the particle needs a closer look.
FPPG_LANES bool is_amid(const PackedPoint* points, std::uint32_t particle,
                        std::span<const std::uint32_t> neighbours, const PlaneAxes& axes,
                        float radius)
{
    if (neighbours.size() > PlanePoints::most) return false;
    PlanePoints around;
    const Lanes none{};
    NeighbourLanes(PackedGather{points}, particle)
        .for_each(neighbours.data(), neighbours.size(),
                  [&](const LaneOffsets& o)
                  {
                      const Lanes x = -(o.x * axes.x.x + o.y * axes.x.y + o.z * axes.x.z);
                      const Lanes y = -(o.x * axes.y.x + o.y * axes.y.y + o.z * axes.y.z);
                      const LaneMask is_beside = x * x + y * y >= o.squared * least_beside;
                      const Lanes kept_x = is_beside ? x : none;
                      const Lanes kept_y = is_beside ? y : none;
                      std::memcpy(&around.x[around.count], &kept_x, sizeof kept_x);
                      std::memcpy(&around.y[around.count], &kept_y, sizeof kept_y);
                      std::memcpy(&around.squared[around.count], &o.squared, sizeof o.squared);
                      around.count += lane_count;
                  });
    return is_circle_covered(around, radius);
}

bool is_amid_plain(const PackedPoint* points, std::uint32_t particle,
                   std::span<const std::uint32_t> neighbours, const PlaneAxes& axes, float radius)
{
    return is_amid(points, particle, neighbours, axes, radius);
}

FPPG_AVX2 bool is_amid_avx2(const PackedPoint* points, std::uint32_t particle,
                            std::span<const std::uint32_t> neighbours, const PlaneAxes& axes,
                            float radius)
{
    return is_amid(points, particle, neighbours, axes, radius);
}

/// Whether a facet is beyond one side of a box.
bool is_apart(const Box3& box, const std::array<Vec3, 3>& corners)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] =
            std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
        if (high < box.min[axis] || low > box.max[axis]) return true;
    }
    return false;
}

} // namespace

HoleFinder::HoleFinder(const SurfaceLayer& layer, const std::vector<char>& is_out, double radius)
    : layer_(layer), is_out_(is_out), radius_(radius), row_of_(layer.particles_.size())
{
    parallel_for(
        row_of_.size(), layer.threads_,
        [&](std::size_t row) { row_of_[layer.list_.point(row)] = static_cast<std::uint32_t>(row); },
        NeighbourList::rows_per_chunk);
}

std::vector<SurfaceHole> HoleFinder::find(
    const std::function<bool(const Vec3&, const Vec3&)>& may_fill, bool is_sampled) const
{
    const NeighbourList& list = layer_.list_;
    constexpr std::size_t chunk = NeighbourList::rows_per_chunk;
    std::vector<std::vector<SurfaceHole>> of_chunk((list.rows() + chunk - 1) / chunk);
    parallel_for(of_chunk.size(), layer_.threads_,
                 [&](std::size_t c)
                 {
                     const std::size_t end = std::min((c + 1) * chunk, list.rows());
                     for (std::size_t row = c * chunk; row < end; ++row)
                         if (is_out_[list.point(row)] == 0) find_around(row, of_chunk[c]);
                 });
    std::vector<SurfaceHole> holes;
    for (const auto& some : of_chunk) holes.insert(holes.end(), some.begin(), some.end());
    if (is_sampled) find_by_samples(!may_fill, holes);
    if (may_fill)
        std::erase_if(holes,
                      [&](const SurfaceHole& hole) {
                          return !may_fill(hole.place.position,
                                           layer_.work_.facets[hole.place.facet].normal);
                      });
    std::stable_sort(holes.begin(), holes.end(),
                     [](const SurfaceHole& a, const SurfaceHole& b)
                     { return a.distance > b.distance; });
    choose(holes);
    return holes;
}

/// Of those that are near one another the first is filled.
void HoleFinder::choose(std::vector<SurfaceHole>& holes) const
{
    const double reach = radius_ * layer_.dp_;
    PointGrid grid(reach, holes.size() / 2);
    std::vector<std::uint32_t> facets;
    for (SurfaceHole& hole : holes)
    {
        const Vec3& normal = layer_.work_.facets[hole.place.facet].normal;
        bool is_left = true;
        grid.for_each_near(hole.place.position, reach,
                           [&](std::uint32_t other, double)
                           {
                               const Vec3 offset = grid.points()[other] - hole.place.position;
                               is_left = is_left &&
                                         is_other_sheet(
                                             normal, layer_.work_.facets[facets[other]].normal) &&
                                         !is_close_across(normal, offset / layer_.dp_, false);
                           });
        hole.is_filled = is_left;
        if (!is_left) continue;
        grid.add(hole.place.position);
        facets.push_back(hole.place.facet);
    }
}

void HoleFinder::find_around(std::size_t row, std::vector<SurfaceHole>& holes) const
{
    const LayerParticle& p = layer_.particles_[layer_.list_.point(row)];
    if (!p.is_awake) return;
    if (p.kind == FitKind::Surface) return find_in_plane(row, p.place.facet, holes);
    for (const std::uint32_t facet : layer_.sites_[p.site].facets) find_in_plane(row, facet, holes);
}

void HoleFinder::find_in_plane(std::size_t row, std::uint32_t facet,
                               std::vector<SurfaceHole>& holes) const
{
    const PointArrays& points = layer_.points_;
    const std::uint32_t i = layer_.list_.point(row);
    // Lists leave out what is of another sheet for their particle, which on an edge has the mean
    // normal of its facets.
    const bool is_feature = layer_.particles_[i].kind != FitKind::Surface;
    const WorkFacet& plane = layer_.work_.facets[facet];
    const PlaneAxes axes(plane.normal);
    const auto is_amid_others = is_avx2_there() ? is_amid_avx2 : is_amid_plain;
    if (!is_feature && is_amid_others(layer_.packed_.data(), i, layer_.list_.neighbours(row), axes,
                                      share_of_radius * static_cast<float>(radius_)))
        return;
    PlanePoints around;
    for (const std::uint32_t j : layer_.list_.neighbours(row))
    {
        const float dx = points.x[j] - points.x[i];
        const float dy = points.y[j] - points.y[i];
        const float dz = points.z[j] - points.z[i];
        const float squared = dx * dx + dy * dy + dz * dz;
        if (squared < 1e-9f || is_out_[j] != 0) continue;
        if (is_feature && is_elsewhere(plane.normal, {dx, dy, dz}, j)) continue;
        const std::size_t n = around.count;
        around.x[n] = axes.x.along(dx, dy, dz);
        around.y[n] = axes.y.along(dx, dy, dz);
        around.squared[n] = squared;
        const bool is_beside =
            around.x[n] * around.x[n] + around.y[n] * around.y[n] >= least_beside * squared;
        around.count += is_beside && n + 1 < PlanePoints::most ? 1 : 0;
    }
    const auto is_covered = is_avx2_there() ? is_covered_avx2 : is_covered_plain;
    if (is_feature && is_covered(around, share_of_radius * static_cast<float>(radius_))) return;
    VoronoiCell cell(half_square);
    for (std::size_t n = 0; n < around.count; ++n)
        cell.cut(around.x[n], around.y[n], around.squared[n]);
    for (std::size_t k = 0; k < cell.corners(); ++k)
    {
        const double x = cell.x(k);
        const double y = cell.y(k);
        const double length = std::sqrt(x * x + y * y);
        // The plane only guesses where the surface bends: a little room for that.
        if (length <= 0.99 * radius_) continue;
        const Vec3& place = layer_.particles_[i].place.position;
        const SurfaceRay to = walk(layer_.work_,
                                   {is_feature ? onto_plane(plane, place) : place, facet,
                                    axes.direction(x / length, y / length)},
                                   std::min(length, farthest_place) * layer_.dp_);
        if (to.facet == no_index) continue;
        SurfaceHole hole;
        hole.place = {to.position, to.facet};
        hole.row = static_cast<std::uint32_t>(row);
        hole.beside = i;
        if (climb(hole, layer_.list_.neighbours(row)) && is_far_from_all(hole))
            holes.push_back(hole);
    }
}

/// The box of all particles, with room for the reach of samples.
Box3 HoleFinder::box_of_particles() const
{
    const double room = reach_of_samples * layer_.dp_;
    Box3 box;
    for (const LayerParticle& p : layer_.particles_) box.add(p.place.position);
    box.min = box.min - Vec3{room, room, room};
    box.max = box.max + Vec3{room, room, room};
    return box;
}

/// Points on the facets near particles, one in a few dp squared.
///
/// at_edges  only near particles of edges and corners
std::vector<SlidePlace> HoleFinder::sample_facets(bool at_edges) const
{
    const Box3 around = box_of_particles();
    const double reach = reach_of_samples * layer_.dp_;
    PointGrid lines(reach, layer_.sites_.size());
    for (const FeatureSite& site : layer_.sites_) lines.add(site.position);
    std::vector<SlidePlace> samples;
    double due = 0;
    double count = 0;
    for (std::uint32_t f = 0; f < layer_.work_.facets.size(); ++f)
    {
        const auto& c = layer_.work_.facets[f].corners;
        if (is_apart(around, c)) continue;
        for (due += layer_.work_.area(f) / (area_of_sample * layer_.dp_ * layer_.dp_); due >= 1;
             due -= 1)
        {
            ++count;
            const Vec3 place = even_on_facet(c, count, 0.5);
            if (!at_edges || lines.has_nearer(place, reach)) samples.push_back({place, f});
        }
    }
    return samples;
}

/// Edge particles of another sheet that are close behind a face cover it for fitting, and no
/// Voronoi cell of theirs is cut in its plane. Where particles may not be put everywhere, a place
/// amid a narrow gap is left, too, of which the corners of cells lie where none may be.
///
/// at_edges  only near particles of edges and corners
void HoleFinder::find_by_samples(bool at_edges, std::vector<SurfaceHole>& holes) const
{
    if (layer_.sites_.empty()) return;
    const std::vector<SlidePlace> samples = sample_facets(at_edges);
    PointArrays points = layer_.points_;
    const std::size_t own = points.size();
    points.resize(own + samples.size());
    for (std::size_t s = 0; s < samples.size(); ++s)
    {
        const Vec3 at = layer_.local(samples[s].position);
        points.x[own + s] = static_cast<float>(at.x);
        points.y[own + s] = static_cast<float>(at.y);
        points.z[own + s] = static_cast<float>(at.z);
    }
    NeighbourList list(reach_of_samples, 0);
    list.build(
        points, layer_.threads_, [&](std::uint32_t i) { return i >= own; },
        [&](std::uint32_t, std::uint32_t j) { return j < own; });
    for (std::size_t row = 0; row < list.rows(); ++row)
    {
        if (list.point(row) < own) continue;
        SurfaceHole hole;
        hole.place = samples[list.point(row) - own];
        const auto near = list.neighbours(row);
        if (near.empty()) continue;
        hole.beside = near[0];
        if (!climb(hole, near)) continue;
        hole.row = row_of_[hole.beside];
        holes.push_back(hole);
    }
}

Vec3 HoleFinder::offset_to(const SurfaceHole& hole, std::uint32_t particle) const
{
    const PointArrays& points = layer_.points_;
    return Vec3{points.x[particle], points.y[particle], points.z[particle]} -
           layer_.local(hole.place.position);
}

/// Whether a particle is of another sheet than a place from which `offset` (dp) leads to it.
bool HoleFinder::is_elsewhere(const Vec3& normal, const Vec3& offset, std::uint32_t particle) const
{
    const PointArrays& normals = layer_.normals_;
    const Vec3 other{normals.x[particle], normals.y[particle], normals.z[particle]};
    return is_other_sheet(normal, other) &&
           !is_close_across(normal, offset, layer_.particles_[particle].kind != FitKind::Surface);
}

bool HoleFinder::is_neighbour(const SurfaceHole& hole, std::uint32_t particle,
                              const Vec3& offset) const
{
    return is_out_[particle] == 0 &&
           !is_elsewhere(layer_.work_.facets[hole.place.facet].normal, offset, particle);
}

/// Notes the particle of its sheet that is nearest to a place among some and the one that it is
/// beside; returns the way there, dp.
Vec3 HoleFinder::nearest_to(SurfaceHole& hole, std::span<const std::uint32_t> near) const
{
    double best = std::numeric_limits<double>::infinity();
    Vec3 towards{};
    const auto look_at = [&](std::uint32_t j)
    {
        const Vec3 offset = offset_to(hole, j);
        const double squared = dot(offset, offset);
        if (squared >= best || !is_neighbour(hole, j, offset)) return;
        best = squared;
        towards = offset;
        hole.beside = j;
    };
    look_at(hole.beside);
    for (const std::uint32_t j : near) look_at(j);
    hole.distance = std::sqrt(best);
    return towards;
}

/// Whether the neighbours of neighbours are no nearer: where the surface bends sharply, what is of
/// another sheet for the particle may be of that of the place.
bool HoleFinder::is_far_from_all(const SurfaceHole& hole) const
{
    for (const std::uint32_t j : layer_.list_.neighbours(hole.row))
        for (const std::uint32_t k : layer_.list_.neighbours(row_of_[j]))
        {
            const Vec3 offset = offset_to(hole, k);
            if (dot(offset, offset) <= radius_ * radius_ && is_neighbour(hole, k, offset))
                return false;
        }
    return true;
}

/// Walks away from the nearest particle, step by smaller step, until the place is a hole.
bool HoleFinder::climb(SurfaceHole& hole, std::span<const std::uint32_t> near) const
{
    double step = 0.2 * layer_.dp_;
    for (int i = 0; i < climbing_steps; ++i, step *= 0.8)
    {
        const Vec3 towards = nearest_to(hole, near);
        if (hole.distance > radius_) return true;
        const Vec3& normal = layer_.work_.facets[hole.place.facet].normal;
        const Vec3 away = normal * dot(towards, normal) - towards;
        const double length = norm(away);
        if (length < 1e-6) return false;
        const SurfaceRay to =
            walk(layer_.work_, {hole.place.position, hole.place.facet, away / length}, step);
        if (to.facet == no_index) return false;
        hole.place = {to.position, to.facet};
    }
    return false;
}

} // namespace fppg
