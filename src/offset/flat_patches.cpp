#include "offset/flat_patches.h"

#include "core/parallel.h"
#include "meshes/connect_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

using Facets = std::vector<std::array<std::uint32_t, 3>>;
using Edge = std::pair<std::uint32_t, std::uint32_t>; ///< from, to

/// Patches of fewer facets gain nothing.
constexpr std::size_t least_facets = 12;
/// How far vertices may be off the plane of their patch, in cells.
constexpr double off_plane = 1e-7;
/// Of two patches in one plane, the normals differ by less.
constexpr double same_normal = 1e-6;
/// Twice the least area of a facet of a fan, in cells^2.
constexpr double least_area = 0.2;

/// What a flat patch is drawn from.
struct FlatPatch
{
    bool is_flat = false;
    Vec3 normal;                       ///< unit
    std::vector<std::uint32_t> around; ///< the vertices around it, counter-clockwise
    /// Per edge from one of these to the next the flat patch beyond it; no_index: another
    std::vector<std::uint32_t> beyond;
    std::uint32_t middle = 0; ///< a vertex inside
};

/// Twice the area of a facet, along its normal.
Vec3 area_vector(const std::vector<Vec3>& at, const std::array<std::uint32_t, 3>& facet)
{
    return cross(at[facet[1]] - at[facet[0]], at[facet[2]] - at[facet[0]]);
}

/// The edges that only one facet has, from vertex to vertex as it turns, ascending.
std::vector<Edge> edges_around(const Facets& facets)
{
    std::vector<Edge> all;
    for (const auto& f : facets)
        for (std::size_t k = 0; k < 3; ++k) all.emplace_back(f[k], f[(k + 1) % 3]);
    std::sort(all.begin(), all.end());
    std::vector<Edge> out;
    for (const Edge& e : all)
        if (!std::binary_search(all.begin(), all.end(), Edge{e.second, e.first})) out.push_back(e);
    return out;
}

/// The vertices of edges that form one loop; empty where they do not.
std::vector<std::uint32_t> loop_of(const std::vector<Edge>& edges)
{
    if (edges.empty()) return {};
    std::vector<std::uint32_t> loop;
    std::uint32_t at = edges.front().first;
    do
    {
        const auto next = std::lower_bound(edges.begin(), edges.end(), Edge{at, 0});
        if (next == edges.end() || next->first != at || loop.size() == edges.size()) return {};
        if (next + 1 != edges.end() && (next + 1)->first == at) return {};
        loop.push_back(at);
        at = next->second;
    } while (at != edges.front().first);
    return loop.size() == edges.size() ? loop : std::vector<std::uint32_t>();
}

FlatPatch flat_patch(const std::vector<Vec3>& at, const Facets& facets, double cell)
{
    FlatPatch out;
    if (facets.size() < least_facets) return out;
    Vec3 sum;
    for (const auto& f : facets) sum = sum + area_vector(at, f);
    out.normal = sum / norm(sum);
    const Vec3& base = at[facets[0][0]];
    Vec3 mean;
    for (const auto& f : facets)
    {
        if (!(dot(area_vector(at, f), out.normal) > 0)) return out;
        for (const std::uint32_t v : f)
        {
            if (!(std::fabs(dot(at[v] - base, out.normal)) < off_plane * cell)) return out;
            mean = mean + at[v] / (3.0 * static_cast<double>(facets.size()));
        }
    }
    out.around = loop_of(edges_around(facets));
    if (out.around.empty()) return out;
    std::vector<std::uint32_t> rim = out.around;
    std::sort(rim.begin(), rim.end());
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& f : facets)
        for (const std::uint32_t v : f)
        {
            const double distance = norm(at[v] - mean);
            if (distance < nearest && !std::binary_search(rim.begin(), rim.end(), v))
                std::tie(nearest, out.middle) = std::pair(distance, v);
        }
    out.is_flat = std::isfinite(nearest);
    out.beyond.assign(out.around.size(), no_index);
    return out;
}

