#include "offset/creases.h"

#include "core/parallel.h"
#include "core/raw_array.h"
#include "meshes/connect_mesh.h"
#include "meshes/measure_facets.h"
#include "offset/crease_mesh.h"
#include "offset/quadric.h"
#include "offset/slivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace fppg
{
namespace
{

/// Cosine of the turn of facets below which an edge is not looked at, 8 degrees.
constexpr double looked_at = 0.990;
/// Vertices are moved onto a crease by so much at most, in cells.
constexpr double longest_move = 0.7;
/// How often vertices are put onto creases and slivers between them taken out.
constexpr int crease_rounds = 3;
/// Edges of a gap that is closed.
constexpr int gap_edges = 3;
/// Cosine of the turn of a crease in a gap, 75 degrees.
constexpr double gap_turn = 0.26;

/// Edges and width of a lens, in cells.
constexpr std::size_t lens_edges = 6;
constexpr double lens_width = 0.25;
/// Loops of so few edges lie along one crease, be it curved or not.
constexpr std::size_t tiny_loop = 4;

class CreaseFinder
{
public:
    /// was_placed  per vertex: it was put onto a crease before; may be empty
    CreaseFinder(const CreaseMesh& on, std::vector<char>&& was_placed)
        : on_(on), was_placed_(std::move(was_placed))
    {
    }

    /// Puts the vertices at creases onto them; returns whether there are any.
    bool place_vertices()
    {
        is_crease_.assign(on_.mesh.edges.size(), 0);
        pull_cut_creases();
        find(true);
        for (int round = 0; round < 2; ++round)
        {
            move_onto_creases();
            find(false);
        }
        if (pull_cut_corners(on_, is_placed_)) find(false);
        return std::any_of(is_crease_.begin(), is_crease_.end(), [](char c) { return c != 0; });
    }

    /// Per vertex whether it was put onto a crease.
    const std::vector<char>& on_creases() const { return is_placed_; }

    std::vector<std::uint32_t> run()
    {
        if (!place_vertices()) return {};
        drop_doubles();
        close_gaps();
        drop_doubles();
        std::vector<std::uint32_t> out;
        for (std::uint32_t e = 0; e < is_crease_.size(); ++e)
            if (is_crease_[e] != 0) out.push_back(e);
        return out;
    }

private:
    /// From the middle of an edge into one of its facets, unit.
    Vec3 into_facet(std::uint32_t edge, std::uint32_t facet) const
    {
        const Vec3& a = on_.mesh.vertices[on_.mesh.edges[edge][0]];
        const Vec3 along = on_.mesh.vertices[on_.mesh.edges[edge][1]] - a;
        Vec3 way;
        for (const std::uint32_t v : on_.mesh.facets[facet])
            if (v != on_.mesh.edges[edge][0] && v != on_.mesh.edges[edge][1])
                way = on_.mesh.vertices[v] - a;
        const double length = dot(along, along);
        if (!(length > 0)) return {};
        way = way - (dot(way, along) / length) * along;
        const double size = norm(way);
        return size > 0 ? way / size : Vec3{};
    }

    /// Whether the direction of the depth turns across an edge by more than the feature angle.
    bool turns(std::uint32_t e) const
    {
        const auto& facets = on_.mesh.edge_facets[e];
        if (facets[1] == no_index || on_.mesh.is_manifold[e] == 0) return false;
        if (dot(on_.normal_of(facets[0]), on_.normal_of(facets[1])) > looked_at) return false;
        const Vec3 middle = 0.5 * (on_.mesh.vertices[on_.mesh.edges[e][0]] +
                                   on_.mesh.vertices[on_.mesh.edges[e][1]]);
        std::array<Vec3, 2> directions;
        for (std::size_t s = 0; s < 2; ++s)
            directions[s] =
                on_.depths.at(middle + (beside_edge * on_.options.dp) * into_facet(e, facets[s]))
                    .direction;
        return dot(directions[0], directions[1]) < on_.turn;
    }

    /// Per vertex, whether one of its edges is a crease.
    std::vector<char> ends_of_creases() const
    {
        std::vector<char> out(on_.mesh.vertices.size(), 0);
        for (std::size_t e = 0; e < is_crease_.size(); ++e)
            if (is_crease_[e] != 0)
                for (const std::uint32_t v : on_.mesh.edges[e]) out[v] = 1;
        return out;
    }

    /// everywhere  else only at edges one of whose ends is on a crease
    void find(bool everywhere)
    {
        const std::vector<char> is_end = everywhere ? std::vector<char>() : ends_of_creases();
        parallel_for(
            on_.mesh.edges.size(), on_.threads,
            [&](std::size_t e)
            {
                const auto [a, b] = on_.mesh.edges[e];
                const bool may_be = everywhere || is_end[a] != 0 || is_end[b] != 0;
                is_crease_[e] = may_be && turns(static_cast<std::uint32_t>(e)) ? 1 : 0;
            },
            256);
    }

    std::vector<std::uint32_t> facets_around(std::uint32_t v) const
    {
        std::vector<std::uint32_t> facets;
        for (const std::uint32_t e : on_.edges_of(v))
            for (const std::uint32_t f : on_.mesh.edge_facets[e])
                if (f != no_index && std::find(facets.begin(), facets.end(), f) == facets.end())
                    facets.push_back(f);
        return facets;
    }

    /// The places on creases, or at their corners, nearest to vertices. Facets that several of
    /// these have are measured once.
    std::vector<std::optional<Vec3>> crease_places(const std::vector<std::uint32_t>& vertices,
                                                   double longest) const
    {
        std::vector<char> is_around(on_.mesh.facets.size(), 0);
        std::vector<std::uint32_t> facets;
        for (const std::uint32_t v : vertices)
            for (const std::uint32_t f : facets_around(v))
                if (std::exchange(is_around[f], char{1}) == 0) facets.push_back(f);
        RawArray<DepthPlane> planes(on_.mesh.facets.size());
        parallel_for(
            facets.size(), on_.threads,
            [&](std::size_t i) { planes[facets[i]] = plane_under(facets[i]); }, 64);
        std::vector<std::optional<Vec3>> out(vertices.size());
        parallel_for(
            vertices.size(), on_.threads,
            [&](std::size_t i) {
                out[i] =
                    crease_place(vertices[i], longest, [&](std::uint32_t f) { return planes[f]; });
            },
            64);
        return out;
    }

    /// The depth near the middle of a facet.
    struct DepthPlane
    {
        Vec3 middle;
        Vec3 direction;
        double depth;
    };
    DepthPlane plane_under(std::uint32_t facet) const
    {
        const Vec3 p = on_.middle_of(facet);
        const DepthSlope place = on_.depths.at(p);
        return {p, place.direction, place.depth};
    }

    /// The place on a crease, or at its corner, nearest to a vertex: where the planes meet along
    /// which the depth is right under the facets around it.
    ///
    /// plane_of  plane_under() of a facet
    template <typename PlaneOf>
    std::optional<Vec3> crease_place(std::uint32_t v, double longest, const PlaneOf& plane_of) const
    {
        const Vec3& from = on_.mesh.vertices[v];
        Quadric quadric;
        for (const std::uint32_t f : facets_around(v))
        {
            const DepthPlane plane = plane_of(f);
            const double at_vertex = plane.depth + dot(plane.direction, from - plane.middle);
            quadric.add_plane(plane.direction, on_.options.depth - at_vertex);
        }
        const Vec3 start = from + quadric.least_point();
        if (!(norm(start - from) < longest * on_.options.cell)) return std::nullopt;
        const Vec3 out = project_to_depth(on_.wall, start, on_.options.depth);
        return norm(out - from) < longest * on_.options.cell ? std::optional(out) : std::nullopt;
    }

    /// Whether the depths at two vertices are measured from two faces that meet between them: by
    /// halves, whether the direction of the depth turns within as little as at a crease.
    bool has_crease_between(const DepthSlope& a, const DepthSlope& b, Vec3 from, Vec3 to) const
    {
        Vec3 near = a.direction;
        Vec3 far = b.direction;
        while (dot(near, far) < on_.turn)
        {
            if (!(norm(to - from) > 2 * beside_edge * on_.options.dp)) return true;
            const Vec3 middle = 0.5 * (from + to);
            const Vec3 direction = on_.depths.at(middle).direction;
            const bool is_before = dot(near, direction) < dot(direction, far);
            (is_before ? to : from) = middle;
            (is_before ? far : near) = direction;
        }
        return false;
    }

    /// Where a crease sticks out into a cell none of whose edges it meets, the facets cut it off:
    /// of each of their sides that cross it one end is pulled onto it.
    void pull_cut_creases()
    {
        std::vector<std::uint32_t> place_of(on_.mesh.vertices.size(), no_index);
        std::vector<std::uint32_t> near;
        for (std::size_t e = 0; e < on_.mesh.edges.size(); ++e)
        {
            const auto& facets = on_.mesh.edge_facets[e];
            if (facets[1] == no_index ||
                dot(on_.mesh.normals[facets[0]], on_.mesh.normals[facets[1]]) > looked_at)
                continue;
            for (const std::uint32_t f : facets)
                for (const std::uint32_t v : on_.mesh.facets[f])
                    if (place_of[v] == no_index)
                    {
                        place_of[v] = static_cast<std::uint32_t>(near.size());
                        near.push_back(v);
                    }
        }
        std::vector<DepthSlope> places(near.size());
        parallel_for(
            near.size(), on_.threads,
            [&](std::size_t i) { places[i] = on_.depths.at(on_.mesh.vertices[near[i]]); }, 64);
        const std::vector<std::uint32_t> cut = edges_with_creases(place_of, places);
        std::vector<std::uint32_t> ends;
        for (const std::uint32_t e : cut)
            ends.insert(ends.end(), on_.mesh.edges[e].begin(), on_.mesh.edges[e].end());
        const std::vector<std::optional<Vec3>> on_crease = crease_places(ends, longest_pull);
        std::vector<char> is_pulled(on_.mesh.vertices.size(), 0);
        for (std::size_t i = 0; i < cut.size(); ++i)
        {
            const auto [a, b] = on_.mesh.edges[cut[i]];
            const std::optional<Vec3>& of_a = on_crease[2 * i];
            const std::optional<Vec3>& of_b = on_crease[2 * i + 1];
            if (is_pulled[a] != 0 || is_pulled[b] != 0 || (!of_a && !of_b)) continue;
            const bool takes_a = of_a && (!of_b || norm(*of_a - on_.mesh.vertices[a]) <=
                                                       norm(*of_b - on_.mesh.vertices[b]));
            const std::uint32_t v = takes_a ? a : b;
            on_.mesh.vertices[v] = takes_a ? *of_a : *of_b;
            is_pulled[v] = 1;
        }
    }

    /// Of the edges between vertices whose places are given, those with a crease between their
    /// ends, but for those that end on one.
    ///
    /// place_of  per vertex, or no_index
    std::vector<std::uint32_t> edges_with_creases(const std::vector<std::uint32_t>& place_of,
                                                  const std::vector<DepthSlope>& places) const
    {
        const std::vector<std::array<std::uint32_t, 2>>& edges = on_.mesh.edges;
        std::vector<char> is_cut(edges.size(), 0);
        parallel_for(
            edges.size(), on_.threads,
            [&](std::size_t e)
            {
                const auto [a, b] = edges[e];
                if (place_of[a] == no_index || place_of[b] == no_index) return;
                if (!was_placed_.empty() && (was_placed_[a] != 0 || was_placed_[b] != 0)) return;
                is_cut[e] = has_crease_between(places[place_of[a]], places[place_of[b]],
                                               on_.mesh.vertices[a], on_.mesh.vertices[b])
                                ? 1
                                : 0;
            },
            256);
        std::vector<std::uint32_t> out;
        for (std::uint32_t e = 0; e < edges.size(); ++e)
            if (is_cut[e] != 0) out.push_back(e);
        return out;
    }

    /// Those that were put onto a crease before stay where they are.
    void move_onto_creases()
    {
        is_placed_.assign(on_.mesh.vertices.size(), 0);
        std::vector<std::uint32_t> vertices;
        const std::vector<char> is_end = ends_of_creases();
        for (std::uint32_t v = 0; v < on_.mesh.vertices.size(); ++v)
        {
            if (is_end[v] == 0) continue;
            if (was_placed_.empty() || was_placed_[v] == 0)
                vertices.push_back(v);
            else
                is_placed_[v] = 1;
        }
        const std::vector<std::optional<Vec3>> places = crease_places(vertices, longest_move);
        for (std::size_t i = 0; i < vertices.size(); ++i)
        {
            if (!places[i]) continue;
            on_.mesh.vertices[vertices[i]] = *places[i];
            is_placed_[vertices[i]] = 1;
        }
    }

    /// Where slivers lie along a crease both of their sides are found: of two ways from one end of
    /// such a lens to the other one goes.
    void drop_doubles()
    {
        for (std::uint32_t e = 0; e < is_crease_.size(); ++e)
        {
            if (is_crease_[e] == 0) continue;
            std::vector<std::uint32_t> loop{e};
            if (find_loop(on_.mesh.edges[e][1], on_.mesh.edges[e][0], loop)) drop_one_way(loop);
        }
    }

    /// Completes a loop of creases that is a line seen from any side.
    ///
    /// at, goal  the loop's open end, and its start
    bool find_loop(std::uint32_t at, std::uint32_t goal, std::vector<std::uint32_t>& loop) const
    {
        if (at == goal) return is_flat(loop);
        if (loop.size() == lens_edges) return false;
        for (const std::uint32_t e : on_.edges_of(at))
        {
            if (is_crease_[e] == 0 || std::find(loop.begin(), loop.end(), e) != loop.end())
                continue;
            loop.push_back(e);
            if (find_loop(on_.other_end(e, at), goal, loop)) return true;
            loop.pop_back();
        }
        return false;
    }

    /// The two vertices of a loop that are farthest from one another.
    std::array<std::uint32_t, 2> far_ends(const std::vector<std::uint32_t>& loop) const
    {
        std::vector<std::uint32_t> vertices;
        for (const std::uint32_t e : loop)
            vertices.insert(vertices.end(), on_.mesh.edges[e].begin(), on_.mesh.edges[e].end());
        std::array<std::uint32_t, 2> ends = on_.mesh.edges[loop[0]];
        double most = 0;
        for (const std::uint32_t a : vertices)
            for (const std::uint32_t b : vertices)
            {
                const double d = norm(on_.mesh.vertices[a] - on_.mesh.vertices[b]);
                if (d <= most) continue;
                most = d;
                ends = {a, b};
            }
        return ends;
    }

    bool is_flat(const std::vector<std::uint32_t>& loop) const
    {
        if (loop.size() <= tiny_loop) return true;
        const auto [a, b] = far_ends(loop);
        const Vec3& from = on_.mesh.vertices[a];
        const Vec3 along = on_.mesh.vertices[b] - from;
        const double length = norm(along);
        for (const std::uint32_t e : loop)
            for (const std::uint32_t v : on_.mesh.edges[e])
                if (norm(cross(on_.mesh.vertices[v] - from, along)) >
                    lens_width * on_.options.cell * length)
                    return false;
        return true;
    }

    void drop_one_way(const std::vector<std::uint32_t>& loop)
    {
        const auto [a, b] = far_ends(loop);
        std::array<std::vector<std::uint32_t>, 2> ways;
        std::vector<char> is_used(loop.size(), 0);
        for (auto& way : ways)
            for (std::uint32_t at = a; at != b;)
            {
                std::size_t next = loop.size();
                for (std::size_t i = 0; i < loop.size(); ++i)
                    if (is_used[i] == 0 &&
                        (on_.mesh.edges[loop[i]][0] == at || on_.mesh.edges[loop[i]][1] == at))
                        next = std::min(next, i);
                if (next == loop.size()) return;
                is_used[next] = 1;
                way.push_back(loop[next]);
                at = on_.other_end(loop[next], at);
            }
        // The one that other creases leave stays, else that with more vertices.
        const auto weight = [this, a = a, b = b](const std::vector<std::uint32_t>& way)
        {
            int out = static_cast<int>(way.size());
            for (const std::uint32_t e : way)
                for (const std::uint32_t v : on_.mesh.edges[e])
                    if (v != a && v != b && creases_at(v) > 2) out += 100;
            return out;
        };
        for (const std::uint32_t e : ways[weight(ways[0]) < weight(ways[1]) ? 0 : 1])
            is_crease_[e] = 0;
    }

    int creases_at(std::uint32_t v) const
    {
        return static_cast<int>(std::ranges::count_if(
            on_.edges_of(v), [&](std::uint32_t e) { return is_crease_[e] != 0; }));
    }

    /// From each end of a crease on, over vertices that can be moved onto it, to another crease.
    void close_gaps()
    {
        std::vector<std::uint32_t> ends;
        for (std::uint32_t v = 0; v < on_.mesh.vertices.size(); ++v)
            if (creases_at(v) == 1) ends.push_back(v);
        for (const std::uint32_t v : ends)
            if (creases_at(v) == 1) close_gap(v);
    }

    void close_gap(std::uint32_t end)
    {
        struct Step
        {
            std::uint32_t edge;
            std::uint32_t vertex;
            Vec3 old;
        };
        std::vector<Step> path;
        std::uint32_t at = end;
        const std::uint32_t last = *std::ranges::find_if(
            on_.edges_of(end), [&](std::uint32_t e) { return is_crease_[e] != 0; });
        Vec3 way = on_.mesh.vertices[end] - on_.mesh.vertices[on_.other_end(last, end)];
        bool is_closed = false;
        while (static_cast<int>(path.size()) < gap_edges && !is_closed)
        {
            std::uint32_t best = no_index;
            Vec3 best_place;
            double best_turn = gap_turn;
            for (const std::uint32_t e : on_.edges_of(at))
            {
                if (is_crease_[e] != 0) continue;
                const std::uint32_t w = on_.other_end(e, at);
                const bool is_on = creases_at(w) > 0;
                const Vec3 rough = on_.mesh.vertices[w] - on_.mesh.vertices[at];
                if (dot(rough, way) < 0.1 * norm(rough) * norm(way)) continue;
                const std::optional<Vec3> place =
                    is_on ? std::optional(on_.mesh.vertices[w])
                          : crease_place(w, longest_move,
                                         [&](std::uint32_t f) { return plane_under(f); });
                if (!place) continue;
                const Vec3 step = *place - on_.mesh.vertices[at];
                const double turn = dot(step, way) / (norm(step) * norm(way));
                if (!(norm(step) > 0.05 * on_.options.cell) || !(turn > best_turn)) continue;
                best_turn = turn;
                best = e;
                best_place = *place;
            }
            if (best == no_index) break;
            const std::uint32_t w = on_.other_end(best, at);
            is_closed = creases_at(w) > 0;
            path.push_back({best, w, on_.mesh.vertices[w]});
            way = best_place - on_.mesh.vertices[at];
            on_.mesh.vertices[w] = best_place;
            at = w;
        }
        for (const Step& step : path)
        {
            if (is_closed)
                is_crease_[step.edge] = 1;
            else
                on_.mesh.vertices[step.vertex] = step.old;
        }
    }

    const CreaseMesh& on_;
    std::vector<char> was_placed_;
    std::vector<char> is_crease_;
    std::vector<char> is_placed_; ///< per vertex
};

} // namespace

void sharpen_creases(const WallDepth& wall, const OffsetOptions& options, int threads,
                     OffsetSurface& offset)
{
    const DepthMemo depths(wall);
    std::vector<char> on_creases;
    for (int round = 0; round < crease_rounds; ++round)
    {
        const CreaseMesh on(wall, depths, options, threads, offset.mesh);
        CreaseFinder finder(on, std::move(on_creases));
        if (!finder.place_vertices()) return;
        on_creases = finder.on_creases();
        if (turn_onto_creases(on, on_creases))
            connect_facets(offset.mesh, high_where_exact * options.cell, threads);
        remove_slivers(offset.mesh, options.cell, on_creases, threads);
    }
    const CreaseMesh on(wall, depths, options, threads, offset.mesh);
    offset.creases = CreaseFinder(on, std::move(on_creases)).run();
}

Features offset_features(const OffsetSurface& offset, const FeatureOptions& options)
{
    FeatureOptions of_creases = options;
    of_creases.angle_deg = 179.999; // never: slivers on a crease may be folded
    return find_features(offset.mesh, of_creases, offset.creases);
}

} // namespace fppg
