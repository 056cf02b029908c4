#include "fit/chart_filler.h"

#include "core/even_places.h"
#include "core/parallel.h"
#include "fit/chart_grid.h"
#include "fppg/error.h"

#include <algorithm>
#include <numbers>
#include <queue>
#include <span>

#include <fmt/format.h>

namespace fppg
{

/// In the plane of a facet.
struct ChartPoint
{
    double x, y;
};

/// A place where a particle may be missing.
struct ChartHole
{
    double distance; ///< to the nearest particle, metres
    std::uint32_t order;
    SurfaceRay place;

    bool operator<(const ChartHole& other) const
    {
        return distance != other.distance ? distance < other.distance : order > other.order;
    }
};

namespace
{

// Lengths in dp. What the front keeps and aims at was found by trial: these leave the fewest holes
// at one particle a dp squared.
constexpr double front_spacing = 1.075;
constexpr double least_distance = 0.86;
constexpr double same_site = 0.25;     ///< a front meets a particle where it would put one
constexpr double clearly_taken = 0.50; ///< the walk there can be saved
constexpr double neighbour_reach = ChartGrid::reach; ///< of everything that looks for neighbours

constexpr float square(double x)
{
    return static_cast<float>(x * x);
}

Vec3 any_direction(const WorkFacet& facet)
{
    const Vec3 side = facet.corners[1] - facet.corners[0];
    return side / norm(side);
}

constexpr double half_root = std::numbers::sqrt3 / 2;
constexpr std::array<double, 6> sixth_cosines{1, 0.5, -0.5, -1, -0.5, 0.5};
constexpr std::array<double, 6> sixth_sines{0, half_root, half_root, 0, -half_root, -half_root};

/// A direction and the one left of it, turned by sixths of a circle; the last two lanes repeat.
EightNumbers turned_by_sixths(double along, double left)
{
    EightNumbers result;
    for (std::size_t l = 0; l < result.size(); ++l)
        result[l] = static_cast<float>(along * sixth_cosines[l % 6] + left * sixth_sines[l % 6]);
    return result;
}

/// Keeps of a convex polygon what is nearer to the origin than to a point over `other`, which is
/// at a distance of the origin whose square is `squared`.
void clip(std::vector<ChartPoint>& polygon, const ChartPoint& other, double squared,
          std::vector<ChartPoint>& spare)
{
    const double limit = 0.5 * squared;
    const auto excess = [&](const ChartPoint& p) { return p.x * other.x + p.y * other.y - limit; };
    spare.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const ChartPoint& a = polygon[i];
        const ChartPoint& b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const double ea = excess(a);
        const double eb = excess(b);
        if (ea <= 0) spare.push_back(a);
        if ((ea < 0 && eb > 0) || (ea > 0 && eb < 0))
        {
            const double t = ea / (ea - eb);
            spare.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
        }
    }
    polygon.swap(spare);
}

[[noreturn]] void refuse_endless(const Vec3& p)
{
    throw GeometryError(fmt::format(
        "the surface has no room for all particles near ({:.6g}, {:.6g}, {:.6g}); expected no "
        "facets there that are far thinner than their distance from the origin",
        p.x, p.y, p.z));
}

} // namespace

std::vector<FeatureSite> make_feature_sites(const SurfaceMesh& mesh, const WorkMesh& work,
                                            const std::vector<FeatureParticle>& particles,
                                            int threads)
{
    std::vector<FeatureSite> sites(particles.size());
    parallel_for(
        particles.size(), threads,
        [&](std::size_t p)
        {
            sites[p].position = particles[p].position;
            if (particles[p].vertex != no_index) return;
            for (const std::uint32_t facet : mesh.edge_facets[particles[p].edge])
                if (facet != no_index)
                    sites[p].facets.push_back(work.locate(facet, particles[p].position));
        },
        64);
    std::vector<std::uint32_t> site_of_vertex(mesh.vertices.size(), no_index);
    for (std::uint32_t p = 0; p < particles.size(); ++p)
        if (particles[p].vertex != no_index) site_of_vertex[particles[p].vertex] = p;
    for (std::uint32_t f = 0; f < work.facets.size(); ++f)
        for (const std::uint32_t v : work.facets[f].vertices)
            if (v < mesh.vertices.size() && site_of_vertex[v] != no_index)
                sites[site_of_vertex[v]].facets.push_back(f);
    for (FeatureSite& site : sites)
    {
        for (const std::uint32_t f : site.facets) site.normal = site.normal + work.facets[f].normal;
        if (!site.facets.empty())
            site.normal = site.normal / static_cast<double>(site.facets.size());
    }
    return sites;
}

