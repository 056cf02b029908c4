#include "fppg/surface_mesh.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "core/parallel_sort.h"
#include "core/predicates.h"
#include "fppg/error.h"
#include "shapes/box_tree.h"
#include "shapes/connect_mesh.h"
#include "shapes/facet_pairs.h"
#include "shapes/mesh_query.h"

namespace fppg
{

namespace
{

using Facet = std::array<std::uint32_t, 3>;

/// What float32 may have rounded away of a coordinate, with room for two roundings.
constexpr double float_step = 1.0 / (1 << 22);

double largest_coordinate(const Vec3& p)
{
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// "near (x, y, z)"
std::string near(const Vec3& p)
{
    return fmt::format("near ({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

std::string counted(std::size_t n, const char* one, const char* many)
{
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

bool is_before(const Vec3& a, const Vec3& b)
{
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Gives corners with equal coordinates one index. Zero and minus zero are equal.
void weld_equal(const TriangleSoup& soup, int threads, SurfaceMesh& mesh)
{
    const std::size_t n = soup.vertices.size();
    std::vector<std::uint32_t> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = static_cast<std::uint32_t>(i);
    const std::vector<Vec3>& p = soup.vertices;
    parallel_sort(order, threads,
                  [&p](std::uint32_t a, std::uint32_t b)
                  {
                      if (is_before(p[a], p[b])) return true;
                      if (is_before(p[b], p[a])) return false;
                      return a < b;
                  });
    // The first corner of each place stands for it; places are numbered in the order of the file.
    std::vector<std::uint32_t> first(n);
    for (std::size_t i = 0; i < n; ++i)
        first[order[i]] =
            i > 0 && !is_before(p[order[i - 1]], p[order[i]]) ? first[order[i - 1]] : order[i];
    std::vector<std::uint32_t>& index = order;
    for (std::size_t i = 0; i < n; ++i)
    {
        if (first[i] == i)
        {
            index[i] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back({p[i].x + 0.0, p[i].y + 0.0, p[i].z + 0.0});
        }
        else
            index[i] = index[first[i]];
    }
    mesh.facets.resize(soup.size());
    for (std::size_t i = 0; i < n; ++i) mesh.facets[i / 3][i % 3] = index[i];
}

/// Moves every vertex onto the nearest earlier one that stands for a place within the distance.
/// Places do not grow from neighbour to neighbour, so a fine mesh cannot run together.
void weld_near(double distance, SurfaceMesh& mesh)
{
    const auto cell_of = [&](const Vec3& p, int axis)
    { return static_cast<std::int64_t>(std::floor(std::clamp(p[axis] / distance, -9e18, 9e18))); };
    const auto key_of = [](std::int64_t i, std::int64_t j, std::int64_t k)
    {
        return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15 ^
               static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4F ^
               static_cast<std::uint64_t>(k) * 0x165667B19E3779F9;
    };
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> places;
    std::vector<std::uint32_t> index(mesh.vertices.size());
    std::vector<Vec3> kept;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    {
        const Vec3& p = mesh.vertices[v];
        const std::int64_t i = cell_of(p, 0), j = cell_of(p, 1), k = cell_of(p, 2);
        std::uint32_t best = no_index;
        double best_distance = distance;
        for (std::int64_t cell = 0; cell < 27; ++cell)
        {
            const auto found =
                places.find(key_of(i + cell % 3 - 1, j + cell / 3 % 3 - 1, k + cell / 9 - 1));
            if (found == places.end()) continue;
            for (const std::uint32_t other : found->second)
            {
                const double d = norm(kept[other] - p);
                if (d < best_distance || (d == best_distance && other < best))
                {
                    best = other;
                    best_distance = d;
                }
            }
        }
        if (best == no_index)
        {
            best = static_cast<std::uint32_t>(kept.size());
            places[key_of(i, j, k)].push_back(best);
            kept.push_back(p);
        }
        index[v] = best;
    }
    mesh.vertices = std::move(kept);
    for (Facet& facet : mesh.facets)
        for (std::uint32_t& corner : facet) corner = index[corner];
}

struct Measures
{
    Vec3 normal;       ///< of unit length
    double area = 0;   ///< metres squared
    double height = 0; ///< over the longest side, metres
    int longest = 0;   ///< the longest side
};

Measures measure(const SurfaceMesh& mesh, const Facet& f)
{
    Measures m;
    const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
    const std::array<double, 3> sides{norm(b - a), norm(c - b), norm(a - c)};
    m.longest = static_cast<int>(std::max_element(sides.begin(), sides.end()) - sides.begin());
    const double longest = sides[static_cast<std::size_t>(m.longest)];
    if (!(longest > 0)) return m;
    // Divided first, so that neither tiny nor huge facets leave the range of double.
    const Vec3 n = cross((b - a) / longest, (c - a) / longest);
    const double length = norm(n);
    m.area = 0.5 * length * longest * longest;
    m.height = length * longest;
    if (length > 0) m.normal = n / length;
    return m;
}

void drop_degenerate(SurfaceMesh& mesh, MeshReport& report)
{
    const std::size_t before = mesh.facets.size();
    std::erase_if(mesh.facets,
                  [&](const Facet& f)
                  {
                      if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) return true;
                      const Measures m = measure(mesh, f);
                      const auto s = static_cast<std::size_t>(m.longest);
                      const double longest =
                          norm(mesh.vertices[f[(s + 1) % 3]] - mesh.vertices[f[s]]);
                      return !(m.height > 1e-12 * longest);
                  });
    report.degenerate_facets += before - mesh.facets.size();
}

/// Which of the two ways around its corners a facet runs.
bool parity(const Facet& f)
{
    const auto least = static_cast<std::size_t>(std::min_element(f.begin(), f.end()) - f.begin());
    return f[(least + 1) % 3] < f[(least + 2) % 3];
}

Facet sorted(Facet f)
{
    std::sort(f.begin(), f.end());
    return f;
}

/// Groups of facets with the same corners, each in the order of the file.
std::vector<std::vector<std::uint32_t>> find_copies(const std::vector<Facet>& facets, int threads)
{
    struct Key
    {
        Facet corners;
        std::uint32_t facet;
    };
    std::vector<Key> keys(facets.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        keys[i] = {sorted(facets[i]), static_cast<std::uint32_t>(i)};
    parallel_sort(keys, threads,
                  [](const Key& a, const Key& b)
                  { return a.corners != b.corners ? a.corners < b.corners : a.facet < b.facet; });
    std::vector<std::vector<std::uint32_t>> groups;
    for (std::size_t i = 0; i < keys.size();)
    {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].corners == keys[i].corners) ++end;
        if (end > i + 1)
        {
            groups.emplace_back();
            for (; i < end; ++i) groups.back().push_back(keys[i].facet);
        }
        i = end;
    }
    return groups;
}

void erase_facets(const std::vector<char>& is_dropped, SurfaceMesh& mesh)
{
    std::size_t kept = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_dropped[f] == 0) mesh.facets[kept++] = mesh.facets[f];
    mesh.facets.resize(kept);
}

void build_edges(SurfaceMesh& mesh, int threads)
{
    struct Side
    {
        std::uint64_t edge; ///< smaller vertex, then larger one
        std::uint32_t side; ///< 3 * facet + side
    };
    const std::size_t n = mesh.facets.size();
    std::vector<Side> sides(3 * n);
    parallel_for(
        n, threads,
        [&](std::size_t f)
        {
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint64_t a = mesh.facets[f][s], b = mesh.facets[f][(s + 1) % 3];
                sides[3 * f + s] = {std::min(a, b) << 32 | std::max(a, b),
                                    static_cast<std::uint32_t>(3 * f + s)};
            }
        },
        4096);
    parallel_sort(sides, threads,
                  [](const Side& a, const Side& b)
                  { return a.edge != b.edge ? a.edge < b.edge : a.side < b.side; });

    mesh.edges.clear();
    mesh.edge_facets.clear();
    mesh.is_manifold.clear();
    mesh.neighbours.assign(n, {no_index, no_index, no_index});
    mesh.facet_edges.assign(n, {no_index, no_index, no_index});
    for (std::size_t i = 0; i < sides.size();)
    {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
        const auto edge = static_cast<std::uint32_t>(mesh.edges.size());
        const std::uint32_t first = sides[i].side;
        const std::uint32_t second = end > i + 1 ? sides[i + 1].side : no_index;
        mesh.edges.push_back({static_cast<std::uint32_t>(sides[i].edge >> 32),
                              static_cast<std::uint32_t>(sides[i].edge)});
        mesh.edge_facets.push_back({first / 3, second == no_index ? no_index : second / 3});
        mesh.is_manifold.push_back(end - i <= 2 ? 1 : 0);
        if (end - i == 2)
        {
            mesh.neighbours[first / 3][first % 3] = second / 3;
            mesh.neighbours[second / 3][second % 3] = first / 3;
        }
        for (; i < end; ++i) mesh.facet_edges[sides[i].side / 3][sides[i].side % 3] = edge;
    }
}

bool is_open(const SurfaceMesh& mesh, std::size_t edge)
{
    return mesh.edge_facets[edge][1] == no_index;
}

/// Whether the facet's side s runs from the smaller vertex to the larger one.
bool runs_upwards(const SurfaceMesh& mesh, std::size_t f, std::size_t s)
{
    return mesh.facets[f][s] < mesh.facets[f][(s + 1) % 3];
}

/// Whether facets with the same corners are possible: they make an edge of more than two facets,
/// or are each other's only neighbours.
bool may_have_copies(const SurfaceMesh& mesh)
{
    if (std::find(mesh.is_manifold.begin(), mesh.is_manifold.end(), 0) != mesh.is_manifold.end())
        return true;
    return std::any_of(mesh.neighbours.begin(), mesh.neighbours.end(),
                       [](const Facet& n)
                       { return n[0] != no_index && n[0] == n[1] && n[1] == n[2]; });
}

/// Drops from `is_twin`, the facets that stand for two with opposite faces, those that are no wall
/// between two bodies: a wall has two more facets at each edge of its rim, and each of its faces
/// goes on in the one that lies behind it.
void keep_inner_walls(const SurfaceMesh& mesh, std::vector<char>& is_twin)
{
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> sides_at; // 3 * facet + side
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_twin[f] != 0)
            for (const std::uint32_t e : mesh.facet_edges[f]) sides_at[e];
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
            if (const auto at = sides_at.find(mesh.facet_edges[f][s]); at != sides_at.end())
                at->second.push_back(static_cast<std::uint32_t>(3 * f + s));

    const auto ends_well = [&](std::uint32_t f, std::size_t s)
    {
        const std::vector<std::uint32_t>& sides = sides_at.at(mesh.facet_edges[f][s]);
        if (sides.size() != 3) return false;
        const Vec3 normal = measure(mesh, mesh.facets[f]).normal;
        int way = 0;
        for (const std::uint32_t side : sides)
        {
            const std::uint32_t other = side / 3;
            if (other == f) continue;
            if (is_twin[other] != 0) return false;
            const bool goes_on = runs_upwards(mesh, other, side % 3) != runs_upwards(mesh, f, s);
            const Vec3 away = mesh.vertices[mesh.facets[other][(side % 3 + 2) % 3]] -
                              mesh.vertices[mesh.facets[f][s]];
            const double ahead = dot(normal, away);
            if (goes_on ? !(ahead < 0) : !(ahead > 0)) return false;
            way += goes_on ? 1 : -1;
        }
        return way == 0;
    };
    std::vector<char> is_seen(mesh.facets.size(), 0);
    std::vector<std::uint32_t> patch;
    for (std::size_t seed = 0; seed < mesh.facets.size(); ++seed)
    {
        if (is_twin[seed] == 0 || is_seen[seed] != 0) continue;
        patch.assign(1, static_cast<std::uint32_t>(seed));
        is_seen[seed] = 1;
        bool is_wall = true, has_rim = false;
        for (std::size_t next = 0; next < patch.size(); ++next)
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t f = patch[next], other = mesh.neighbours[f][s];
                if (other == no_index || is_twin[other] == 0)
                {
                    has_rim = true;
                    is_wall = is_wall && ends_well(f, s);
                    continue;
                }
                if (is_seen[other] == 0) patch.push_back(other);
                is_seen[other] = 1;
            }
        if (is_wall && has_rim) continue;
        for (const std::uint32_t f : patch) is_twin[f] = 0;
    }
}

/// Keeps one of all facets with the same corners, and none of two with opposite faces that are a
/// wall between two bodies.
void drop_copies(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    if (!may_have_copies(mesh)) return;
    const std::vector<std::vector<std::uint32_t>> groups = find_copies(mesh.facets, threads);
    if (groups.empty()) return;
    std::vector<char> is_dropped(mesh.facets.size(), 0);
    std::vector<char> is_twin(mesh.facets.size(), 0);
    for (const std::vector<std::uint32_t>& group : groups)
    {
        for (std::size_t i = 1; i < group.size(); ++i) is_dropped[group[i]] = 1;
        report.duplicate_facets += group.size() - 1;
        is_twin[group[0]] = static_cast<char>(
            group.size() == 2 && parity(mesh.facets[group[0]]) != parity(mesh.facets[group[1]]));
    }
    erase_facets(is_dropped, mesh);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < is_dropped.size(); ++f)
        if (is_dropped[f] == 0) is_twin[kept++] = is_twin[f];
    is_twin.resize(kept);
    build_edges(mesh, threads);
    keep_inner_walls(mesh, is_twin);
    const auto walls = static_cast<std::size_t>(std::count(is_twin.begin(), is_twin.end(), 1));
    if (walls == 0) return;
    report.duplicate_facets -= walls;
    report.inner_wall_facets += 2 * walls;
    erase_facets(is_twin, mesh);
    build_edges(mesh, threads);
}

