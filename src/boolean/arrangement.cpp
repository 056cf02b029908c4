#include "boolean/arrangement.h"

#include "boolean/cluster_cut.h"
#include "boolean/contacts.h"
#include "boolean/line_crossings.h"

#include "core/disjoint_set.h"
#include "core/parallel.h"
#include "meshes/point_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

namespace fppg
{
namespace
{

std::uint64_t key_of(std::uint32_t a, std::uint32_t b)
{
    return static_cast<std::uint64_t>(a) << 32 | b;
}

class Arranger
{
public:
    Arranger(const std::vector<const SurfaceMesh*>& meshes, double merge_distance, int threads)
        : reach_(merge_distance),
          threads_(threads),
          set_(join_meshes(meshes, merge_distance)),
          facet_groups_(set_.facets.size())
    {
    }

    Arrangement run()
    {
        take_in_contacts();
        make_side_pieces();
        make_clusters();
        cross_lines();
        join_near_vertices();
        split_pieces();
        return cut_up();
    }

private:
    std::uint32_t vertex_of(const Contact& c)
    {
        if (c.kind == Contact::Kind::Vertex) return c.first;
        auto& known = c.kind == Contact::Kind::Sides ? by_sides_ : by_side_facet_;
        const auto [at, is_new] = known.try_emplace(
            key_of(c.first, c.second), static_cast<std::uint32_t>(set_.vertices.size()));
        if (is_new) set_.vertices.push_back(c.position);
        return at->second;
    }

    std::uint32_t piece(std::uint32_t a, std::uint32_t b)
    {
        const Pair ends = std::minmax(a, b);
        const auto [at, is_new] = by_ends_.try_emplace(key_of(ends.first, ends.second),
                                                       static_cast<std::uint32_t>(pieces_.size()));
        if (is_new)
        {
            Piece made;
            made.from = ends.first;
            made.to = ends.second;
            pieces_.push_back(std::move(made));
        }
        return at->second;
    }

    void take_in_contacts()
    {
        const std::vector<FacetContacts> all = find_contacts(set_, reach_, threads_);
        on_side_.resize(set_.sides.size());
        is_touched_.assign(set_.facets.size(), 0);
        for (const FacetContacts& pair : all)
        {
            std::vector<std::uint32_t> chain;
            for (const Contact& c : pair.contacts)
            {
                const std::uint32_t v = vertex_of(c);
                if (chain.empty() || chain.back() != v) chain.push_back(v);
                for (const std::uint32_t e : c.on_sides)
                    if (e != no_index) on_side_[e].push_back(v);
                if (c.in_facet != no_index) in_facet_.emplace_back(c.in_facet, v);
            }
            if (pair.is_coplanar)
            {
                facet_groups_.join(pair.f, pair.g);
                is_touched_[pair.f] = is_touched_[pair.g] = 1;
                ++coplanar_pairs_;
                continue;
            }
            if (chain.size() > 1) ++crossing_pairs_;
            for (std::size_t i = 1; i < chain.size(); ++i)
                seams_.push_back({pair.f, pair.g, chain[i - 1], chain[i]});
        }
    }

    /// Sides with vertices on them in pieces, from their first end to their second.
    void make_side_pieces()
    {
        parallel_for(
            on_side_.size(), threads_,
            [&](std::size_t e)
            {
                std::vector<std::uint32_t>& on = on_side_[e];
                if (on.empty()) return;
                sort_along(set_.sides[e][0], set_.sides[e][1], on);
            },
            1024);
    }

    void sort_along(std::uint32_t from, std::uint32_t to, std::vector<std::uint32_t>& on) const
    {
        const Vec3 along = set_.vertices[to] - set_.vertices[from];
        std::vector<std::pair<double, std::uint32_t>> order;
        std::sort(on.begin(), on.end());
        on.erase(std::unique(on.begin(), on.end()), on.end());
        for (const std::uint32_t v : on)
            if (v != from && v != to)
                order.emplace_back(dot(set_.vertices[v] - set_.vertices[from], along), v);
        std::sort(order.begin(), order.end());
        on.clear();
        for (const auto& [t, v] : order) on.push_back(v);
    }