void FillState::share_out_features()
{
    for (std::uint32_t s = 0; s < features.size(); ++s)
        for (const std::uint32_t chart : charts.near_point(features[s].position))
            if (charts.is_near(chart, features[s].position)) particles[chart].features.push_back(s);
}

/// Room is left for the particles that fill holes.
static void keep_no_spare_memory(std::vector<SurfaceSite>& sites)
{
    std::vector<SurfaceSite> kept;
    kept.reserve(sites.size() + sites.size() / 32);
    kept.insert(kept.end(), sites.begin(), sites.end());
    sites = std::move(kept);
}

struct ChartFiller::Work
{
    explicit Work(FillState& shared) : state(shared), mesh(shared.mesh), dp(shared.dp) {}

    FillState& state;
    const WorkMesh& mesh;
    double dp;
    std::uint32_t chart = 0;
    ChartParticles* own = nullptr;
    ChartGrid grid;
    std::vector<Vec3> normals;                    ///< of all in the grid
    std::vector<std::array<float, 3>> directions; ///< of the front, per site
    NearPoints near;
    mutable NearPoints looked_at;
    std::vector<ChartPoint> polygon, spare;
    std::priority_queue<ChartHole> holes;
    std::uint32_t order = 0;
    double most_sites = 0;

    void start(std::uint32_t which)
    {
        chart = which;
        own = &state.particles[which];
        most_sites = count_most_sites();
        grid.start(dp, mesh.facets[state.charts.facets(which)[0]].corners[0]);
        normals.clear();
        directions.clear();
        for (const std::uint32_t f : own->features)
            note(state.features[f].position, state.features[f].normal);
    }

    void note(const Vec3& position, const Vec3& normal)
    {
        grid.add(position);
        normals.push_back(normal);
    }

    void note_neighbour_charts()
    {
        for (const std::uint32_t other : state.charts.near_charts(chart))
            for (const SurfaceSite& site : state.particles[other].sites)
                if (site.is_at_seam && state.charts.is_near(chart, site.position))
                    note(site.position, mesh.facets[site.facet].normal);
    }

    /// Whether a particle of the grid is no neighbour of a place.
    ///
    /// offset  from the place, dp
    bool is_elsewhere(const Vec3& normal, std::uint32_t index, const Vec3& offset) const
    {
        return is_other_sheet(normal, normals[index]) &&
               !is_close_across(normal, offset, index < own->features.size());
    }
    bool is_elsewhere_at(const Vec3& normal, std::size_t at, const Vec3& shift) const
    {
        return is_elsewhere(normal, near.index[at], near.offset(at) - shift);
    }

    /// Squared distance (dp) to the nearest particle of the same sheet among those found, from a
    /// place `shift` (dp) away from where they were looked for.
    float nearest_squared(const Vec3& shift, const Vec3& normal) const
    {
        const NearestPoint nearest = nearest_to(near, shift);
        if (near.count == 0 || !is_elsewhere_at(normal, nearest.at, shift)) return nearest.squared;
        float best = far_away_dp;
        for (std::size_t n = 0; n < near.count; ++n)
        {
            const Vec3 d = near.offset(n) - shift;
            const auto squared = static_cast<float>(dot(d, d));
            if (squared < best && !is_elsewhere_at(normal, n, shift)) best = squared;
        }
        return best;
    }