/// Drops facets that are no higher than the rounding of their corners and have a side that is open
/// or belongs to more than two facets: slivers that stand on an edge. What they leave are
/// T-junctions. Slivers that fit between their neighbours stay.
void drop_loose_slivers(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    std::vector<char> is_dropped(mesh.facets.size(), 0);
    std::size_t dropped = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const Facet& corners = mesh.facets[f];
        if (std::none_of(mesh.neighbours[f].begin(), mesh.neighbours[f].end(),
                         [](std::uint32_t other) { return other == no_index; }))
            continue;
        const Measures m = measure(mesh, corners);
        const auto s = static_cast<std::size_t>(m.longest);
        const Vec3 &a = mesh.vertices[corners[s]], &b = mesh.vertices[corners[(s + 1) % 3]];
        const double size = std::max(largest_coordinate(a), largest_coordinate(b));
        if (m.height > std::min(float_step * size, 1e-3 * norm(b - a))) continue;
        is_dropped[f] = 1;
        ++dropped;
    }
    if (dropped == 0 || dropped == mesh.facets.size()) return;
    erase_facets(is_dropped, mesh);
    report.degenerate_facets += dropped;
    build_edges(mesh, threads);
}

std::size_t count_open(const SurfaceMesh& mesh)
{
    std::size_t count = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) count += is_open(mesh, e) ? 1 : 0;
    return count;
}

