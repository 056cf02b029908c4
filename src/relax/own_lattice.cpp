#include "relax/own_lattice.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// So much of the surface goes along the axes of an own lattice, ...
constexpr double least_share = 0.5;
/// ... within a degree.
constexpr double along = 0.99985;
constexpr double square = 0.0175;
constexpr std::size_t most_directions = 64;
constexpr double most_nodes = 2e6;
/// A box with more places for each particle of its body is too empty to be searched.
constexpr double most_places = 100;
/// Places nearer to the layers than the first are left out, farther than the second all are alike,
/// dp.
constexpr double nearest_place_dp = 0.6;
constexpr double far_place_dp = 1.5;
/// Layers are half a step deep; what stands in their gaps would be pressed out of them.
constexpr double least_depth_dp = 0.9;

/// A direction of faces; opposite ones are one.
struct Direction
{
    Vec3 sum; ///< of the normals times areas
    double area = 0;
};

/// Directions of faces by area, largest first.
std::vector<Direction> directions_of(const SurfaceMesh& mesh, bool is_2d, double& all)
{
    struct Face
    {
        Vec3 normal;
        double area = 0;
    };
    std::vector<Face> faces;
    all = 0;
    for (const auto& f : mesh.facets)
    {
        const Vec3 twice = cross(mesh.vertices[f[1]] - mesh.vertices[f[0]],
                                 mesh.vertices[f[2]] - mesh.vertices[f[0]]);
        const double size = norm(twice);
        if (!(size > 0) || (is_2d && std::abs(twice.y) > 0.5 * size)) continue;
        faces.push_back({twice / size, 0.5 * size});
        all += 0.5 * size;
    }
    std::stable_sort(faces.begin(), faces.end(),
                     [](const Face& a, const Face& b) { return a.area > b.area; });
    std::vector<Direction> out;
    for (const Face& face : faces)
    {
        const auto same =
            std::find_if(out.begin(), out.end(),
                         [&](const Direction& d)
                         { return std::abs(dot(d.sum, face.normal)) > along * norm(d.sum); });
        if (same == out.end())
        {
            if (out.size() < most_directions) out.push_back({face.area * face.normal, face.area});
            continue;
        }
        const double sign = dot(same->sum, face.normal) < 0 ? -1 : 1;
        same->sum = same->sum + (sign * face.area) * face.normal;
        same->area += face.area;
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Direction& a, const Direction& b) { return a.area > b.area; });
    return out;
}

/// Three axes at right angles along which most of the surface goes.
std::optional<std::array<Vec3, 3>> axes_of(const SurfaceMesh& mesh, bool is_2d)
{
    double all = 0;
    const std::vector<Direction> found = directions_of(mesh, is_2d, all);
    if (found.empty()) return std::nullopt;
    Vec3 first = found[0].sum;
    if (is_2d) first.y = 0; // all places stay in the plane to the last bit
    first = first / norm(first);
    Vec3 second{0, 1, 0};
    if (!is_2d)
    {
        const auto next = std::find_if(
            found.begin(), found.end(),
            [&](const Direction& d) { return std::abs(dot(d.sum, first)) < square * norm(d.sum); });
        // Of a disc all directions in its plane are alike.
        second = next != found.end()         ? next->sum
                 : std::abs(first.x) < 0.577 ? Vec3{1, 0, 0}
                 : std::abs(first.y) < 0.577 ? Vec3{0, 1, 0}
                                             : Vec3{0, 0, 1};
        second = second - dot(second, first) * first;
        second = second / norm(second);
    }
    const std::array<Vec3, 3> axes{first, second, cross(first, second)};
    double share = 0;
    for (const Direction& d : found)
        for (const Vec3& axis : axes)
            if (std::abs(dot(d.sum, axis)) > along * norm(d.sum)) share += d.area;
    if (share < least_share * all) return std::nullopt;
    return axes;
}

/// A place of a lattice that may be taken.
struct Place
{
    double distance = 0; ///< to the nearest particle of a layer, dp
    std::uint32_t hash = 0;
    std::size_t index = 0;
    Vec3 at;
};

/// Lattice places inside a body with their distance from its layers.
std::vector<Place> places_inside(const OwnLattice& lattice, std::size_t body, const AllWalls& all,
                                 const PointGrid& layers, double dp, int threads)
{
    const std::array<std::size_t, 3>& n = lattice.counts;
    std::vector<std::vector<Place>> rows(n[0] * n[1]);
    parallel_for(
        rows.size(), threads,
        [&](std::size_t row)
        {
            const std::size_t i = row / n[1];
            const std::size_t j = row % n[1];
            for (std::size_t k = 0; k < n[2]; ++k)
            {
                Place place;
                place.index = row * n[2] + k;
                place.at = lattice.corner +
                           (static_cast<double>(i) * lattice.steps[0]) * lattice.axes[0] +
                           (static_cast<double>(j) * lattice.steps[1]) * lattice.axes[1] +
                           (static_cast<double>(k) * lattice.steps[2]) * lattice.axes[2];
                const AllWalls::Closest near = all.closest(place.at);
                if (near.is_outside || near.body != body || near.distance < least_depth_dp * dp)
                    continue;
                const double reach = far_place_dp * dp;
                double squared = reach * reach;
                layers.for_each_near(place.at, reach,
                                     [&](std::uint32_t, double s)
                                     { squared = std::min(squared, s); });
                place.distance = std::sqrt(squared) / dp;
                place.hash = static_cast<std::uint32_t>(2654435761U * place.index);
                if (place.distance >= nearest_place_dp) rows[row].push_back(place);
            }
        });
    std::vector<Place> out;
    for (const auto& row : rows) out.insert(out.end(), row.begin(), row.end());
    return out;
}