    void place(const SurfaceRay& ray, bool is_irregular, bool is_at_seam)
    {
        if (static_cast<double>(own->sites.size()) > most_sites) refuse_endless(ray.position);
        const Vec3& d = ray.direction;
        own->sites.push_back({ray.position, ray.facet, is_irregular, is_at_seam});
        directions.push_back(
            {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)});
        note(ray.position, mesh.facets[ray.facet].normal);
    }

    /// Far more than there is room for on the area of the chart, along the sides of its facets and
    /// for one a facet.
    double count_most_sites() const
    {
        const std::span<const std::uint32_t> facets = state.charts.facets(chart);
        double area = 0, sides = 0;
        for (const std::uint32_t f : facets)
        {
            area += mesh.area(f);
            const auto& c = mesh.facets[f].corners;
            sides += norm(c[1] - c[0]) + norm(c[2] - c[1]) + norm(c[0] - c[2]);
        }
        return 4 * (area / (dp * dp) + sides / dp + static_cast<double>(facets.size())) + 100;
    }

    bool is_seam(const Vec3& position) const
    {
        return state.charts.near_point(position).size() > 1;
    }

    void try_to_begin(const SurfaceRay& ray)
    {
        if (ray.facet == no_index || state.charts.of_facet(ray.facet) != chart) return;
        grid.find_near(ray.position, least_distance, near);
        if (nearest_squared({}, mesh.facets[ray.facet].normal) < square(least_distance)) return;
        place(ray, false, is_seam(ray.position));
    }

    /// Puts particles where the hexagon around one wants them and nobody is.
    void advance_from(std::size_t index)
    {
        const SurfaceSite site = own->sites[index];
        const Vec3 normal = mesh.facets[site.facet].normal;
        Vec3 direction{directions[index][0], directions[index][1], directions[index][2]};
        direction = direction - normal * dot(direction, normal);
        direction = direction / norm(direction);
        const Vec3 left = cross(normal, direction);
        grid.find_near(site.position, front_spacing + least_distance, near);
        const NearestPoints guesses = nearest_to_each(
            near, turned_by_sixths(front_spacing * direction.x, front_spacing * left.x),
            turned_by_sixths(front_spacing * direction.y, front_spacing * left.y),
            turned_by_sixths(front_spacing * direction.z, front_spacing * left.z));
        bool is_irregular = false;
        for (std::size_t k = 0; k < 6; ++k)
        {
            const bool is_taken = guesses.squared[k] < square(clearly_taken) &&
                                  !is_other_sheet(normal, normals[near.index[guesses.at[k]]]);
            const bool is_there =
                is_taken ? guesses.squared[k] < square(same_site)
                         : advance_to({site.position, site.facet,
                                       direction * sixth_cosines[k] + left * sixth_sines[k]});
            is_irregular |= !is_there;
        }
        own->sites[index].is_irregular = is_irregular;
    }

    /// Returns whether there is now a particle where the hexagon wants one.
    bool advance_to(const SurfaceRay& from)
    {
        const SurfaceRay to = walk(mesh, from, front_spacing * dp);
        if (to.facet == no_index) return false;
        const Vec3 shift = (to.position - from.position) / dp;
        const float squared = nearest_squared(shift, mesh.facets[to.facet].normal);
        if (squared < square(least_distance)) return squared < square(same_site);
        if (state.charts.of_facet(to.facet) != chart)
        {
            own->leaving.push_back(to);
            return false;
        }
        near.push_back(shift, grid.size());
        place(to, false, is_seam(to.position));
        return true;
    }

    // Holes ------------------------------------------------------------------------------------

    /// Proposes the corners of the Voronoi cell of a particle that are too far from it. The cell
    /// is taken in the plane of a facet: exact where the surface is flat, too wide where it bends.
    void propose_around(const Vec3& position, std::uint32_t facet)
    {
        const Vec3& normal = mesh.facets[facet].normal;
        const Vec3 x_axis = any_direction(mesh.facets[facet]);
        const Vec3 y_axis = cross(normal, x_axis);
        // In dp around the particle.
        grid.find_near(position, neighbour_reach, near);
        constexpr double box = 1.3;
        const double limit = state.hole_radius * state.hole_radius;
        polygon.assign({{-box, -box}, {box, -box}, {box, box}, {-box, box}});
        const auto is_far = [&](const ChartPoint& p) { return p.x * p.x + p.y * p.y > limit; };
        // The nearest first, after which there is mostly nothing left to cut.
        for (const bool is_close : {true, false})
        {
            for (std::size_t n = 0; n < near.count; ++n)
            {
                const Vec3 offset = near.offset(n);
                const double squared = dot(offset, offset);
                if ((squared < 1.7) != is_close || squared < 1e-9 || is_elsewhere_at(normal, n, {}))
                    continue;
                const ChartPoint q{dot(offset, x_axis), dot(offset, y_axis)};
                if (q.x * q.x + q.y * q.y < 0.04 * squared) continue;
                clip(polygon, q, squared, spare);
            }
            if (std::none_of(polygon.begin(), polygon.end(), is_far)) return;
        }
        for (const ChartPoint& p : polygon)
        {
            if (!is_far(p)) continue;
            const double length = std::sqrt(p.x * p.x + p.y * p.y);
            const Vec3 direction = (x_axis * p.x + y_axis * p.y) / length;
            // The plane only guesses where surface or neighbours bend away from it.
            climb(walk(mesh, {position, facet, direction}, length * dp));
        }
    }

    /// A point that may be a hole of this chart joins the queue if it is one.
    void propose(const SurfaceRay& place_of)
    {
        if (place_of.facet == no_index || state.charts.of_facet(place_of.facet) != chart) return;
        if (state.may_fill &&
            !state.may_fill(place_of.position, mesh.facets[place_of.facet].normal))
            return;
        const double distance = own_sheet_distance(place_of);
        if (distance > state.hole_radius * dp) holes.push({distance, order++, place_of});
    }

    /// Crumbs have no sheets: one particle stands for all their sides.
    double own_sheet_distance(const SurfaceRay& at) const
    {
        const Vec3& normal = mesh.facets[at.facet].normal;
        const bool has_sheets = !state.charts.is_crumbs(chart);
        double best = neighbour_reach * neighbour_reach * dp * dp;
        grid.for_each_near(
            at.position, neighbour_reach, looked_at,
            [&](std::uint32_t index, const Vec3& offset, double squared)
            {
                if (squared < best && !(has_sheets && is_elsewhere(normal, index, offset / dp)))
                    best = squared;
            });
        return std::sqrt(best);
    }

    /// Samples one point in a few dp squared of the chart, for what no particle is next to.
    void propose_samples()
    {
        constexpr double area_of_sample = 4; // dp squared
        double due = 0;
        std::uint32_t count = 0;
        for (const std::uint32_t f : state.charts.facets(chart))
        {
            // A crumb has a particle of its own if none is near.
            if (state.charts.is_crumbs(chart))
            {
                const auto& c = mesh.facets[f].corners;
                const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
                const Vec3 direction = any_direction(mesh.facets[f]);
                propose({middle, f, direction});
                for (const Vec3& corner : c)
                    propose({middle + (corner - middle) * 0.98, f, direction});
                continue;
            }
            due += mesh.area(f) / (area_of_sample * dp * dp);
            for (; due >= 1 || count == 0; due -= 1)
            {
                ++count;
                const Vec3 point = even_on_facet(mesh.facets[f].corners, count, 0.5);
                if (is_alone(point, mesh.facets[f].normal))
                    climb({point, f, any_direction(mesh.facets[f])});
            }
        }
    }

    /// Whether no particle is so near that there is no hole to climb to from here.
    bool is_alone(const Vec3& point, const Vec3& normal) const
    {
        bool result = true;
        grid.for_each_near(point, 0.7, looked_at,
                           [&](std::uint32_t index, const Vec3& offset, double)
                           { result = result && is_elsewhere(normal, index, offset / dp); });
        return result;
    }

    /// Walks away from the nearest particle, step by smaller step, until the place is a hole.
    void climb(SurfaceRay at)
    {
        double step = 0.2 * dp;
        for (int i = 0; i < 8 && at.facet != no_index; ++i, step *= 0.8)
        {
            const Vec3& normal = mesh.facets[at.facet].normal;
            double best = neighbour_reach * neighbour_reach * dp * dp;
            Vec3 towards{};
            grid.for_each_near(at.position, neighbour_reach, looked_at,
                               [&](std::uint32_t index, const Vec3& offset, double squared)
                               {
                                   if (squared >= best || is_elsewhere(normal, index, offset / dp))
                                       return;
                                   best = squared;
                                   towards = offset;
                               });
            if (best > state.hole_radius * state.hole_radius * dp * dp) return propose(at);
            const Vec3 away = normal * dot(towards, normal) - towards;
            const double length = norm(away);
            if (length < 1e-6 * dp) return;
            at = walk(mesh, {at.position, at.facet, away / length}, step);
        }
    }

    void propose_all()
    {
        for (const std::uint32_t f : own->features)
            for (const std::uint32_t facet : state.features[f].facets)
                if (state.charts.of_facet(facet) == chart)
                    propose_around(state.features[f].position, facet);
        for (const SurfaceSite& site : own->sites)
            if (site.is_irregular) propose_around(site.position, site.facet);
        for (const std::uint32_t other : state.charts.near_charts(chart))
            for (const SurfaceSite& site : state.particles[other].sites)
                if (site.is_at_seam && site.is_irregular &&
                    state.charts.is_near(chart, site.position))
                    propose_around(site.position, site.facet);
        propose_samples();
    }

    void fill_queue()
    {
        while (!holes.empty())
        {
            ChartHole hole = holes.top();
            holes.pop();
            const double distance = own_sheet_distance(hole.place);
            if (distance <= state.hole_radius * dp) continue;
            if (distance < hole.distance)
            {
                hole.distance = distance;
                holes.push(hole);
                continue;
            }
            place(hole.place, true, is_seam(hole.place.position));
            propose_around(hole.place.position, hole.place.facet);
        }
    }
};