/// Joins the corners of a mesh whose facets do not meet: where a quarter of all edges are open, and
/// moving corners together by a small distance leaves a tenth of that open at most. The smallest of
/// three distances that does is taken, if it is below a tenth of the mean side.
void close_cracks(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::size_t open = count_open(mesh);
    if (4 * open <= mesh.edges.size()) return;
    Box3 bounds;
    for (const Vec3& p : mesh.vertices) bounds.add(p);
    const Vec3 size = bounds.max - bounds.min;
    double sides = 0;
    for (const auto& [a, b] : mesh.edges) sides += norm(mesh.vertices[b] - mesh.vertices[a]);
    for (const double share : {1e-6, 1e-5, 1e-4})
    {
        const double distance = share * std::max({size.x, size.y, size.z});
        if (!(distance < 0.1 * sides / static_cast<double>(mesh.edges.size()))) return;
        SurfaceMesh joined;
        joined.vertices = mesh.vertices;
        joined.facets = mesh.facets;
        weld_near(distance, joined);
        MeshReport dropped;
        drop_degenerate(joined, dropped);
        if (joined.facets.empty()) return;
        build_edges(joined, threads);
        if (10 * count_open(joined) > open) continue;
        report.joined_corners = mesh.vertices.size() - joined.vertices.size();
        report.degenerate_facets += dropped.degenerate_facets;
        report.joined_within = distance;
        mesh = std::move(joined);
        return;
    }
}