/// Between the outermost places of the body along each axis stands a whole number.
std::optional<OwnLattice> own_lattice(const FittedBody& body, const LatticeGrid& grid)
{
    const double per_particle = grid.is_2d ? grid.dp * grid.dp : grid.dp * grid.dp * grid.dp;
    const std::optional<std::array<Vec3, 3>> axes = axes_of(body.mesh, grid.is_2d);
    if (!axes) return std::nullopt;
    OwnLattice out;
    out.axes = *axes;
    out.dp = grid.dp;
    std::array<double, 3> low{}, extent{};
    for (std::size_t a = 0; a < 3; ++a)
    {
        double high = -std::numeric_limits<double>::infinity();
        low[a] = -high;
        for (const Vec3& v : body.mesh.vertices)
        {
            low[a] = std::min(low[a], dot(v, out.axes[a]));
            high = std::max(high, dot(v, out.axes[a]));
        }
        extent[a] = high - low[a];
    }
    std::array<std::size_t, 3> order{0, 1, 2};
    if (grid.is_2d) order = {1, 0, 2};
    std::stable_sort(order.begin() + (grid.is_2d ? 1 : 0), order.end(),
                     [&](std::size_t a, std::size_t b) { return extent[a] < extent[b]; });
    // What the fewest particles stand in between gets a whole number first; the others make up.
    double left = per_particle;
    int axes_left = grid.is_2d ? 2 : 3;
    for (const std::size_t a : order)
    {
        if (grid.is_2d && a == 1)
        {
            out.steps[a] = grid.dp;
            out.counts[a] = 1;
            out.corner = out.corner + grid.origin.y * out.axes[a];
            continue;
        }
        const double step = std::pow(left, 1.0 / axes_left--);
        out.counts[a] = static_cast<std::size_t>(std::max(1.0, std::round(extent[a] / step)));
        out.steps[a] = extent[a] / static_cast<double>(out.counts[a]);
        left /= out.steps[a];
        out.corner = out.corner + (low[a] + 0.5 * out.steps[a]) * out.axes[a];
    }
    const double places = static_cast<double>(out.counts[0]) * static_cast<double>(out.counts[1]) *
                          static_cast<double>(out.counts[2]);
    if (places * per_particle * (grid.is_2d ? grid.dp : 1) > most_places * body.measures.volume)
        return std::nullopt;
    return out;
}

/// Moves the nodes of one body, `movers`.
void move_body(const FittedWalls& walls, const std::pair<std::size_t, OwnLattice>& of_body,
               const AllWalls& all, std::span<const std::uint32_t> movers,
               std::vector<Vec3>& positions, int threads)
{
    const auto& [body, lattice] = of_body;
    const double dp = lattice.dp;
    PointGrid layers(far_place_dp * dp, walls.particles.size());
    for (std::size_t i = 0; i < walls.particles.size(); ++i)
    {
        const FittedBody& of = walls.bodies[walls.particles.bodies[i]];
        if (of.is_layer() && of.owner == body) layers.add(walls.particles.positions[i]);
    }
    std::vector<Place> places = places_inside(lattice, body, all, layers, dp, threads);
    const std::size_t taken = std::min(places.size(), movers.size());
    if (taken < movers.size()) return;
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(taken),
                     places.end(),
                     [](const Place& a, const Place& b) {
                         return std::tuple(-a.distance, a.hash, a.index) <
                                std::tuple(-b.distance, b.hash, b.index);
                     });
    places.resize(taken);
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.index < b.index; });
    for (std::size_t i = 0; i < taken; ++i) positions[movers[i]] = places[i].at;
}

} // namespace

std::vector<std::optional<OwnLattice>> own_lattices(const FittedWalls& walls,
                                                    const LatticeGrid& grid)
{
    std::vector<char> is_cut(walls.bodies.size(), 0);
    for (const std::uint32_t b : walls.cut_bodies)
        is_cut[walls.bodies[b].is_layer() ? walls.bodies[b].owner : b] = 1;
    std::vector<std::optional<OwnLattice>> out(walls.bodies.size());
    for (std::size_t b = 0; b < out.size(); ++b)
    {
        const FittedBody& body = walls.bodies[b];
        if (body.is_inside && !body.is_layer() && body.sheets == 0 && body.facet_mk.empty() &&
            is_cut[b] == 0 && body.measures.node_volume < most_nodes * std::pow(grid.dp, 3))
            out[b] = own_lattice(body, grid);
    }
    return out;
}

bool has_own_lattice(const FittedWalls& walls,
                     const std::vector<std::optional<OwnLattice>>& lattices, std::uint16_t mk)
{
    for (std::size_t b = 0; b < lattices.size(); ++b)
        if (lattices[b] && walls.bodies[b].mk == mk) return true;
    return false;
}

void move_to_own_lattices(const FittedWalls& walls,
                          const std::vector<std::optional<OwnLattice>>& lattices,
                          const AllWalls& all, const std::vector<Mover>& movers,
                          std::vector<Vec3>& positions, int threads)
{
    std::map<std::size_t, std::vector<std::uint32_t>> of_body;
    for (std::uint32_t m = 0; m < movers.size(); ++m)
    {
        const std::size_t body = all.closest(positions[m]).body;
        if (lattices[body] && walls.bodies[body].mk == movers[m].mk) of_body[body].push_back(m);
    }
    for (const auto& [body, moving] : of_body)
        move_body(walls, {body, *lattices[body]}, all, moving, positions, threads);
}

} // namespace fppg
