#include "offset/crease_mesh.h"

#include "core/parallel.h"
#include "meshes/point_grid.h"
#include "offset/quadric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace fppg
{

CreaseMesh::CreaseMesh(const WallDepth& of, const DepthMemo& by_point, const OffsetOptions& given,
                       int n, SurfaceMesh& surface)
    : wall(of),
      depths(by_point),
      options(given),
      threads(n),
      mesh(surface),
      turn(std::cos(given.feature_angle_deg * std::numbers::pi / 180))
{
    edges_ = make_row_lists<std::uint32_t>(mesh.vertices.size(), mesh.edges.size(), threads,
                                           [&](std::size_t e, const auto& add)
                                           {
                                               for (const std::uint32_t v : mesh.edges[e])
                                                   add(v, static_cast<std::uint32_t>(e));
                                           });
}

Vec3 CreaseMesh::normal_of(std::uint32_t facet) const
{
    const auto& f = mesh.facets[facet];
    const Vec3& a = mesh.vertices[f[0]];
    const Vec3 n = cross(mesh.vertices[f[1]] - a, mesh.vertices[f[2]] - a);
    const double size = norm(n);
    return size > 0 ? n / size : Vec3{};
}

Vec3 CreaseMesh::middle_of(std::uint32_t facet) const
{
    const auto& f = mesh.facets[facet];
    return (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
}

namespace
{

/// A vertex stands at a corner that is so near, in cells.
constexpr double at_corner = 0.05;
/// Between two vertices on a crease the depth is right to this, in cells.
constexpr double along_crease = 0.05;

/// Mends creases where the grid cut them.
class CreaseMender
{
public:
    CreaseMender(const CreaseMesh& on, const std::vector<char>& is_placed)
        : on_(on), is_placed_(is_placed)
    {
    }

    /// Where two vertices on a crease lie across the edge of two others, the crease runs between
    /// them: that edge is turned. Facets change; returns whether any was turned.
    bool turn_onto_creases()
    {
        std::vector<char> turns_over(on_.mesh.edges.size(), 0);
        parallel_for(
            on_.mesh.edges.size(), on_.threads,
            [&](std::size_t e)
            { turns_over[e] = is_across(static_cast<std::uint32_t>(e)) ? 1 : 0; },
            256);
        std::vector<char> is_used(on_.mesh.facets.size(), 0);
        bool found = false;
        for (std::uint32_t e = 0; e < on_.mesh.edges.size(); ++e)
        {
            if (turns_over[e] == 0) continue;
            const auto [f, g] = on_.mesh.edge_facets[e];
            bool is_free = true;
            for (const std::uint32_t of : {f, g})
            {
                is_free = is_free && is_used[of] == 0;
                for (const std::uint32_t n : on_.mesh.neighbours[of])
                    is_free = is_free && (n == no_index || is_used[n] == 0);
            }
            if (!is_free) continue;
            const Turned turned = turned_facets(e);
            is_used[f] = is_used[g] = 1;
            on_.mesh.facets[f] = turned.one;
            on_.mesh.facets[g] = turned.two;
            found = true;
        }
        return found;
    }

    /// Whether three of some unit vectors turn from one to the other by more than the feature
    /// angle.
    bool has_corner(const std::vector<Vec3>& directions) const
    {
        std::vector<Vec3> different;
        for (const Vec3& d : directions)
        {
            const bool is_new = std::all_of(different.begin(), different.end(),
                                            [&](const Vec3& o) { return dot(o, d) < on_.turn; });
            if (is_new) different.push_back(d);
        }
        return different.size() > 2;
    }

    /// The corner of creases near a vertex on one, if no vertex next to it stands there.
    std::optional<Vec3> corner_near(std::uint32_t v) const
    {
        std::vector<std::uint32_t> facets;
        std::vector<std::uint32_t> vertices{v};
        for (const std::uint32_t e : on_.edges_of(v)) vertices.push_back(on_.other_end(e, v));
        for (const std::uint32_t w : vertices)
            for (const std::uint32_t e : on_.edges_of(w))
                for (const std::uint32_t f : on_.mesh.edge_facets[e])
                    if (f != no_index) facets.push_back(f);
        std::sort(facets.begin(), facets.end());
        facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
        std::vector<Vec3> directions;
        for (const std::uint32_t f : facets) directions.push_back(on_.normal_of(f));
        if (!has_corner(directions)) return std::nullopt;
        directions.clear();
        std::vector<Vec3> middles;
        Quadric quadric;
        for (const std::uint32_t f : facets)
        {
            middles.push_back(on_.middle_of(f));
            const DepthSlope place = on_.depths.at(middles.back());
            directions.push_back(place.direction);
            const double at_vertex =
                place.depth + dot(place.direction, on_.mesh.vertices[v] - middles.back());
            quadric.add_plane(place.direction, on_.options.depth - at_vertex);
        }
        if (!has_corner(directions)) return std::nullopt;
        const double longest = longest_pull * on_.options.cell;
        const Vec3 start = on_.mesh.vertices[v] + quadric.least_point();
        if (!(norm(start - on_.mesh.vertices[v]) < longest)) return std::nullopt;
        const Vec3 out =
            project_to_crease(on_.wall, start, on_.options.depth, on_.options.dp, middles);
        if (!(norm(out - on_.mesh.vertices[v]) < longest)) return std::nullopt;
        for (const std::uint32_t f : facets)
            for (const std::uint32_t w : on_.mesh.facets[f])
                if (norm(on_.mesh.vertices[w] - out) < at_corner * on_.options.cell)
                    return std::nullopt;
        // All the faces meet there.
        directions.clear();
        for (const Vec3& m : middles)
        {
            const double size = norm(m - out);
            if (!(size > 0)) continue;
            const double share = std::min(beside_edge * on_.options.dp / size, 1.0);
            const DepthSlope place = on_.depths.at(out + share * (m - out));
            if (std::fabs(place.depth + dot(place.direction, share * (out - m)) -
                          on_.options.depth) < along_crease * on_.options.cell)
                directions.push_back(place.direction);
        }
        return has_corner(directions) ? std::optional(out) : std::nullopt;
    }

    /// Where a corner of creases sticks out into a cell none of whose edges it meets, they end
    /// short of it: the vertex nearest to it is pulled there. Returns whether any was.
    bool pull_cut_corners()
    {
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t v = 0; v < on_.mesh.vertices.size(); ++v)
            if (is_placed_[v] != 0) vertices.push_back(v);
        std::vector<std::optional<Vec3>> places(vertices.size());
        parallel_for(
            vertices.size(), on_.threads,
            [&](std::size_t i) { places[i] = corner_near(vertices[i]); }, 64);
        struct Pull
        {
            double way;
            std::uint32_t vertex;
            Vec3 corner;
        };
        std::vector<Pull> pulls;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (places[i])
                pulls.push_back(
                    {norm(*places[i] - on_.mesh.vertices[vertices[i]]), vertices[i], *places[i]});
        std::sort(pulls.begin(), pulls.end(),
                  [](const Pull& a, const Pull& b)
                  { return std::pair(a.way, a.vertex) < std::pair(b.way, b.vertex); });
        PointGrid taken(on_.options.cell, pulls.size());
        for (const Pull& pull : pulls)
        {
            if (taken.has_nearer(pull.corner, 0.5 * on_.options.cell)) continue;
            taken.add(pull.corner);
            on_.mesh.vertices[pull.vertex] = pull.corner;
        }
        return !pulls.empty();
    }

private:
    /// The facets on both sides of an edge with the edge turned to their other corners.
    struct Turned
    {
        std::array<std::uint32_t, 3> one{};
        std::array<std::uint32_t, 3> two{};
        std::array<std::uint32_t, 2> tips{no_index, no_index};
    };
    Turned turned_facets(std::uint32_t e) const
    {
        Turned out;
        const auto [f, g] = on_.mesh.edge_facets[e];
        std::size_t side = 0;
        while (on_.mesh.facet_edges[f][side] != e) ++side;
        const std::uint32_t a = on_.mesh.facets[f][side];
        const std::uint32_t b = on_.mesh.facets[f][(side + 1) % 3];
        const std::uint32_t c = on_.mesh.facets[f][(side + 2) % 3];
        std::uint32_t d = no_index;
        for (const std::uint32_t v : on_.mesh.facets[g])
            if (v != a && v != b) d = v;
        out.one = {c, a, d};
        out.two = {c, d, b};
        out.tips = {c, d};
        return out;
    }

    bool is_across(std::uint32_t e) const
    {
        if (on_.mesh.edge_facets[e][1] == no_index || on_.mesh.is_manifold[e] == 0) return false;
        const auto [a, b] = on_.mesh.edges[e];
        if (is_placed_[a] != 0 && is_placed_[b] != 0) return false;
        const Turned turned = turned_facets(e);
        const auto [c, d] = turned.tips;
        if (d == no_index || c == d || is_placed_[c] == 0 || is_placed_[d] == 0) return false;
        // Never a second edge between two vertices.
        const std::array<std::uint32_t, 2> diagonal{std::min(c, d), std::max(c, d)};
        if (std::binary_search(on_.mesh.edges.begin(), on_.mesh.edges.end(), diagonal))
            return false;
        const Vec3 middle = 0.5 * (on_.mesh.vertices[c] + on_.mesh.vertices[d]);
        if (std::fabs(on_.depths.at(middle).depth - on_.options.depth) >
            along_crease * on_.options.cell)
            return false;
        std::array<Vec3, 2> directions;
        std::array<std::uint32_t, 2> ends{a, b};
        for (std::size_t s = 0; s < 2; ++s)
        {
            const Vec3 way = on_.mesh.vertices[ends[s]] - middle;
            const double size = norm(way);
            if (!(size > 0)) return false;
            directions[s] =
                on_.depths.at(middle + std::min(beside_edge * on_.options.dp / size, 1.0) * way)
                    .direction;
        }
        return dot(directions[0], directions[1]) < on_.turn;
    }

    const CreaseMesh& on_;
    const std::vector<char>& is_placed_;
};

} // namespace

bool turn_onto_creases(const CreaseMesh& on, const std::vector<char>& is_placed)
{
    return CreaseMender(on, is_placed).turn_onto_creases();
}

bool pull_cut_corners(const CreaseMesh& on, const std::vector<char>& is_placed)
{
    return CreaseMender(on, is_placed).pull_cut_corners();
}

} // namespace fppg
