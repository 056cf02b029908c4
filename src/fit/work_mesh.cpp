#include "fit/work_mesh.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace fppg
{

namespace
{

constexpr std::size_t facets_per_task = 1024;

/// A facet while it is being cut.
struct Piece
{
    std::array<std::uint32_t, 3> vertices;
    std::array<char, 3> is_border; ///< per side: walks end there
    std::uint32_t parent;
};

/// One side of a piece, to be sorted so that the sides of one edge lie together.
struct PieceSide
{
    std::uint32_t low, high; ///< vertices
    std::uint32_t piece;
    std::uint32_t side;
    bool runs_up; ///< from low to high

    auto key() const { return std::tie(low, high, piece, side); }
};

PieceSide side_of(const Piece& piece, std::uint32_t index, std::uint32_t s)
{
    const auto a = piece.vertices[s];
    const auto b = piece.vertices[(s + 1) % 3];
    return {std::min(a, b), std::max(a, b), index, s, a < b};
}

class Cutter
{
public:
    Cutter(const SurfaceMesh& mesh, const Features& features, double longest)
        : vertices_(mesh.vertices), longest_squared_(longest * longest)
    {
        pieces_.reserve(mesh.facets.size());
        for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        {
            Piece piece{mesh.facets[f], {}, f};
            for (int s = 0; s < 3; ++s)
            {
                const auto side = static_cast<std::size_t>(s);
                const std::uint32_t edge = mesh.facet_edges[f][side];
                piece.is_border[side] = mesh.neighbours[f][side] == no_index ||
                                        features.is_feature_edge[edge] || !mesh.is_manifold[edge];
            }
            pieces_.push_back(piece);
        }
    }

    /// Halves once every piece with too long a side, and what must follow to keep sides whole.
    /// Returns whether there was anything to do.
    bool halve()
    {
        marked_.assign(pieces_.size(), {0, 0, 0});
        bool is_any = false;
        for (std::size_t i = 0; i < pieces_.size(); ++i)
            if (length_squared(pieces_[i], longest_side(pieces_[i])) > longest_squared_)
            {
                marked_[i][longest_side(pieces_[i])] = 1;
                is_any = true;
            }
        if (!is_any) return false;
        sort_sides();
        spread_marks();
        name_midpoints();
        cut_marked();
        return true;
    }

    WorkMesh finish(const SurfaceMesh& mesh)
    {
        std::stable_sort(pieces_.begin(), pieces_.end(),
                         [](const Piece& a, const Piece& b) { return a.parent < b.parent; });
        WorkMesh work;
        work.facets.reserve(pieces_.size());
        work.first_piece.assign(mesh.facets.size() + 1, 0);
        for (const Piece& piece : pieces_)
        {
            WorkFacet facet{};
            for (std::size_t k = 0; k < 3; ++k) facet.corners[k] = vertices_[piece.vertices[k]];
            facet.normal = mesh.normals[piece.parent];
            facet.neighbours = {no_index, no_index, no_index};
            facet.vertices = piece.vertices;
            facet.parent = piece.parent;
            work.facets.push_back(facet);
            ++work.first_piece[piece.parent + 1];
        }
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
            work.first_piece[f + 1] += work.first_piece[f];
        join_neighbours(work);
        return work;
    }

private:
    double length_squared(const Piece& piece, std::size_t s) const
    {
        const PieceSide side = side_of(piece, 0, static_cast<std::uint32_t>(s));
        const Vec3 d = vertices_[side.high] - vertices_[side.low];
        return dot(d, d);
    }

    /// Ties are broken by the vertices, so that both pieces at an edge judge it alike.
    std::size_t longest_side(const Piece& piece) const
    {
        std::size_t best = 0;
        for (std::size_t s = 1; s < 3; ++s)
        {
            const PieceSide a = side_of(piece, 0, static_cast<std::uint32_t>(s));
            const PieceSide b = side_of(piece, 0, static_cast<std::uint32_t>(best));
            if (std::make_tuple(length_squared(piece, s), a.low, a.high) >
                std::make_tuple(length_squared(piece, best), b.low, b.high))
                best = s;
        }
        return best;
    }

    void sort_sides()
    {
        sides_.clear();
        for (std::uint32_t i = 0; i < pieces_.size(); ++i)
            for (std::uint32_t s = 0; s < 3; ++s) sides_.push_back(side_of(pieces_[i], i, s));
        std::sort(sides_.begin(), sides_.end(),
                  [](const PieceSide& a, const PieceSide& b) { return a.key() < b.key(); });
    }

    /// A mark holds for all pieces at an edge; a piece with a mark is cut at its longest side too.
    void spread_marks()
    {
        std::vector<std::size_t> begins; // of the edges, in sides_
        edge_of_.resize(pieces_.size());
        for_each_edge(
            [&](std::size_t begin, std::size_t end)
            {
                for (std::size_t k = begin; k < end; ++k)
                    edge_of_[sides_[k].piece][sides_[k].side] =
                        static_cast<std::uint32_t>(begins.size());
                begins.push_back(begin);
            });
        begins.push_back(sides_.size());
        std::vector<char> is_marked(begins.size(), 0);
        std::vector<std::uint32_t> due;
        const auto mark = [&](std::uint32_t piece, std::size_t side)
        {
            marked_[piece][side] = 1;
            const std::uint32_t edge = edge_of_[piece][side];
            if (is_marked[edge] == 0) due.push_back(edge);
            is_marked[edge] = 1;
        };
        for (std::uint32_t i = 0; i < pieces_.size(); ++i)
            for (std::size_t s = 0; s < 3; ++s)
                if (marked_[i][s] != 0) mark(i, s);
        while (!due.empty())
        {
            const std::uint32_t edge = due.back();
            due.pop_back();
            for (std::size_t k = begins[edge]; k < begins[edge + 1]; ++k)
            {
                mark(sides_[k].piece, sides_[k].side);
                mark(sides_[k].piece, longest_side(pieces_[sides_[k].piece]));
            }
        }
    }

    void name_midpoints()
    {
        midpoints_.assign(pieces_.size(), {no_index, no_index, no_index});
        for_each_edge(
            [&](std::size_t begin, std::size_t end)
            {
                const PieceSide& first = sides_[begin];
                if (!marked_[first.piece][first.side]) return;
                const auto name = static_cast<std::uint32_t>(vertices_.size());
                vertices_.push_back(0.5 * (vertices_[first.low] + vertices_[first.high]));
                for (std::size_t k = begin; k < end; ++k)
                    midpoints_[sides_[k].piece][sides_[k].side] = name;
            });
    }

    void cut_marked()
    {
        std::vector<Piece> all;
        all.reserve(pieces_.size() * 2);
        for (std::size_t i = 0; i < pieces_.size(); ++i) cut(pieces_[i], midpoints_[i], all);
        pieces_ = std::move(all);
    }

    /// Cuts at the longest side first, then each half at its other marked side.
    void cut(const Piece& piece, const std::array<std::uint32_t, 3>& midpoints,
             std::vector<Piece>& out) const
    {
        const std::size_t s = longest_side(piece);
        if (midpoints[s] == no_index)
        {
            out.push_back(piece);
            return;
        }
        const std::size_t t = (s + 1) % 3;
        const std::size_t u = (s + 2) % 3;
        const std::uint32_t a = piece.vertices[s];
        const std::uint32_t b = piece.vertices[t];
        const std::uint32_t c = piece.vertices[u];
        const std::uint32_t m = midpoints[s];
        cut_half({b, c, m}, {piece.is_border[t], 0, piece.is_border[s]}, midpoints[t], piece.parent,
                 out);
        cut_half({c, a, m}, {piece.is_border[u], piece.is_border[s], 0}, midpoints[u], piece.parent,
                 out);
    }

    /// Only side 0 of the half can carry a midpoint.
    static void cut_half(const std::array<std::uint32_t, 3>& v, const std::array<char, 3>& border,
                         std::uint32_t midpoint, std::uint32_t parent, std::vector<Piece>& out)
    {
        if (midpoint == no_index)
        {
            out.push_back({v, border, parent});
            return;
        }
        out.push_back({{v[0], midpoint, v[2]}, {border[0], 0, border[2]}, parent});
        out.push_back({{midpoint, v[1], v[2]}, {border[0], border[1], 0}, parent});
    }

    void join_neighbours(WorkMesh& work)
    {
        sort_sides();
        for_each_edge(
            [&](std::size_t begin, std::size_t end)
            {
                if (end - begin != 2) return;
                const PieceSide& a = sides_[begin];
                const PieceSide& b = sides_[begin + 1];
                if (a.runs_up == b.runs_up || pieces_[a.piece].is_border[a.side] ||
                    pieces_[b.piece].is_border[b.side])
                    return;
                work.facets[a.piece].neighbours[a.side] = b.piece;
                work.facets[b.piece].neighbours[b.side] = a.piece;
            });
    }

    template <typename Body>
    void for_each_edge(const Body& body) const
    {
        for (std::size_t begin = 0; begin < sides_.size();)
        {
            std::size_t end = begin + 1;
            while (end < sides_.size() && sides_[end].low == sides_[begin].low &&
                   sides_[end].high == sides_[begin].high)
                ++end;
            body(begin, end);
            begin = end;
        }
    }

    std::vector<Vec3> vertices_;
    double longest_squared_;
    std::vector<Piece> pieces_;
    std::vector<PieceSide> sides_;
    std::vector<std::array<std::uint32_t, 3>> edge_of_;
    std::vector<std::array<char, 3>> marked_;
    std::vector<std::array<std::uint32_t, 3>> midpoints_;
};

bool has_side_longer(const SurfaceMesh& mesh, double longest)
{
    return std::any_of(mesh.edges.begin(), mesh.edges.end(),
                       [&](const std::array<std::uint32_t, 2>& edge)
                       {
                           const Vec3 d = mesh.vertices[edge[1]] - mesh.vertices[edge[0]];
                           return dot(d, d) > longest * longest;
                       });
}

/// Whether two facets at an edge look the same way: they run along it in opposite directions.
bool agree(const SurfaceMesh& mesh, std::uint32_t f, std::uint32_t g, std::uint32_t edge)
{
    const auto runs_up = [&](std::uint32_t facet)
    {
        std::size_t s = 0;
        while (s < 2 && mesh.facet_edges[facet][s] != edge) ++s;
        return mesh.facets[facet][s] == mesh.edges[edge][0];
    };
    return runs_up(f) != runs_up(g);
}

WorkMesh whole_facets(const SurfaceMesh& mesh, const Features& features, int threads)
{
    WorkMesh work;
    work.facets.resize(mesh.facets.size());
    work.first_piece.resize(mesh.facets.size() + 1);
    std::iota(work.first_piece.begin(), work.first_piece.end(), 0U);
    parallel_for(
        mesh.facets.size(), threads,
        [&](std::size_t f)
        {
            WorkFacet facet{};
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t edge = mesh.facet_edges[f][s];
                const std::uint32_t next = mesh.neighbours[f][s];
                facet.corners[s] = mesh.vertices[mesh.facets[f][s]];
                const bool is_border = next == no_index || features.is_feature_edge[edge] ||
                                       !mesh.is_manifold[edge] ||
                                       !agree(mesh, static_cast<std::uint32_t>(f), next, edge);
                facet.neighbours[s] = is_border ? no_index : next;
            }
            facet.normal = mesh.normals[f];
            facet.vertices = mesh.facets[f];
            facet.parent = static_cast<std::uint32_t>(f);
            work.facets[f] = facet;
        },
        facets_per_task);
    return work;
}

/// Slivers whose normal lies in their own plane get no neighbours.
void part_those_without_plane(RawArray<WorkFacet>& facets, int threads)
{
    constexpr double least_cosine = 0.02;
    parallel_for(
        facets.size(), threads,
        [&](std::size_t f)
        {
            const auto& c = facets[f].corners;
            const Vec3 own = cross(c[1] - c[0], c[2] - c[0]);
            facets[f].has_plane = dot(own, facets[f].normal) > least_cosine * norm(own);
        },
        facets_per_task);
    parallel_for(
        facets.size(), threads,
        [&](std::size_t f)
        {
            for (std::uint32_t& next : facets[f].neighbours)
                if (next != no_index && !(facets[f].has_plane && facets[next].has_plane))
                    next = no_index;
        },
        facets_per_task);
}

constexpr std::uint32_t box_fanout = 16;

std::vector<std::vector<Box3>> boxes_around(const RawArray<WorkFacet>& facets)
{
    const auto groups = [](std::size_t n) { return (n + box_fanout - 1) / box_fanout; };
    std::vector<std::vector<Box3>> levels;
    levels.emplace_back(groups(facets.size()));
    for (std::size_t f = 0; f < facets.size(); ++f)
        for (const Vec3& corner : facets[f].corners) levels[0][f / box_fanout].add(corner);
    while (levels.back().size() > box_fanout)
    {
        const std::vector<Box3>& fine = levels.back();
        std::vector<Box3> coarse(groups(fine.size()));
        for (std::size_t i = 0; i < fine.size(); ++i)
            for (const Vec3& corner : {fine[i].min, fine[i].max})
                coarse[i / box_fanout].add(corner);
        levels.push_back(std::move(coarse));
    }
    return levels;
}

/// The piece among those of a facet that holds a point best: the point is deepest between its
/// sides.
struct PieceSearch
{
    const WorkMesh& mesh;
    const Vec3& point;
    std::uint32_t begin, end;
    std::uint32_t best;
    double best_depth = -std::numeric_limits<double>::infinity();
    double margin = 0; ///< metres; what rounding may take

    void look_at(std::uint32_t piece)
    {
        const WorkFacet& facet = mesh.facets[piece];
        double depth = std::numeric_limits<double>::infinity();
        for (std::size_t s = 0; s < 3; ++s)
        {
            const Vec3 side = facet.corners[(s + 1) % 3] - facet.corners[s];
            const Vec3 inward = cross(facet.normal, side);
            depth = std::min(depth, dot(point - facet.corners[s], inward) / norm(side));
            if (depth <= best_depth) return;
        }
        best = piece;
        best_depth = depth;
    }

    void look_in_boxes()
    {
        constexpr double relative = 1e-12;
        margin =
            relative * (1 + std::max({std::fabs(point.x), std::fabs(point.y), std::fabs(point.z)}));
        const auto top = static_cast<std::uint32_t>(mesh.boxes.size());
        for (std::uint32_t i = 0; i < mesh.boxes.back().size(); ++i) look_below(top, i);
    }

    /// Level 0 is that of the pieces.
    void look_below(std::uint32_t level, std::uint32_t index)
    {
        const std::uint32_t bits = 4 * level;
        const std::uint64_t first = std::uint64_t{index} << bits;
        if (first >= end || first + (std::uint64_t{1} << bits) <= begin) return;
        if (level == 0)
        {
            look_at(index);
            return;
        }
        if (!mesh.boxes[level - 1][index].has(point, margin)) return;
        for (std::uint32_t i = 0; i < box_fanout; ++i)
            look_below(level - 1, box_fanout * index + i);
    }

    bool is_found() const { return best_depth >= -margin; }
};

} // namespace

std::uint32_t WorkMesh::locate(std::uint32_t parent, const Vec3& point) const
{
    const std::uint32_t begin = first_piece[parent];
    const std::uint32_t end = first_piece[parent + 1];
    PieceSearch search{*this, point, begin, end, begin};
    if (end - begin > box_fanout && !boxes.empty())
    {
        search.look_in_boxes();
        if (search.is_found()) return search.best;
    }
    for (std::uint32_t i = begin; i < end; ++i) search.look_at(i);
    return search.best;
}

double WorkMesh::area(std::uint32_t facet) const
{
    const auto& c = facets[facet].corners;
    return 0.5 * norm(cross(c[1] - c[0], c[2] - c[0]));
}

WorkMesh make_work_mesh(const SurfaceMesh& mesh, const Features& features, double longest,
                        int threads)
{
    WorkMesh work;
    if (has_side_longer(mesh, longest))
    {
        Cutter cutter(mesh, features, longest);
        while (cutter.halve())
        {
        }
        work = cutter.finish(mesh);
        work.boxes = boxes_around(work.facets);
    }
    else
        work = whole_facets(mesh, features, threads);
    part_those_without_plane(work.facets, threads);
    return work;
}

} // namespace fppg