ChartFiller::ChartFiller(FillState& state) : work_(std::make_unique<Work>(state)) {}
ChartFiller::~ChartFiller() = default;
ChartFiller::ChartFiller(ChartFiller&&) noexcept = default;
ChartFiller& ChartFiller::operator=(ChartFiller&&) noexcept = default;

void ChartFiller::advance_front(std::uint32_t chart)
{
    Work& w = *work_;
    if (w.state.charts.is_crumbs(chart)) return; // too small for a front
    w.start(chart);
    w.note_neighbour_charts();
    for (const SurfaceRay& ray : w.own->rows) w.try_to_begin(ray);
    for (const std::uint32_t other : w.state.charts.near_charts(chart))
        for (const SurfaceRay& ray : w.state.particles[other].leaving) w.try_to_begin(ray);
    if (w.own->sites.empty())
    {
        const std::uint32_t facet = w.state.charts.facets(chart)[0];
        const WorkFacet& f = w.mesh.facets[facet];
        w.try_to_begin(
            {(f.corners[0] + f.corners[1] + f.corners[2]) / 3.0, facet, any_direction(f)});
    }
    for (std::size_t i = 0; i < w.own->sites.size(); ++i) w.advance_from(i);
    w.own->rows = {};
    keep_no_spare_memory(w.own->sites);
}

void ChartFiller::fill_holes(std::uint32_t chart)
{
    Work& w = *work_;
    w.start(chart);
    for (const SurfaceSite& site : w.own->sites)
        w.note(site.position, w.mesh.facets[site.facet].normal);
    w.note_neighbour_charts();
    w.order = 0;
    w.propose_all();
    w.fill_queue();
}

} // namespace fppg