/// A vertex inside an open edge, at a share of the way from the edge's first vertex.
struct Junction
{
    std::uint32_t edge;
    std::uint32_t vertex;
    double share;
};

std::vector<Junction> find_t_junctions(const SurfaceMesh& mesh, int threads)
{
    std::vector<std::uint32_t> open;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        if (is_open(mesh, e)) open.push_back(static_cast<std::uint32_t>(e));
    if (open.empty()) return {};
    std::vector<Box3> boxes(open.size());
    std::vector<double> room(open.size());
    std::vector<std::uint32_t> ends;
    for (std::size_t i = 0; i < open.size(); ++i)
    {
        const Vec3 &a = mesh.vertices[mesh.edges[open[i]][0]],
                   &b = mesh.vertices[mesh.edges[open[i]][1]];
        room[i] = std::min(float_step * std::max(largest_coordinate(a), largest_coordinate(b)),
                           0.01 * norm(b - a));
        for (const Vec3& end : {a, b})
            for (const double sign : {-1.0, 1.0})
                boxes[i].add(end + sign * Vec3{room[i], room[i], room[i]});
        ends.insert(ends.end(), mesh.edges[open[i]].begin(), mesh.edges[open[i]].end());
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());

    const BoxTree tree(std::move(boxes), threads);
    std::vector<std::vector<Junction>> found(ends.size());
    parallel_for(
        ends.size(), threads,
        [&](std::size_t i)
        {
            const Vec3& p = mesh.vertices[ends[i]];
            Box3 at;
            at.add(p);
            tree.for_each_overlap(
                at,
                [&](std::uint32_t k)
                {
                    const auto [from, to] = mesh.edges[open[k]];
                    const Facet& own = mesh.facets[mesh.edge_facets[open[k]][0]];
                    if (std::find(own.begin(), own.end(), ends[i]) != own.end()) return;
                    const Vec3 along = mesh.vertices[to] - mesh.vertices[from];
                    const Vec3 away = p - mesh.vertices[from];
                    const double share = dot(away, along) / dot(along, along);
                    if (!(share > 0 && share < 1) || norm(away - share * along) > room[k]) return;
                    found[i].push_back({open[k], ends[i], share});
                });
        },
        1024);
    std::vector<Junction> all;
    for (const std::vector<Junction>& some : found) all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end(),
              [](const Junction& a, const Junction& b)
              {
                  if (a.edge != b.edge) return a.edge < b.edge;
                  return a.share != b.share ? a.share < b.share : a.vertex < b.vertex;
              });
    return all;
}