    void make_clusters()
    {
        for (const auto& [f, v] : in_facet_) is_touched_[f] = 1;
        for (const Seam& s : seams_) is_touched_[s.f] = is_touched_[s.g] = 1;
        for (std::uint32_t f = 0; f < set_.facets.size(); ++f)
            for (const std::uint32_t e : set_.facet_sides[f])
                if (!on_side_[e].empty()) is_touched_[f] = 1;
        // A vertex that is found on a side later splits the facet behind it as well.
        std::vector<char> has_touched(set_.sides.size(), 0);
        for (std::uint32_t f = 0; f < set_.facets.size(); ++f)
            if (is_touched_[f] != 0)
                for (const std::uint32_t e : set_.facet_sides[f]) has_touched[e] = 1;
        for (std::uint32_t f = 0; f < set_.facets.size(); ++f)
            for (const std::uint32_t e : set_.facet_sides[f])
                if (has_touched[e] != 0) is_touched_[f] = 1;
        cluster_of_.assign(set_.facets.size(), no_index);
        for (std::uint32_t f = 0; f < set_.facets.size(); ++f)
        {
            if (is_touched_[f] == 0) continue;
            const std::uint32_t head = facet_groups_.find(f);
            if (cluster_of_[head] == no_index)
            {
                cluster_of_[head] = static_cast<std::uint32_t>(clusters_.size());
                clusters_.emplace_back();
            }
            cluster_of_[f] = cluster_of_[head];
            clusters_[cluster_of_[f]].facets.push_back(f);
            for (const std::uint32_t e : set_.facet_sides[f]) side_pieces(e);
        }
        for (const auto& [f, v] : in_facet_) clusters_[cluster_of_[f]].points.push_back(v);
        for (const Seam& s : seams_)
        {
            const std::size_t before = pieces_.size();
            const std::uint32_t p = piece(s.u, s.v);
            if (pieces_.size() > before)
            {
                pieces_[p].facets = {s.f, s.g};
                of_facets_[key_of(s.f, s.g)].push_back(p);
            }
            clusters_[cluster_of_[s.f]].lines.push_back(p);
            if (cluster_of_[s.g] != cluster_of_[s.f])
                clusters_[cluster_of_[s.g]].lines.push_back(p);
        }
        parallel_for(
            clusters_.size(), threads_,
            [&](std::size_t i)
            {
                Cluster& c = clusters_[i];
                std::sort(c.lines.begin(), c.lines.end());
                c.lines.erase(std::unique(c.lines.begin(), c.lines.end()), c.lines.end());
                choose_plane(c);
            },
            64);
    }

    /// The pieces of a side; made once.
    const std::vector<std::uint32_t>& side_pieces(std::uint32_t e)
    {
        if (side_pieces_.size() < set_.sides.size()) side_pieces_.resize(set_.sides.size());
        std::vector<std::uint32_t>& list = side_pieces_[e];
        if (!list.empty()) return list;
        std::uint32_t from = set_.sides[e][0];
        for (const std::uint32_t v : on_side_[e])
        {
            list.push_back(piece(from, v));
            from = v;
        }
        list.push_back(piece(from, set_.sides[e][1]));
        return list;
    }

    /// The two coordinates in which the largest member appears largest.
    void choose_plane(Cluster& c) const
    {
        Vec3 largest;
        for (const std::uint32_t f : c.facets)
        {
            const auto p = set_.corners(f);
            const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
            if (squared(n) > squared(largest)) largest = n;
        }
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (std::abs(largest[k]) > std::abs(largest[axis])) axis = k;
        c.axis_u = (axis + 1) % 3;
        c.axis_v = (axis + 2) % 3;
    }

    /// All pieces of a cluster: those of sides, then lines; each once.
    std::vector<std::uint32_t> pieces_of(const Cluster& c) const
    {
        std::vector<std::uint32_t> all;
        for (const std::uint32_t f : c.facets)
            for (const std::uint32_t e : set_.facet_sides[f])
                all.insert(all.end(), side_pieces_[e].begin(), side_pieces_[e].end());
        all.insert(all.end(), c.lines.begin(), c.lines.end());
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }

    std::vector<LineCrossing> crossings_in(const Cluster& c) const
    {
        if (c.lines.empty() && c.facets.size() == 1) return {};
        // Of one facet only lines can cross; of several their sides as well.
        const LinesInPlane lines{set_.vertices, pieces_, c.axis_u, c.axis_v};
        return find_crossings(lines, c.facets.size() == 1 ? c.lines : pieces_of(c));
    }

