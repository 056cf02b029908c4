#include "boolean/cluster_cut.h"

#include "boolean/plane_cut_up.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace fppg
{
namespace
{

template <typename T>
void sort_and_drop_copies(std::vector<T>& values)
{
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

class ClusterCut
{
public:
    ClusterCut(const MeshSet& set, const Cluster& cluster,
               const std::vector<std::vector<Pair>>& outlines, std::vector<Pair> lines)
        : set_(set),
          cluster_(cluster),
          outlines_(outlines),
          lines_(std::move(lines)),
          used_(vertices_of(cluster, lines_)),
          cut_(places())
    {
    }

    CutUp run()
    {
        for (std::uint32_t i = 0; i < used_.size(); ++i)
            if (cut_.place_of(i) != i) out_.joined.emplace_back(used_[i], used_[cut_.place_of(i)]);
        // Outlines first: they keep neighbours side to side.
        for (const std::vector<Pair>& outline : outlines_)
            for (const Pair& part : outline) add_line(part);
        for (const Pair& line : lines_) add_line(line);
        list_sides();
        mark_.assign(cut_.triangles().size(), no_index);
        for (std::uint32_t m = 0; m < cluster_.facets.size(); ++m) take_triangles_of(m);
        return std::move(out_);
    }

private:
    /// The vertices in use, sorted; drops copies of lines.
    static std::vector<std::uint32_t> vertices_of(const Cluster& cluster, std::vector<Pair>& lines)
    {
        sort_and_drop_copies(lines);
        std::vector<std::uint32_t> used = cluster.points;
        for (const auto& [u, v] : lines)
        {
            used.push_back(u);
            used.push_back(v);
        }
        sort_and_drop_copies(used);
        return used;
    }

    std::vector<PlanePoint> places() const
    {
        std::vector<PlanePoint> out;
        for (const std::uint32_t v : used_)
            out.push_back({set_.vertices[v][cluster_.axis_u], set_.vertices[v][cluster_.axis_v]});
        return out;
    }

    std::uint32_t local(std::uint32_t v) const
    {
        return static_cast<std::uint32_t>(std::lower_bound(used_.begin(), used_.end(), v) -
                                          used_.begin());
    }

    void add_line(const Pair& line)
    {
        out_.lost += cut_.add_constraint(local(line.first), local(line.second)) ? 0U : 1U;
    }

    void list_sides()
    {
        const auto& triangles = cut_.triangles();
        sides_.reserve(3 * triangles.size());
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            for (std::size_t s = 0; s < 3; ++s)
                sides_.push_back({{triangles[t].corners[s], triangles[t].corners[(s + 1) % 3]}, t});
        std::sort(sides_.begin(), sides_.end());
    }

    std::uint32_t triangle_at(std::uint32_t a, std::uint32_t b) const
    {
        const auto at = std::lower_bound(sides_.begin(), sides_.end(),
                                         std::pair<Pair, std::uint32_t>({a, b}, 0));
        return at != sides_.end() && at->first == Pair(a, b) ? at->second : no_index;
    }

    bool is_outside(std::uint32_t triangle) const
    {
        const auto& corners = cut_.triangles()[triangle].corners;
        return std::any_of(corners.begin(), corners.end(),
                           [&](std::uint32_t v) { return v >= cut_.first_outer(); });
    }

    /// The triangles of a member of the cluster: a flood from its outline inwards.
    void take_triangles_of(std::uint32_t m)
    {
        const std::uint32_t f = cluster_.facets[m];
        const auto corners = set_.corners(f);
        const Vec3 n = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const bool is_turned = n[3 - cluster_.axis_u - cluster_.axis_v] < 0;
        std::vector<Pair> outline;
        for (const auto& [u, v] : outlines_[m])
        {
            const std::uint32_t a = cut_.place_of(local(u)), b = cut_.place_of(local(v));
            if (a != b) outline.emplace_back(a, b);
        }
        std::vector<Pair> limits = outline; // sides that the flood does not pass, both ways
        for (const auto& [a, b] : outline) limits.emplace_back(b, a);
        std::sort(limits.begin(), limits.end());
        std::vector<std::uint32_t> stack;
        const auto visit = [&](std::uint32_t t)
        {
            if (t == no_index || mark_[t] == m) return;
            mark_[t] = m;
            stack.push_back(t);
        };
        for (const auto& [a, b] : outline) visit(is_turned ? triangle_at(b, a) : triangle_at(a, b));
        while (!stack.empty())
        {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            if (is_outside(t))
            {
                ++out_.lost; // the outline has a gap
                continue;
            }
            const auto& triangle = cut_.triangles()[t];
            ArrangedFacet piece;
            piece.part = set_.part[f];
            piece.facet = f - set_.first_facet[piece.part];
            for (std::size_t k = 0; k < 3; ++k)
                piece.corners[is_turned ? 2 - k : k] = used_[triangle.corners[k]];
            out_.facets.push_back(piece);
            for (std::size_t s = 0; s < 3; ++s)
            {
                const Pair side(triangle.corners[s], triangle.corners[(s + 1) % 3]);
                if (triangle.neighbours[s] != no_index &&
                    !std::binary_search(limits.begin(), limits.end(), side))
                    visit(triangle.neighbours[s]);
            }
        }
    }

    const MeshSet& set_;
    const Cluster& cluster_;
    const std::vector<std::vector<Pair>>& outlines_;
    std::vector<Pair> lines_;
    std::vector<std::uint32_t> used_;
    PlaneTriangulation cut_;
    std::vector<std::pair<Pair, std::uint32_t>> sides_; ///< sorted, with their triangle
    std::vector<std::uint32_t> mark_; ///< per triangle the last member that took it
    CutUp out_;
};

} // namespace

CutUp cut_up_cluster(const MeshSet& set, const Cluster& cluster,
                     const std::vector<std::vector<Pair>>& outlines, std::vector<Pair> lines)
{
    return ClusterCut(set, cluster, outlines, std::move(lines)).run();
}

} // namespace fppg