/// Splits the facets of open edges at the vertices inside them.
void split_at(const std::vector<Junction>& junctions, SurfaceMesh& mesh)
{
    /// A facet with the vertices that lie on each of its sides, in the sides' direction.
    struct Part
    {
        Facet corners;
        std::array<std::vector<std::uint32_t>, 3> on_side;
    };
    std::unordered_map<std::uint32_t, Part> parts;
    std::vector<std::uint32_t> split;
    for (const Junction& junction : junctions)
    {
        const std::uint32_t f = mesh.edge_facets[junction.edge][0];
        const auto [place, is_new] = parts.try_emplace(f);
        Part& part = place->second;
        if (is_new)
        {
            split.push_back(f);
            part.corners = mesh.facets[f];
        }
        for (std::size_t s = 0; s < 3; ++s)
        {
            if (mesh.facet_edges[f][s] != junction.edge) continue;
            std::vector<std::uint32_t>& list = part.on_side[s];
            list.insert(
                mesh.facets[f][s] == mesh.edges[junction.edge][0] ? list.end() : list.begin(),
                junction.vertex);
        }
    }
    for (const std::uint32_t f : split)
    {
        bool is_first = true;
        std::vector<Part> open{std::move(parts[f])};
        while (!open.empty())
        {
            const Part part = std::move(open.back());
            open.pop_back();
            std::size_t s = 0;
            while (s < 3 && part.on_side[s].empty()) ++s;
            if (s == 3)
            {
                if (is_first)
                    mesh.facets[f] = part.corners;
                else
                    mesh.facets.push_back(part.corners);
                is_first = false;
                continue;
            }
            const std::uint32_t a = part.corners[s], b = part.corners[(s + 1) % 3],
                                c = part.corners[(s + 2) % 3], middle = part.on_side[s].front();
            const std::vector<std::uint32_t> rest(part.on_side[s].begin() + 1,
                                                  part.on_side[s].end());
            open.push_back({{a, middle, c}, {{{}, {}, part.on_side[(s + 2) % 3]}}});
            open.push_back({{middle, b, c}, {{rest, part.on_side[(s + 1) % 3], {}}}});
        }
    }
}

void flip(SurfaceMesh& mesh, std::size_t f)
{
    std::swap(mesh.facets[f][1], mesh.facets[f][2]);
    std::swap(mesh.facet_edges[f][0], mesh.facet_edges[f][2]);
    std::swap(mesh.neighbours[f][0], mesh.neighbours[f][2]);
}

/// Numbers the shells and turns facets to agree within each; returns which facets were turned.
std::vector<char> orient_shells(SurfaceMesh& mesh, std::size_t& shells)
{
    const std::size_t n = mesh.facets.size();
    mesh.shells.assign(n, no_index);
    std::vector<char> is_turned(n, 0);
    std::vector<std::uint32_t> shell;
    shells = 0;
    for (std::size_t seed = 0; seed < n; ++seed)
    {
        if (mesh.shells[seed] != no_index) continue;
        shell.assign(1, static_cast<std::uint32_t>(seed));
        mesh.shells[seed] = static_cast<std::uint32_t>(shells);
        std::size_t turned = 0;
        for (std::size_t next = 0; next < shell.size(); ++next)
        {
            const std::uint32_t f = shell[next];
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t other = mesh.neighbours[f][s];
                if (other == no_index || mesh.shells[other] != no_index) continue;
                mesh.shells[other] = static_cast<std::uint32_t>(shells);
                shell.push_back(other);
                std::size_t t = 0;
                while (mesh.facet_edges[other][t] != mesh.facet_edges[f][s]) ++t;
                const bool clash = runs_upwards(mesh, f, s) == runs_upwards(mesh, other, t);
                is_turned[other] = static_cast<char>(clash ? !is_turned[f] : is_turned[f]);
                turned += static_cast<std::size_t>(is_turned[other]);
            }
        }
        const bool most = 2 * turned > shell.size();
        for (const std::uint32_t f : shell) is_turned[f] = static_cast<char>(is_turned[f] != most);
        ++shells;
    }
    for (std::size_t f = 0; f < n; ++f)
        if (is_turned[f] != 0) flip(mesh, f);
    return is_turned;
}