    /// Lines that cross inside a facet get a common vertex. The line of two facets meets a third
    /// facet in one vertex, in whichever of the three it is found.
    void cross_lines()
    {
        std::vector<std::vector<LineCrossing>> found(clusters_.size());
        parallel_for(
            clusters_.size(), threads_,
            [&](std::size_t i) { found[i] = crossings_in(clusters_[i]); }, 16);
        KnownCrossings known;
        for (const std::vector<LineCrossing>& list : found)
            for (const LineCrossing& x : list) add_crossing(x, known);
    }

    struct KnownCrossings
    {
        /// By the two smaller of three facets the third one, and the vertex where they meet.
        std::unordered_map<std::uint64_t, std::vector<Pair>> of_three;
        std::unordered_map<std::uint64_t, std::uint32_t> of_two; ///< by pieces
    };

    void add_crossing(const LineCrossing& x, KnownCrossings& known)
    {
        std::array<std::uint32_t, 4> four{pieces_[x.a].facets[0], pieces_[x.a].facets[1],
                                          pieces_[x.b].facets[0], pieces_[x.b].facets[1]};
        std::sort(four.begin(), four.end());
        const auto end = std::unique(four.begin(), four.end());
        const auto fresh = static_cast<std::uint32_t>(set_.vertices.size());
        std::uint32_t v = fresh;
        const bool is_triple = end - four.begin() == 3 && four[2] != no_index;
        if (is_triple)
        {
            std::vector<Pair>& thirds = known.of_three[key_of(four[0], four[1])];
            const auto it = std::find_if(thirds.begin(), thirds.end(),
                                         [&](const Pair& k) { return k.first == four[2]; });
            if (it != thirds.end())
                v = it->second;
            else
                thirds.emplace_back(four[2], fresh);
        }
        else
            v = known.of_two.try_emplace(key_of(x.a, x.b), fresh).first->second;
        if (v == fresh) set_.vertices.push_back(x.position);
        pieces_[x.a].inner.push_back(v);
        pieces_[x.b].inner.push_back(v);
        if (!is_triple) return;
        for (const auto& [f, g] :
             {Pair(four[0], four[1]), Pair(four[0], four[2]), Pair(four[1], four[2])})
        {
            const auto line = of_facets_.find(key_of(f, g));
            if (line == of_facets_.end()) continue;
            for (const std::uint32_t p : line->second)
                if (p != x.a && p != x.b && lies_along(p, v)) pieces_[p].inner.push_back(v);
        }
    }

    bool lies_along(std::uint32_t p, std::uint32_t v) const
    {
        const Vec3& from = set_.vertices[pieces_[p].from];
        const Vec3 along = set_.vertices[pieces_[p].to] - from;
        const double t = dot(set_.vertices[v] - from, along);
        return t > 0 && t < squared(along);
    }

    /// Vertices that come out within the merge distance are one, wherever they are used.
    void join_near_vertices()
    {
        std::vector<std::uint32_t> used;
        for (const Piece& p : pieces_)
        {
            used.push_back(p.from);
            used.push_back(p.to);
            used.insert(used.end(), p.inner.begin(), p.inner.end());
        }
        for (const Cluster& c : clusters_)
            used.insert(used.end(), c.points.begin(), c.points.end());
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        place_.resize(set_.vertices.size());
        std::iota(place_.begin(), place_.end(), 0U);
        PointGrid grid(8 * reach_, used.size());
        std::vector<std::uint32_t> of_point;
        for (const std::uint32_t v : used)
        {
            std::uint32_t joined = no_index;
            grid.for_each_near(set_.vertices[v], reach_,
                               [&](std::uint32_t i, double)
                               { joined = std::min(joined, of_point[i]); });
            if (joined != no_index)
                place_[v] = joined;
            else
            {
                grid.add(set_.vertices[v]);
                of_point.push_back(v);
            }
        }
        for (Piece& p : pieces_)
        {
            p.from = place_[p.from];
            p.to = place_[p.to];
            for (std::uint32_t& v : p.inner) v = place_[v];
        }
        for (Cluster& c : clusters_)
            for (std::uint32_t& v : c.points) v = place_[v];
    }