/// Finds the patches beyond the edges of each; edges that more than two have stay as they are.
void find_neighbours(std::vector<FlatPatch>& flats)
{
    struct Side
    {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t patch;
        std::uint32_t edge;
    };
    std::vector<Side> sides;
    for (std::uint32_t p = 0; p < flats.size(); ++p)
    {
        if (!flats[p].is_flat) continue;
        const auto& around = flats[p].around;
        for (std::uint32_t e = 0; e < around.size(); ++e)
        {
            const auto [low, high] = std::minmax(around[e], around[(e + 1) % around.size()]);
            sides.push_back({low, high, p, e});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b)
              { return std::tie(a.low, a.high, a.patch) < std::tie(b.low, b.high, b.patch); });
    const auto is_same = [&](std::size_t s, std::size_t t)
    { return sides[s].low == sides[t].low && sides[s].high == sides[t].high; };
    for (std::size_t s = 0; s + 1 < sides.size(); ++s)
    {
        const bool is_third = s > 0 && is_same(s - 1, s);
        if (is_third || !is_same(s, s + 1) || (s + 2 < sides.size() && is_same(s, s + 2))) continue;
        const Side& a = sides[s];
        const Side& b = sides[s + 1];
        FlatPatch& one = flats[a.patch];
        FlatPatch& other = flats[b.patch];
        if (norm(one.normal - other.normal) > same_normal) continue;
        one.beyond[a.edge] = b.patch;
        other.beyond[b.edge] = a.patch;
    }
}

/// The fan of a flat patch; empty where one of its facets would be too small or turned.
Facets fan_of(const std::vector<Vec3>& at, const FlatPatch& patch, double cell)
{
    std::vector<std::uint32_t> corners;
    const std::size_t n = patch.around.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        const std::uint32_t before = patch.beyond[(i + n - 1) % n];
        if (patch.beyond[i] == no_index || before != patch.beyond[i])
            corners.push_back(patch.around[i]);
    }
    if (corners.size() < 3) return {};
    Facets out;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        out.push_back({patch.middle, corners[i], corners[(i + 1) % corners.size()]});
        if (!(dot(area_vector(at, out.back()), patch.normal) > least_area * cell * cell)) return {};
    }
    return out;
}

/// Drops vertices that no facet has.
void drop_unused(PatchedMesh& mesh)
{
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), no_index);
    for (const Facets& facets : mesh.patches)
        for (const auto& f : facets)
            for (const std::uint32_t v : f) renamed[v] = 0;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < renamed.size(); ++v)
    {
        if (renamed[v] == no_index) continue;
        mesh.vertices[count] = mesh.vertices[v];
        renamed[v] = count++;
    }
    mesh.vertices.resize(count);
    for (Facets& facets : mesh.patches)
        for (auto& f : facets)
            for (std::uint32_t& v : f) v = renamed[v];
}

} // namespace

void merge_flat_facets(double cell, int threads, PatchedMesh& mesh)
{
    std::vector<FlatPatch> flats(mesh.patches.size());
    parallel_for(
        flats.size(), threads,
        [&](std::size_t p) { flats[p] = flat_patch(mesh.vertices, mesh.patches[p], cell); }, 16);
    find_neighbours(flats);
    // A patch that stays as it is keeps the vertices it shares, which its neighbours take in.
    std::vector<Facets> fans(flats.size());
    for (bool has_changed = true; has_changed;)
    {
        std::vector<char> fails(flats.size(), 0);
        parallel_for(
            flats.size(), threads,
            [&](std::size_t p)
            {
                if (!flats[p].is_flat) return;
                fans[p] = fan_of(mesh.vertices, flats[p], cell);
                fails[p] = fans[p].empty() ? 1 : 0;
            },
            64);
        has_changed = std::ranges::find(fails, 1) != fails.end();
        for (std::size_t p = 0; p < flats.size(); ++p)
        {
            if (fails[p] != 0) flats[p].is_flat = false;
            for (std::uint32_t& beyond : flats[p].beyond)
                if (beyond != no_index && fails[beyond] != 0) beyond = no_index;
        }
    }
    for (std::size_t p = 0; p < flats.size(); ++p)
        if (flats[p].is_flat) mesh.patches[p] = std::move(fans[p]);
    drop_unused(mesh);
}

} // namespace fppg