/// Six times the volume between a facet and a point.
double volume_times_six(const SurfaceMesh& mesh, std::size_t f, const Vec3& from)
{
    const Facet& corners = mesh.facets[f];
    return dot(mesh.vertices[corners[0]] - from,
               cross(mesh.vertices[corners[1]] - from, mesh.vertices[corners[2]] - from));
}

struct Shell
{
    Box3 bounds;
    std::vector<std::uint32_t> probes; ///< a few facets, evenly spread
    std::uint32_t first = no_index;
    std::size_t facets = 0;
    double volume = 0; ///< times six
    double area = 0;   ///< times two
    Vec3 area_vector;  ///< times two
    bool is_closed() const { return norm(area_vector) < 0.1 * area; }
};

std::vector<Shell> measure_shells(const SurfaceMesh& mesh, std::size_t count)
{
    std::vector<Shell> shells(count);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        Shell& shell = shells[mesh.shells[f]];
        if (shell.first == no_index) shell.first = static_cast<std::uint32_t>(f);
        ++shell.facets;
        for (const std::uint32_t v : mesh.facets[f]) shell.bounds.add(mesh.vertices[v]);
    }
    std::vector<std::size_t> passed(count, 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        Shell& shell = shells[mesh.shells[f]];
        const Facet& c = mesh.facets[f];
        const Vec3 twice = cross(mesh.vertices[c[1]] - mesh.vertices[c[0]],
                                 mesh.vertices[c[2]] - mesh.vertices[c[0]]);
        const Vec3 middle = shell.bounds.min + 0.5 * (shell.bounds.max - shell.bounds.min);
        shell.volume += volume_times_six(mesh, f, middle);
        shell.area += norm(twice);
        shell.area_vector = shell.area_vector + twice;
        const std::size_t step = std::max<std::size_t>(shell.facets / 5, 1);
        if (passed[mesh.shells[f]]++ % step == 0)
            shell.probes.push_back(static_cast<std::uint32_t>(f));
    }
    return shells;
}

TriangleSoup to_soup(const SurfaceMesh& mesh)
{
    TriangleSoup soup;
    soup.vertices.reserve(3 * mesh.facets.size());
    for (const Facet& facet : mesh.facets)
        for (const std::uint32_t v : facet) soup.vertices.push_back(mesh.vertices[v]);
    return soup;
}