    /// Vertices of a cluster that lie on a piece split it; pieces with the same ends agree.
    void split_pieces()
    {
        std::vector<std::vector<Pair>> found(clusters_.size());
        parallel_for(
            clusters_.size(), threads_,
            [&](std::size_t i) { found[i] = points_on_pieces(clusters_[i]); }, 16);
        for (const auto& list : found)
            for (const auto& [p, v] : list) pieces_[p].inner.push_back(v);
        std::unordered_map<std::uint64_t, std::uint32_t> by_ends;
        twin_.resize(pieces_.size());
        for (std::uint32_t p = 0; p < pieces_.size(); ++p)
        {
            const Pair ends = std::minmax(pieces_[p].from, pieces_[p].to);
            twin_[p] = by_ends.try_emplace(key_of(ends.first, ends.second), p).first->second;
            if (twin_[p] != p)
                pieces_[twin_[p]].inner.insert(pieces_[twin_[p]].inner.end(),
                                               pieces_[p].inner.begin(), pieces_[p].inner.end());
        }
        parallel_for(
            pieces_.size(), threads_,
            [&](std::size_t p)
            {
                if (twin_[p] == p && !pieces_[p].inner.empty())
                    sort_along(pieces_[p].from, pieces_[p].to, pieces_[p].inner);
            },
            1024);
    }

    std::vector<Pair> points_on_pieces(const Cluster& c) const
    {
        std::vector<Pair> found;
        const std::vector<std::uint32_t> all = pieces_of(c);
        std::vector<std::pair<double, std::uint32_t>> points;
        const auto add = [&](std::uint32_t v)
        { points.emplace_back(set_.vertices[v][c.axis_u], v); };
        for (const std::uint32_t p : all)
        {
            add(pieces_[p].from);
            add(pieces_[p].to);
            for (const std::uint32_t v : pieces_[p].inner) add(v);
        }
        for (const std::uint32_t v : c.points) add(v);
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        for (const std::uint32_t p : all)
        {
            const auto [from, to] = Pair(pieces_[p].from, pieces_[p].to);
            if (from == to) continue;
            const Vec3 &a = set_.vertices[from], &b = set_.vertices[to];
            const Vec3 along = b - a;
            const double length2 = squared(along);
            const double low = std::min(a[c.axis_u], b[c.axis_u]) - reach_;
            const double high = std::max(a[c.axis_u], b[c.axis_u]) + reach_;
            for (auto it = std::lower_bound(points.begin(), points.end(), Pair2{low, 0});
                 it != points.end() && it->first <= high; ++it)
            {
                const std::uint32_t v = it->second;
                if (v == from || v == to) continue;
                const Vec3 away = set_.vertices[v] - a;
                const double t = dot(away, along) / length2;
                if (t > 0 && t < 1 && squared(away - t * along) < reach_ * reach_)
                    found.emplace_back(p, v);
            }
        }
        return found;
    }

    /// Calls visit(u, v) for the parts of a piece, from its first end to its second.
    template <typename Visit>
    void for_each_part(std::uint32_t p, const Visit& visit) const
    {
        const Piece& piece = pieces_[twin_[p]];
        const bool is_turned = piece.from != pieces_[p].from;
        std::uint32_t from = pieces_[p].from;
        const auto to = [&](std::uint32_t v)
        {
            if (v != from) visit(from, v);
            from = v;
        };
        if (is_turned)
            std::for_each(piece.inner.rbegin(), piece.inner.rend(), to);
        else
            std::for_each(piece.inner.begin(), piece.inner.end(), to);
        to(pieces_[p].to);
    }

    /// The outline of a facet as directed parts; those that run back and forth cancel out.
    std::vector<Pair> outline(std::uint32_t f) const
    {
        std::vector<Pair> out;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const std::uint32_t e = set_.facet_sides[f][s];
            const bool is_forward = place_[set_.sides[e][0]] == place_[set_.facets[f][s]];
            std::uint32_t from = place_[is_forward ? set_.sides[e][0] : set_.sides[e][1]];
            std::vector<std::uint32_t> list = side_pieces_[e];
            if (!is_forward) std::reverse(list.begin(), list.end());
            for (const std::uint32_t p : list)
            {
                std::vector<Pair> parts;
                for_each_part(p,
                              [&](std::uint32_t u, std::uint32_t v) { parts.emplace_back(u, v); });
                if (parts.empty()) continue;
                if (parts.front().first != from)
                {
                    std::reverse(parts.begin(), parts.end());
                    for (Pair& part : parts) std::swap(part.first, part.second);
                }
                from = parts.back().second;
                out.insert(out.end(), parts.begin(), parts.end());
            }
        }
        std::vector<Pair> kept;
        for (const Pair& part : out)
        {
            const auto back = std::find(kept.begin(), kept.end(), Pair(part.second, part.first));
            if (back != kept.end())
                kept.erase(back);
            else
                kept.push_back(part);
        }
        return kept;
    }

