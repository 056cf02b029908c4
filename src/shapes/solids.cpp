#include "shapes/solids.h"

#include "shapes/planes.h"
#include "shapes/polygon_cut.h"
#include "shapes/polyhedra.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace fppg
{
namespace
{

using Triangles = std::vector<std::array<std::size_t, 3>>;

/// A convex part of a solid: nodes with a positive value in all planes, inside a box.
struct SolidPart
{
    std::vector<Plane> planes;
    NodeBox box;
};

/// A face of one part towards another, of which the nodes strictly inside all of `limits`, the ends
/// of its part, are drawn.
struct InnerFace
{
    std::vector<SnappedTriangle> triangles;
    std::vector<Plane> limits;
    std::size_t owner = 0; ///< the part that it belongs to
};

/// GenCase draws such a face within no limits: a solid prism of four corners or more of which a
/// dividing face shrinks to one node has this node (12 prisms of v5.4.354).
bool is_one_node(const InnerFace& face)
{
    return std::all_of(face.triangles.begin(), face.triangles.end(),
                       [&](const SnappedTriangle& t)
                       { return t.a == t.b && t.b == t.c && t.a == face.triangles[0].a; });
}

class SolidCutter
{
public:
    SolidCutter(const PolyhedronOp& polyhedron, const LatticeGrid& grid) : grid_(grid)
    {
        for (const std::uint32_t v : polyhedron.solid_vertices)
            nodes_.push_back(snap(polyhedron.vertices[v], grid));
        if (polyhedron.solid == SolidKind::Prism || polyhedron.solid == SolidKind::Box)
            cut_prism(polyhedron);
        if (polyhedron.solid == SolidKind::Pyramid && polyhedron.faces[0].cut.empty())
            take_pyramid();
        if (polyhedron.solid == SolidKind::Pyramid && !polyhedron.faces[0].cut.empty())
            cut_pyramid(polyhedron);
        if (polyhedron.solid == SolidKind::Faces) take_faces(polyhedron);
    }

    std::vector<SolidPart> parts;
    std::vector<InnerFace> inner_faces;

private:
    Plane plane(const Node& a, const Node& b, const Node& c) const
    {
        return plane_through(position(a, grid_), position(b, grid_), position(c, grid_));
    }

    /// In the box of all corners, as a side that is not flat on the lattice may lie beyond those of
    /// its part.
    void add_part(std::vector<Plane> planes)
    {
        SolidPart part;
        part.planes = std::move(planes);
        part.box = {{INT64_MAX, INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN, INT64_MIN}};
        for (const Node& n : nodes_)
            for (int axis = 0; axis < 3; ++axis)
            {
                const auto k = static_cast<std::size_t>(axis);
                part.box.begin[k] = std::min(part.box.begin[k], n[axis]);
                part.box.end[k] = std::max(part.box.end[k], n[axis] + 1);
            }
        part.box = intersect(part.box, whole_lattice(grid_));
        parts.push_back(std::move(part));
    }

    void cut_prism(const PolyhedronOp& polyhedron)
    {
        const std::size_t n = nodes_.size() / 2;
        const Triangles cut = polyhedron.solid == SolidKind::Box ? Triangles{{3, 0, 1}, {1, 2, 3}}
                                                                 : bottom_triangles(polyhedron);
        std::vector<std::vector<Plane>> ends;
        for (const auto& t : cut)
        {
            std::array<Node, 3> p;
            std::array<Node, 3> q;
            for (std::size_t i = 0; i < 3; ++i)
            {
                p[i] = nodes_[t[i]];
                q[i] = nodes_[n + t[i]];
            }
            std::vector<Plane> planes{plane(p[0], p[1], p[2]), plane(q[0], q[2], q[1])};
            ends.push_back(planes);
            for (std::size_t i = 0; i < 3; ++i) planes.push_back(plane(p[(i + 1) % 3], p[i], q[i]));
            add_part(std::move(planes));
        }
        // Each of two neighbours cuts the quad between them by its own diagonal.
        for_each_part_and_side(
            cut, [](std::size_t) {},
            [&](std::size_t t, std::size_t i, std::size_t j)
            {
                const Node& a = nodes_[i];
                const Node& b = nodes_[j];
                const Node& b_top = nodes_[n + j];
                const Node& a_top = nodes_[n + i];
                inner_faces.push_back({{{b, b_top, a_top}, {b, a_top, a}}, ends[t], t});
            });
    }

    /// Over a base that is not flat as drawn. The face looks down.
    void cut_pyramid(const PolyhedronOp& polyhedron)
    {
        const Node& apex = nodes_[0];
        Triangles cut;
        for (const auto& t : polyhedron.faces[0].triangles) cut.push_back({t[0], t[2], t[1]});
        for (const auto& t : cut)
        {
            const std::array<Node, 3> b{nodes_[t[0]], nodes_[t[1]], nodes_[t[2]]};
            std::vector<Plane> planes{plane(b[0], b[1], b[2])};
            // The corners in this order decide on nodes in a side.
            for (std::size_t i = 0; i < 3; ++i) planes.push_back(plane(b[(i + 1) % 3], b[i], apex));
            add_part(std::move(planes));
        }
        for_each_part_and_side(
            cut, [](std::size_t) {},
            [&](std::size_t t, std::size_t i, std::size_t j) {
                inner_faces.push_back({{{apex, nodes_[i], nodes_[j]}}, {parts[t].planes[0]}, t});
            });
    }

    /// One part, by the first three corners of the base even where snapped ones are not in a plane.
    void take_pyramid()
    {
        const std::size_t n = nodes_.size() - 1;
        const Node& apex = nodes_[0];
        std::vector<Plane> planes{plane(nodes_[1], nodes_[2], nodes_[3])};
        for (std::size_t i = 0; i < n; ++i)
            planes.push_back(plane(apex, nodes_[1 + (i + 1) % n], nodes_[1 + i]));
        add_part(std::move(planes));
    }

    void take_faces(const PolyhedronOp& polyhedron)
    {
        std::vector<Plane> planes;
        for (const SnappedTriangle& t : snapped_triangles(polyhedron, grid_, false))
            planes.push_back(plane(t.a, t.c, t.b));
        for (const Vec3& v : polyhedron.vertices) nodes_.push_back(snap(v, grid_));
        add_part(std::move(planes));
    }

    LatticeGrid grid_;
    std::vector<Node> nodes_; ///< snapped corners
};

void emit_part(const SolidPart& part, const LatticeGrid& grid, std::uint32_t slab, Spans& out)
{
    const double x = grid.origin.x + static_cast<double>(slab) * grid.step(0);
    for (std::int64_t iy = part.box.begin[1]; iy < part.box.end[1]; ++iy)
    {
        const double y = grid.origin.y + static_cast<double>(iy) * grid.step(1);
        double lo = static_cast<double>(part.box.begin[2]);
        double hi = static_cast<double>(part.box.end[2] - 1);
        for (const Plane& p : part.planes)
            narrow(lo, hi, p.value({x, y, grid.origin.z}), p.normal.z * grid.step(2), 0,
                   noise_of(p, grid.dp));
        std::int64_t first = 0;
        std::int64_t last = 0;
        if (!to_index_range(lo, hi, part.box.begin[2], part.box.end[2] - 1, first, last)) continue;
        const auto is_inside = [&](std::int64_t k)
        {
            const Vec3 p{x, y, grid.origin.z + static_cast<double>(k) * grid.step(2)};
            return std::all_of(part.planes.begin(), part.planes.end(),
                               [&](const Plane& plane) { return plane.value(p) > 0; });
        };
        if (trim_interval(first, last, part.box.begin[2], part.box.end[2] - 1, is_inside))
            out.push_back({static_cast<std::uint32_t>(iy), static_cast<std::uint32_t>(first),
                           static_cast<std::uint32_t>(last) + 1});
    }
}

/// Shortens a span to its nodes strictly on the inner side of a plane. The plane's values are
/// monotone along a column, in double too, so that one end stays and the other is found by
/// bisection.
void keep_inner(const Plane& limit, double x, const LatticeGrid& grid, Span& s)
{
    if (s.z_begin >= s.z_end) return;
    const auto is_inner = [&](std::uint32_t z)
    {
        return limit.value(
                   {x, grid.origin.y + s.y * grid.step(1), grid.origin.z + z * grid.step(2)}) > 0;
    };
    const bool low = is_inner(s.z_begin);
    const bool high = is_inner(s.z_end - 1);
    if (low && high) return;
    if (!low && !high)
    {
        s.z_end = s.z_begin;
        return;
    }
    std::uint32_t inside = low ? s.z_begin : s.z_end - 1;
    std::uint32_t outside = low ? s.z_end - 1 : s.z_begin;
    while (std::max(inside, outside) - std::min(inside, outside) > 1)
    {
        const std::uint32_t middle = std::midpoint(inside, outside);
        is_inner(middle) ? inside = middle : outside = middle;
    }
    if (low)
        s.z_end = inside + 1;
    else
        s.z_begin = inside;
}

SlabRegion inside_of(const std::shared_ptr<const SolidCutter>& cutter, std::size_t p,
                     const LatticeGrid& grid)
{
    const NodeBox& box = cutter->parts[p].box;
    if (box.is_empty()) return {};
    SlabRegion inside;
    inside.x_begin = static_cast<std::uint32_t>(box.begin[0]);
    inside.x_end = static_cast<std::uint32_t>(box.end[0]);
    inside.emit = [cutter, p, grid](std::uint32_t slab, Spans& out)
    { emit_part(cutter->parts[p], grid, slab, out); };
    return inside;
}

/// All of several regions.
SlabRegion join(std::vector<SlabRegion> regions)
{
    const auto parts = std::make_shared<const std::vector<SlabRegion>>(std::move(regions));
    SlabRegion region;
    region.x_begin = UINT32_MAX;
    for (const SlabRegion& part : *parts)
    {
        if (part.x_end <= part.x_begin) continue;
        region.x_begin = std::min(region.x_begin, part.x_begin);
        region.x_end = std::max(region.x_end, part.x_end);
    }
    if (region.x_end <= region.x_begin) return {};
    region.emit = [parts](std::uint32_t slab, Spans& out)
    {
        for (const SlabRegion& part : *parts)
            if (slab >= part.x_begin && slab < part.x_end) part.emit(slab, out);
    };
    return region;
}

} // namespace

std::vector<SlabRegion> solid_parts(const PolyhedronOp& polyhedron, const LatticeGrid& grid,
                                    double weight_dp, double limits_dp)
{
    const auto cutter = std::make_shared<const SolidCutter>(polyhedron, grid);
    const bool are_apart = polyhedron.solid != SolidKind::Pyramid;
    std::vector<SlabRegion> regions;
    std::vector<SlabRegion> faces; // of the part before, that go with this one
    for (std::size_t p = 0; p < cutter->parts.size(); ++p)
    {
        faces.push_back(inside_of(cutter, p, grid));
        regions.push_back(join(std::move(faces)));
        faces.clear();
        for (std::size_t f = 0; f < cutter->inner_faces.size(); ++f)
        {
            if (cutter->inner_faces[f].owner != p) continue;
            SlabRegion face =
                triangles_region(cutter->inner_faces[f].triangles, grid, weight_dp, limits_dp);
            if (is_one_node(cutter->inner_faces[f]))
            {
                regions.push_back(std::move(face));
                continue;
            }
            face.emit = [cutter, f, grid, all = face.emit](std::uint32_t slab, Spans& out)
            {
                const double x = grid.origin.x + static_cast<double>(slab) * grid.step(0);
                Spans nodes;
                all(slab, nodes);
                for (Span s : nodes)
                {
                    for (const Plane& limit : cutter->inner_faces[f].limits)
                        keep_inner(limit, x, grid, s);
                    if (s.z_begin < s.z_end) out.push_back(s);
                }
            };
            (are_apart ? regions : faces).push_back(std::move(face));
        }
    }
    if (!faces.empty()) regions.push_back(join(std::move(faces)));
    return regions;
}

SlabRegion solid_region(const PolyhedronOp& polyhedron, const LatticeGrid& grid, double weight_dp,
                        double limits_dp)
{
    return join(solid_parts(polyhedron, grid, weight_dp, limits_dp));
}

} // namespace fppg