/// The closed shells that hold shell s: those that rays from its facets cross an odd number of
/// times, by the vote of a few facets and three axes, so that touching shells do no harm.
std::vector<std::uint32_t> holders(const SurfaceMesh& mesh, const MeshQuery& query,
                                   const std::vector<Shell>& shells, std::uint32_t s)
{
    std::unordered_map<std::uint32_t, std::size_t> votes;
    for (const std::uint32_t f : shells[s].probes)
    {
        const Facet& c = mesh.facets[f];
        const Vec3 at = (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3.0;
        for (int axis = 0; axis < 3; ++axis)
        {
            std::vector<std::uint32_t> crossed;
            for (const Crossing& crossing : query.crossings(at, axis))
                if (mesh.shells[crossing.facet] != s)
                    crossed.push_back(mesh.shells[crossing.facet]);
            std::sort(crossed.begin(), crossed.end());
            for (std::size_t i = 0; i < crossed.size();)
            {
                std::size_t end = i;
                while (end < crossed.size() && crossed[end] == crossed[i]) ++end;
                if ((end - i) % 2 == 1) ++votes[crossed[i]];
                i = end;
            }
        }
    }
    std::vector<std::uint32_t> result;
    for (const auto& [other, count] : votes)
        if (shells[other].is_closed() && 2 * count > 3 * shells[s].probes.size())
            result.push_back(other);
    std::sort(result.begin(), result.end());
    return result;
}

/// Turns outermost shells whose volume is negative, and what they hold.
void turn_outwards(SurfaceMesh& mesh, std::size_t count, int threads, std::vector<char>& is_turned)
{
    const std::vector<Shell> shells = measure_shells(mesh, count);
    if (std::none_of(shells.begin(), shells.end(),
                     [](const Shell& s) { return s.is_closed() && s.volume < 0; }))
        return;
    std::vector<char> turn(count, 0);
    if (count == 1)
        turn[0] = 1;
    else
    {
        const MeshQuery query(to_soup(mesh), threads);
        std::vector<std::vector<std::uint32_t>> holding(count);
        parallel_for(count, threads,
                     [&](std::size_t s)
                     { holding[s] = holders(mesh, query, shells, static_cast<std::uint32_t>(s)); });
        for (std::size_t s = 0; s < count; ++s)
            if (holding[s].empty())
                turn[s] = static_cast<char>(shells[s].is_closed() && shells[s].volume < 0);
        for (std::size_t s = 0; s < count; ++s)
            for (const std::uint32_t holder : holding[s])
                if (holding[holder].empty()) turn[s] = turn[holder];
    }
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (turn[mesh.shells[f]] != 0)
        {
            flip(mesh, f);
            is_turned[f] = static_cast<char>(!is_turned[f]);
        }
}

/// Normals and areas. A facet whose height is within the rounding of its corners takes the normal
/// of its neighbour across its longest side, through several such facets where they lie in a row.
void measure_facets(SurfaceMesh& mesh, int threads)
{
    const std::size_t n = mesh.facets.size();
    mesh.normals.resize(n);
    mesh.areas.resize(n);
    std::vector<char> is_thin(n, 0);
    std::vector<char> longest(n, 0);
    parallel_for(
        n, threads,
        [&](std::size_t f)
        {
            const Measures m = measure(mesh, mesh.facets[f]);
            mesh.normals[f] = m.normal;
            mesh.areas[f] = m.area;
            double size = 0;
            for (const std::uint32_t v : mesh.facets[f])
                size = std::max(size, largest_coordinate(mesh.vertices[v]));
            // A height of 16 roundings keeps the normal within about four degrees.
            is_thin[f] = m.height < 16 * float_step * size;
            longest[f] = static_cast<char>(m.longest);
        },
        4096);
    for (std::size_t f = 0; f < n; ++f)
    {
        if (is_thin[f] == 0) continue;
        std::uint32_t at = static_cast<std::uint32_t>(f);
        for (int step = 0; step < 8 && at != no_index && is_thin[at] != 0; ++step)
            at = mesh.neighbours[at][static_cast<std::size_t>(longest[at])];
        if (at == no_index || is_thin[at] != 0) continue;
        // A thin facet that is the edge of a thin plate keeps its own side.
        if (dot(mesh.normals[at], mesh.normals[f]) > 0) mesh.normals[f] = mesh.normals[at];
    }
}

Vec3 middle_of_edge(const SurfaceMesh& mesh, std::size_t e)
{
    return 0.5 * (mesh.vertices[mesh.edges[e][0]] + mesh.vertices[mesh.edges[e][1]]);
}

/// Counts what is wrong with edges after all mending.
void judge_edges(const SurfaceMesh& mesh, MeshReport& report)
{
    std::vector<int> balance(mesh.edges.size(), 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
            balance[mesh.facet_edges[f][s]] += runs_upwards(mesh, f, s) ? 1 : -1;
    Vec3 open_at, many_at, clash_at;
    report.is_watertight = true;
    for (std::size_t e = mesh.edges.size(); e-- > 0;)
    {
        if (balance[e] != 0) report.is_watertight = false;
        if (is_open(mesh, e))
        {
            ++report.open_edges;
            open_at = middle_of_edge(mesh, e);
        }
        else if (mesh.is_manifold[e] == 0)
        {
            ++report.non_manifold_edges;
            many_at = middle_of_edge(mesh, e);
        }
        else if (balance[e] != 0)
        {
            ++report.clashing_edges;
            clash_at = middle_of_edge(mesh, e);
        }
    }
    if (report.open_edges > 0)
        report.warnings.push_back(fmt::format(
            "The surface is open: {}, the first {}.",
            counted(report.open_edges, "edge has one facet only", "edges have one facet only"),
            near(open_at)));
    if (report.non_manifold_edges > 0)
        report.warnings.push_back(fmt::format("More than two facets meet at {}, the first {}.",
                                              counted(report.non_manifold_edges, "edge", "edges"),
                                              near(many_at)));
    if (report.clashing_edges > 0)
        report.warnings.push_back(
            fmt::format("A part has one side only, as a Moebius strip: {}, the first {}.",
                        counted(report.clashing_edges, "edge has facets that face opposite ways",
                                "edges have facets that face opposite ways"),
                        near(clash_at)));
}

} // namespace

void connect_mesh(SurfaceMesh& mesh, int threads, MeshReport& report)
{
    report = {};
    report.facets_read = mesh.facets.size();
    build_edges(mesh, threads);
    orient_shells(mesh, report.shells);
    measure_facets(mesh, threads);
    for (const Facet& facet : mesh.facets)
        for (const std::uint32_t v : facet) report.bounds.add(mesh.vertices[v]);
    const Vec3 middle = report.bounds.min + 0.5 * (report.bounds.max - report.bounds.min);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        report.volume += volume_times_six(mesh, f, middle) / 6;
        report.area += mesh.areas[f];
    }
    judge_edges(mesh, report);
}

