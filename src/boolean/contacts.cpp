#include "boolean/contacts.h"

#include "core/parallel.h"
#include "core/predicates.h"
#include "meshes/box_tree.h"
#include "meshes/point_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fppg
{
namespace
{

Box3 box_around(const std::array<Vec3, 3>& corners, double reach)
{
    Box3 box;
    for (const Vec3& p : corners) box.add(p);
    const Vec3 r{reach, reach, reach};
    box.min = box.min - r;
    box.max = box.max + r;
    return box;
}

/// Where a vertex lies on a facet.
struct Place
{
    enum Kind
    {
        Off,
        Corner,
        Side,
        Inside,
    } kind = Off;
    std::uint32_t side = no_index;
};

/// Tells where two facets meet. Every answer about a vertex and a side, two sides, or a side and a
/// facet depends on these alone, so that all facets that share them agree.
class PairTest
{
public:
    PairTest(const MeshSet& set, double reach) : set_(set), reach_(reach) {}

    FacetContacts run(std::uint32_t f, std::uint32_t g)
    {
        FacetContacts out;
        out.f = f;
        out.g = g;
        if (is_apart(f, g) || is_apart(g, f)) return out;
        found_.clear();
        add_corners(f, g);
        add_corners(g, f);
        for (const std::uint32_t e : set_.facet_sides[f])
            for (const std::uint32_t h : set_.facet_sides[g])
                add_sides(std::min(e, h), std::max(e, h));
        for (const std::uint32_t e : set_.facet_sides[f]) add_side_facet(e, g);
        for (const std::uint32_t e : set_.facet_sides[g]) add_side_facet(e, f);
        order(out);
        return out;
    }

private:
    const Vec3& at(std::uint32_t v) const { return set_.vertices[v]; }

    /// Whether all corners of g lie clearly on one side of the plane of f.
    bool is_apart(std::uint32_t f, std::uint32_t g) const
    {
        const auto c = set_.corners(f);
        const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
        const double length = norm(n);
        if (!(length > 0)) return false;
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (const std::uint32_t v : set_.facets[g])
        {
            const double d = dot(at(v) - c[0], n) / length;
            low = std::min(low, d);
            high = std::max(high, d);
        }
        return low > 2 * reach_ || high < -2 * reach_;
    }

    bool is_on_side(std::uint32_t v, std::uint32_t e) const
    {
        const auto [p, q] = set_.sides[e];
        if (v == p || v == q) return false;
        const Vec3 along = at(q) - at(p);
        const double length2 = squared(along);
        if (!(length2 > 0)) return false;
        const double t = dot(at(v) - at(p), along) / length2;
        if (!(t > 0 && t < 1)) return false;
        return squared(at(p) + t * along - at(v)) < reach_ * reach_;
    }

    Place place_of(std::uint32_t v, std::uint32_t f) const
    {
        for (const std::uint32_t c : set_.facets[f])
            if (c == v) return {Place::Corner, no_index};
        for (const std::uint32_t e : set_.facet_sides[f])
            if (is_on_side(v, e)) return {Place::Side, e};
        const auto c = set_.corners(f);
        const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
        const double length = norm(n);
        if (!(length > 0) || std::abs(dot(at(v) - c[0], n)) >= reach_ * length) return {};
        for (std::size_t s = 0; s < 3; ++s)
            if (!(dot(cross(c[(s + 1) % 3] - c[s], at(v) - c[s]), n) > 0)) return {};
        return {Place::Inside, no_index};
    }

    bool has(Contact::Kind kind, std::uint32_t first, std::uint32_t second) const
    {
        return std::any_of(found_.begin(), found_.end(),
                           [&](const Contact& c)
                           { return c.kind == kind && c.first == first && c.second == second; });
    }

    void add_corners(std::uint32_t f, std::uint32_t g)
    {
        for (const std::uint32_t v : set_.facets[g])
        {
            const Place place = place_of(v, f);
            if (place.kind == Place::Off || has(Contact::Kind::Vertex, v, no_index)) continue;
            Contact c;
            c.first = v;
            c.position = at(v);
            c.on_sides[0] = place.side;
            if (place.kind == Place::Inside) c.in_facet = f;
            found_.push_back(c);
        }
    }

    void add_sides(std::uint32_t e, std::uint32_t h)
    {
        const auto [p, q] = set_.sides[e];
        const auto [r, s] = set_.sides[h];
        if (p == r || p == s || q == r || q == s) return;
        if (is_on_side(p, h) || is_on_side(q, h) || is_on_side(r, e) || is_on_side(s, e)) return;
        const Vec3 u = at(q) - at(p);
        const Vec3 v = at(s) - at(r);
        const Vec3 w = at(r) - at(p);
        const double a = squared(u), b = dot(u, v), c = squared(v);
        const double det = a * c - b * b;
        if (!(det > 1e-20 * a * c)) return;
        const double t = (dot(w, u) * c - dot(w, v) * b) / det;
        const double k = (dot(w, u) * b - dot(w, v) * a) / det;
        if (!(t > 0 && t < 1 && k > 0 && k < 1)) return;
        const Vec3 on_e = at(p) + t * u;
        if (!(squared(at(r) + k * v - on_e) < reach_ * reach_)) return;
        Contact found;
        found.kind = Contact::Kind::Sides;
        found.first = e;
        found.second = h;
        found.position = on_e;
        found.on_sides = {e, h};
        found_.push_back(found);
    }

    void add_side_facet(std::uint32_t e, std::uint32_t f)
    {
        const auto [p, q] = set_.sides[e];
        for (const Contact& c : found_)
        {
            if (c.kind == Contact::Kind::Vertex && (c.first == p || c.first == q)) return;
            if (c.on_sides[0] == e || c.on_sides[1] == e) return;
        }
        const auto c = set_.corners(f);
        const int side_p = orient3d(c[0], c[1], c[2], at(p));
        const int side_q = orient3d(c[0], c[1], c[2], at(q));
        if (side_p * side_q >= 0) return;
        int turns = 0;
        for (std::size_t k = 0; k < 3; ++k) turns += orient3d(at(p), at(q), c[k], c[(k + 1) % 3]);
        if (turns != 3 && turns != -3) return;
        const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
        const double dp = std::abs(dot(at(p) - c[0], n));
        const double dq = std::abs(dot(at(q) - c[0], n));
        Contact found;
        found.kind = Contact::Kind::SideFacet;
        found.first = e;
        found.second = f;
        found.position = at(p) + (dp + dq > 0 ? dp / (dp + dq) : 0.5) * (at(q) - at(p));
        found.on_sides[0] = e;
        found.in_facet = f;
        found_.push_back(found);
    }

    /// Contacts on one line are put in order along it; others share an area.
    void order(FacetContacts& out)
    {
        out.contacts = found_;
        if (found_.size() < 2) return;
        std::size_t first = 0, last = 1;
        double longest = -1;
        for (std::size_t i = 0; i < found_.size(); ++i)
            for (std::size_t j = i + 1; j < found_.size(); ++j)
            {
                const double length = squared(found_[j].position - found_[i].position);
                if (length <= longest) continue;
                longest = length;
                first = i;
                last = j;
            }
        const Vec3 from = found_[first].position;
        const Vec3 along = found_[last].position - from;
        std::vector<std::pair<double, std::size_t>> by_way;
        for (std::size_t i = 0; i < found_.size(); ++i)
        {
            const Vec3 away = found_[i].position - from;
            const double t = longest > 0 ? dot(away, along) / longest : 0;
            if (squared(away - t * along) > 16 * reach_ * reach_) out.is_coplanar = true;
            by_way.emplace_back(i == first ? -1.0 : i == last ? 2.0 : t, i);
        }
        std::sort(by_way.begin(), by_way.end());
        for (std::size_t i = 0; i < by_way.size(); ++i) out.contacts[i] = found_[by_way[i].second];
    }

    const MeshSet& set_;
    double reach_;
    std::vector<Contact> found_;
};

} // namespace

MeshSet join_meshes(const std::vector<const SurfaceMesh*>& meshes, double merge_distance)
{
    MeshSet set;
    std::vector<std::uint32_t> part_of_vertex;
    std::vector<Box3> boxes(meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (const Vec3& v : meshes[m]->vertices) boxes[m].add(v);
    // Only vertices inside the box of another mesh can have one to join.
    const auto may_join = [&](std::size_t m, const Vec3& p)
    {
        for (std::size_t other = 0; other < boxes.size(); ++other)
        {
            if (other == m) continue;
            bool is_in = true;
            for (int axis = 0; axis < 3; ++axis)
                is_in = is_in && p[axis] >= boxes[other].min[axis] - 2 * merge_distance &&
                        p[axis] <= boxes[other].max[axis] + 2 * merge_distance;
            if (is_in) return true;
        }
        return false;
    };
    PointGrid grid(8 * merge_distance, 1024);
    std::vector<std::uint32_t> vertex_of_point;
    for (std::size_t m = 0; m < meshes.size(); ++m)
    {
        const SurfaceMesh& mesh = *meshes[m];
        const auto first_side = static_cast<std::uint32_t>(set.sides.size());
        std::vector<std::uint32_t> index(mesh.vertices.size());
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        {
            const Vec3& p = mesh.vertices[v];
            std::uint32_t joined = no_index;
            const bool is_candidate = may_join(m, p);
            if (is_candidate)
            {
                double nearest = std::numeric_limits<double>::infinity();
                grid.for_each_near(p, merge_distance,
                                   [&](std::uint32_t i, double d)
                                   {
                                       const std::uint32_t w = vertex_of_point[i];
                                       if (part_of_vertex[w] == m || d > nearest) return;
                                       if (d == nearest && w > joined) return;
                                       nearest = d;
                                       joined = w;
                                   });
            }
            if (joined == no_index)
            {
                joined = static_cast<std::uint32_t>(set.vertices.size());
                set.vertices.push_back(p);
                part_of_vertex.push_back(static_cast<std::uint32_t>(m));
                if (is_candidate)
                {
                    grid.add(p);
                    vertex_of_point.push_back(joined);
                }
            }
            index[v] = joined;
        }
        for (const auto& e : mesh.edges) set.sides.push_back({index[e[0]], index[e[1]]});
        set.first_facet.push_back(static_cast<std::uint32_t>(set.facets.size()));
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        {
            const auto& c = mesh.facets[f];
            const auto& s = mesh.facet_edges[f];
            set.facets.push_back({index[c[0]], index[c[1]], index[c[2]]});
            set.facet_sides.push_back({s[0] + first_side, s[1] + first_side, s[2] + first_side});
            set.part.push_back(static_cast<std::uint32_t>(m));
        }
    }
    set.first_facet.push_back(static_cast<std::uint32_t>(set.facets.size()));
    return set;
}

std::vector<FacetContacts> find_contacts(const MeshSet& set, double merge_distance, int threads)
{
    const std::size_t meshes = set.first_facet.size() - 1;
    std::vector<Box3> boxes(meshes);
    for (std::size_t m = 0; m < meshes; ++m)
        for (std::uint32_t f = set.first_facet[m]; f < set.first_facet[m + 1]; ++f)
            for (const std::uint32_t v : set.facets[f]) boxes[m].add(set.vertices[v]);
    const double reach = 2 * merge_distance;
    const auto overlap = [reach](const Box3& a, const Box3& b)
    {
        for (int axis = 0; axis < 3; ++axis)
            if (a.min[axis] > b.max[axis] + reach || b.min[axis] > a.max[axis] + reach)
                return false;
        return true;
    };
    // Per facet the ones of later meshes that it meets.
    std::vector<std::vector<FacetContacts>> of_facet(set.facets.size());
    for (std::size_t n = 1; n < meshes; ++n)
    {
        Box3 earlier;
        for (std::size_t m = 0; m < n; ++m)
            if (overlap(boxes[m], boxes[n]))
            {
                earlier.add(boxes[m].min);
                earlier.add(boxes[m].max);
            }
        if (earlier.is_empty()) continue;
        std::vector<Box3> near;
        std::vector<std::uint32_t> facets;
        for (std::uint32_t g = set.first_facet[n]; g < set.first_facet[n + 1]; ++g)
        {
            const Box3 box = box_around(set.corners(g), reach);
            if (!overlap(box, earlier)) continue;
            near.push_back(box);
            facets.push_back(g);
        }
        if (facets.empty()) continue;
        const BoxTree tree(near, threads);
        parallel_for(
            set.first_facet[n], threads,
            [&](std::size_t i)
            {
                const auto f = static_cast<std::uint32_t>(i);
                const Box3 box = box_around(set.corners(f), reach);
                if (!overlap(box, boxes[n])) return;
                std::vector<std::uint32_t> candidates;
                tree.for_each_overlap(box,
                                      [&](std::uint32_t k) { candidates.push_back(facets[k]); });
                std::sort(candidates.begin(), candidates.end());
                PairTest test(set, merge_distance);
                for (const std::uint32_t g : candidates)
                {
                    FacetContacts found = test.run(f, g);
                    if (!found.contacts.empty()) of_facet[f].push_back(std::move(found));
                }
            },
            256);
    }
    std::vector<FacetContacts> all;
    for (auto& list : of_facet)
        for (FacetContacts& c : list) all.push_back(std::move(c));
    return all;
}

} // namespace fppg