    CutUp cut_up_one(const Cluster& c) const
    {
        std::vector<std::vector<Pair>> outlines;
        std::vector<Pair> lines;
        for (const std::uint32_t f : c.facets)
        {
            outlines.push_back(outline(f));
            for (const Pair& part : outlines.back())
                lines.push_back(std::minmax(part.first, part.second));
        }
        if (c.facets.size() == 1 && lines.size() == 3 && c.lines.empty() && c.points.empty())
        {
            CutUp out;
            const std::uint32_t f = c.facets[0];
            std::array<std::uint32_t, 3> corners = set_.facets[f];
            for (std::uint32_t& v : corners) v = place_[v];
            out.facets.push_back({corners, set_.part[f], f - set_.first_facet[set_.part[f]]});
            return out;
        }
        for (const std::uint32_t p : c.lines)
            for_each_part(
                p, [&](std::uint32_t u, std::uint32_t v) { lines.push_back(std::minmax(u, v)); });
        return cut_up_cluster(set_, c, outlines, std::move(lines));
    }

    Arrangement cut_up()
    {
        std::vector<CutUp> cuts(clusters_.size());
        parallel_for(
            clusters_.size(), threads_, [&](std::size_t i) { cuts[i] = cut_up_one(clusters_[i]); },
            8);
        Arrangement out;
        out.crossing_pairs = crossing_pairs_;
        out.coplanar_pairs = coplanar_pairs_;
        DisjointSet joined(set_.vertices.size());
        for (std::uint32_t v = 0; v < place_.size(); ++v) joined.join(v, place_[v]);
        for (const CutUp& c : cuts)
        {
            for (const auto& [a, b] : c.joined) joined.join(a, b);
            out.lost_constraints += c.lost;
        }
        const auto add = [&](ArrangedFacet facet)
        {
            for (std::uint32_t& v : facet.corners) v = joined.find(v);
            const auto& [a, b, c] = facet.corners;
            if (a != b && b != c && c != a) out.facets.push_back(facet);
        };
        for (const CutUp& c : cuts)
            for (const ArrangedFacet& facet : c.facets) add(facet);
        for (std::uint32_t f = 0; f < set_.facets.size(); ++f)
            if (cluster_of_[f] == no_index)
                add({set_.facets[f], set_.part[f], f - set_.first_facet[set_.part[f]]});
        std::stable_sort(out.facets.begin(), out.facets.end(),
                         [](const ArrangedFacet& a, const ArrangedFacet& b)
                         { return Pair(a.part, a.facet) < Pair(b.part, b.facet); });
        out.vertices = std::move(set_.vertices);
        return out;
    }

    struct Seam
    {
        std::uint32_t f, g, u, v;
    };
    using Pair2 = std::pair<double, std::uint32_t>;

    double reach_;
    int threads_;
    MeshSet set_;
    DisjointSet facet_groups_;
    std::vector<std::vector<std::uint32_t>> on_side_; ///< per side, sorted along it
    std::vector<std::vector<std::uint32_t>> side_pieces_;
    std::vector<Pair> in_facet_; ///< facet, vertex
    std::vector<Seam> seams_;
    std::vector<char> is_touched_;
    std::vector<std::uint32_t> cluster_of_;
    std::vector<Cluster> clusters_;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> twin_;  ///< per piece the first one with its ends
    std::vector<std::uint32_t> place_; ///< per vertex the one that stands for it
    std::unordered_map<std::uint64_t, std::uint32_t> by_sides_;
    std::unordered_map<std::uint64_t, std::uint32_t> by_side_facet_;
    std::unordered_map<std::uint64_t, std::uint32_t> by_ends_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> of_facets_;
    std::uint64_t crossing_pairs_ = 0;
    std::uint64_t coplanar_pairs_ = 0;
};

} // namespace

Arrangement arrange(const std::vector<const SurfaceMesh*>& meshes, double merge_distance,
                    int threads)
{
    return Arranger(meshes, merge_distance, threads).run();
}

} // namespace fppg