SurfaceMesh take_in_mesh(const TriangleSoup& soup, const MeshIntakeOptions& options, int threads,
                         MeshReport& report)
{
    report = {};
    report.facets_read = soup.size();
    if (soup.size() >= no_index / 3)
        throw GeometryError(fmt::format("a mesh of {} facets is too large, expected fewer than {}",
                                        soup.size(), no_index / 3));
    for (std::size_t i = 0; i < soup.vertices.size(); ++i)
        if (!is_finite(soup.vertices[i]))
            throw GeometryError(
                fmt::format("facet {} has a coordinate that is not finite", i / 3 + 1));

    SurfaceMesh mesh;
    weld_equal(soup, threads, mesh);
    if (options.weld_distance > 0) weld_near(options.weld_distance, mesh);
    drop_degenerate(mesh, report);
    if (mesh.facets.empty())
        throw GeometryError(
            fmt::format("no facet is left of {}: all lack area", report.facets_read));
    build_edges(mesh, threads);
    if (options.weld_distance == 0) close_cracks(mesh, threads, report);
    drop_copies(mesh, threads, report);
    if (mesh.facets.empty()) throw GeometryError("no facet is left: all are walls between bodies");
    drop_loose_slivers(mesh, threads, report);
    const std::vector<Junction> junctions = find_t_junctions(mesh, threads);
    Vec3 junction_at;
    if (!junctions.empty())
    {
        junction_at = mesh.vertices[junctions.front().vertex];
        report.t_junctions = junctions.size();
        split_at(junctions, mesh);
        const std::size_t copies = report.duplicate_facets;
        build_edges(mesh, threads);
        drop_copies(mesh, threads, report);
        report.duplicate_facets = copies; // these are pieces of facets, not of the file
    }
    std::vector<char> is_turned = orient_shells(mesh, report.shells);
    turn_outwards(mesh, report.shells, threads, is_turned);
    measure_facets(mesh, threads);

    for (const Facet& facet : mesh.facets)
        for (const std::uint32_t v : facet) report.bounds.add(mesh.vertices[v]);
    const Vec3 middle = report.bounds.min + 0.5 * (report.bounds.max - report.bounds.min);
    std::size_t first_turned = 0;
    for (std::size_t f = mesh.facets.size(); f-- > 0;)
    {
        report.volume += volume_times_six(mesh, f, middle) / 6;
        report.area += mesh.areas[f];
        if (is_turned[f] == 0) continue;
        ++report.flipped_facets;
        first_turned = f;
    }

    if (report.joined_corners > 0)
        report.warnings.push_back(fmt::format(
            "The facets do not meet: {} within {:.3g} m of another, joined with it.",
            counted(report.joined_corners, "corner lies", "corners lie"), report.joined_within));
    if (report.degenerate_facets > 0)
        report.warnings.push_back(
            fmt::format("{} without area but for rounding, left out.",
                        counted(report.degenerate_facets, "facet is", "facets are")));
    if (report.duplicate_facets > 0)
        report.warnings.push_back(
            fmt::format("{} of another, left out.",
                        counted(report.duplicate_facets, "facet is a copy", "facets are copies")));
    if (report.inner_wall_facets > 0)
        report.warnings.push_back(
            fmt::format("{} facets are walls between two bodies that touch, left out.",
                        report.inner_wall_facets));
    if (report.t_junctions > 0)
        report.warnings.push_back(fmt::format(
            "{} inside an edge of another facet, the first {}; these facets are split there.",
            counted(report.t_junctions, "vertex lies", "vertices lie"), near(junction_at)));
    if (report.flipped_facets > 0)
        report.warnings.push_back(
            fmt::format("{} inwards, the first {}; turned.",
                        counted(report.flipped_facets, "facet looks", "facets look"),
                        near(mesh.vertices[mesh.facets[first_turned][0]])));
    judge_edges(mesh, report);
    if (options.count_self_intersections)
    {
        const FacetPairs pairs = find_crossing_facets(mesh, threads);
        report.self_intersections = pairs.count;
        if (pairs.count > 0)
            report.warnings.push_back(
                fmt::format("{} of facets cross each other, the first {}.",
                            counted(pairs.count, "pair", "pairs"),
                            near(mesh.vertices[mesh.facets[pairs.first[0]][0]])));
    }
    return mesh;
}

} // namespace fppg
