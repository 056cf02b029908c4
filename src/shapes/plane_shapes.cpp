#include "shapes/plane_shapes.h"

#include "shapes/planes.h"
#include "shapes/polyhedra.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

namespace fppg
{
namespace
{

/// Lists, for every slab in a range, the items that reach into it.
class SlabIndex
{
public:
    template <typename Range>
    SlabIndex(std::size_t items, std::int64_t n_x, const Range& range_of)
    {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(items);
        std::int64_t first = n_x;
        std::int64_t last = 0;
        for (std::size_t i = 0; i < items; ++i)
        {
            const auto [begin, end] = range_of(i);
            if (begin >= end) continue;
            first = std::min(first, begin);
            last = std::max(last, end);
            ranges[i] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
        }
        if (first >= last) return;
        x_begin_ = first;
        x_end_ = last;
        const auto slab_of = [this](std::uint32_t x)
        { return static_cast<std::size_t>(x - x_begin()); };
        starts_.assign(static_cast<std::size_t>(last - first) + 1, 0);
        for (const auto& [begin, end] : ranges)
            for (std::uint32_t x = begin; x < end; ++x) ++starts_[slab_of(x) + 1];
        for (std::size_t k = 1; k < starts_.size(); ++k) starts_[k] += starts_[k - 1];
        items_.resize(starts_.back());
        std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
        for (std::size_t i = 0; i < items; ++i)
            for (std::uint32_t x = ranges[i].first; x < ranges[i].second; ++x)
                items_[next[slab_of(x)]++] = static_cast<std::uint32_t>(i);
    }

    std::uint32_t x_begin() const { return static_cast<std::uint32_t>(x_begin_); }
    std::uint32_t x_end() const { return static_cast<std::uint32_t>(x_end_); }

    template <typename Body>
    void for_each(std::uint32_t x, const Body& body) const
    {
        const auto slab = static_cast<std::size_t>(x - x_begin());
        for (std::size_t k = starts_[slab]; k < starts_[slab + 1]; ++k) body(items_[k]);
    }

private:
    std::int64_t x_begin_ = 0;
    std::int64_t x_end_ = 0;
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> items_;
};

NodeBox box_of(const Node& a, const Node& b, const LatticeGrid& grid)
{
    NodeBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        box.begin[k] = std::min(a[axis], b[axis]);
        box.end[k] = std::max(a[axis], b[axis]) + 1;
    }
    return intersect(box, whole_lattice(grid));
}

NodeBox box_of(const SnappedTriangle& t, const LatticeGrid& grid)
{
    NodeBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto k = static_cast<std::size_t>(axis);
        box.begin[k] = std::min({t.a[axis], t.b[axis], t.c[axis]});
        box.end[k] = std::max({t.a[axis], t.b[axis], t.c[axis]}) + 1;
    }
    return intersect(box, whole_lattice(grid));
}

Span one_node(std::int64_t y, std::int64_t z)
{
    return {static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z),
            static_cast<std::uint32_t>(z) + 1};
}

/// A snapped triangle made ready for tests of nodes.
///
/// The arithmetic is GenCase's, found by experiment with v5.4.354 (2592 random triangles, two
/// thirds of them with nodes exactly at the limit, no node different): the distance from the plane
/// is the plane's value over the length of its normal; beyond the edges three planes across the
/// triangle, moved outwards by the limit, refuse what is not strictly behind them. Corners in one
/// line have the planes that rounding leaves them: of half of such triangles nothing is drawn, of
/// others nodes along the line (GenCase v5.4.354: 720 triangles, 360 of them in 2D, none
/// different).
class TriangleTest
{
public:
    TriangleTest(const SnappedTriangle& t, const LatticeGrid& grid, double weight_dp,
                 double limits_dp)
        : grid_(grid), box_(box_of(t, grid)), weight_(weight_dp * grid.dp)
    {
        is_node_ = t.a == t.b && t.b == t.c;
        const Vec3 a = position(t.a, grid);
        const Vec3 b = position(t.b, grid);
        const Vec3 c = position(t.c, grid);
        plane_ = plane_through(a, b, c);
        length_ = norm(plane_.normal);
        const Vec3 up = cross(b - a, c - b);
        const double limits = limits_dp * grid.dp;
        const std::array<std::array<Vec3, 3>, 3> edges{{{a, b, a}, {b, c, b}, {c, a, a}}};
        for (std::size_t e = 0; e < 3; ++e)
        {
            const auto& [p, q, base] = edges[e];
            const Vec3 above = base + up;
            const Vec3 outward = cross(q - p, above - p);
            const double factor = limits / norm(outward);
            const Vec3 shift = outward * factor;
            limits_[e] = plane_through(p + shift, q + shift, above + shift);
        }
        const auto has_normal = [](const Plane& plane)
        {
            const double length = norm(plane.normal);
            return length > 0 && std::isfinite(length);
        };
        holds_nothing_ =
            !has_normal(plane_) || !std::all_of(limits_.begin(), limits_.end(), has_normal);
    }

    const NodeBox& box() const { return box_; }
    bool is_node() const { return is_node_; }
    bool holds_nothing() const { return holds_nothing_; }

    bool holds(const Vec3& x) const
    {
        if (!(std::fabs(plane_.value(x) / length_) < weight_)) return false;
        for (const Plane& limit : limits_)
            if (!(limit.value(x) < 0)) return false;
        return true;
    }

    void emit(std::int64_t ix, Spans& out) const
    {
        const double x = grid_.origin.x + static_cast<double>(ix) * grid_.step(0);
        std::int64_t y_first = box_.begin[1];
        std::int64_t y_last = box_.end[1] - 1;
        if (y_last - y_first > 6 && !narrow_rows(x, y_first, y_last)) return;
        for (std::int64_t iy = y_first; iy <= y_last; ++iy)
        {
            const double y = grid_.origin.y + static_cast<double>(iy) * grid_.step(1);
            double lo = static_cast<double>(box_.begin[2]);
            double hi = static_cast<double>(box_.end[2] - 1);
            const Vec3 foot{x, y, grid_.origin.z};
            const double height = plane_.value(foot);
            const double step = plane_.normal.z * grid_.step(2);
            const double noise = 1e-7 * length_ * grid_.dp;
            narrow(lo, hi, height, step, -weight_ * length_, noise);
            narrow(lo, hi, -height, -step, -weight_ * length_, noise);
            for (const Plane& limit : limits_)
                narrow(lo, hi, -limit.value(foot), -limit.normal.z * grid_.step(2), 0,
                       noise_of(limit, grid_.dp));
            std::int64_t first = 0;
            std::int64_t last = 0;
            if (!to_index_range(lo, hi, box_.begin[2], box_.end[2] - 1, first, last)) continue;
            const auto test = [&](std::int64_t k) {
                return holds({x, y, grid_.origin.z + static_cast<double>(k) * grid_.step(2)});
            };
            if (trim_interval(first, last, box_.begin[2], box_.end[2] - 1, test))
                out.push_back({static_cast<std::uint32_t>(iy), static_cast<std::uint32_t>(first),
                               static_cast<std::uint32_t>(last) + 1});
        }
    }

private:
    /// Rows of the slab that the triangle can reach: the (y, z) rectangle of its box, cut by the
    /// conditions of holds() with a margin. Spares needles in large boxes the walk over empty rows.
    bool narrow_rows(double x, std::int64_t& y_first, std::int64_t& y_last) const
    {
        struct Point
        {
            double y;
            double z;
        };
        std::array<Point, 16> polygon;
        std::array<Point, 16> cut;
        std::size_t count = 4;
        const auto y0 = static_cast<double>(box_.begin[1]);
        const auto y1 = static_cast<double>(box_.end[1] - 1);
        const auto z0 = static_cast<double>(box_.begin[2]);
        const auto z1 = static_cast<double>(box_.end[2] - 1);
        polygon[0] = {y0, z0};
        polygon[1] = {y1, z0};
        polygon[2] = {y1, z1};
        polygon[3] = {y0, z1};
        const auto clip = [&](const Plane& plane, double sign, double limit)
        {
            const double margin = 1e-6 * grid_.dp * norm(plane.normal);
            const auto value = [&](const Point& p)
            {
                const Vec3 q{x, grid_.origin.y + p.y * grid_.step(1),
                             grid_.origin.z + p.z * grid_.step(2)};
                return sign * plane.value(q) + limit + margin;
            };
            std::size_t kept = 0;
            for (std::size_t i = 0; i < count; ++i)
            {
                const Point& p = polygon[i];
                const Point& q = polygon[(i + 1) % count];
                const double vp = value(p);
                const double vq = value(q);
                if (vp >= 0) cut[kept++] = p;
                if ((vp >= 0) != (vq >= 0))
                {
                    const double t = vp / (vp - vq);
                    cut[kept++] = {p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
                }
            }
            polygon = cut;
            count = kept;
        };
        clip(plane_, 1, weight_ * length_);
        clip(plane_, -1, weight_ * length_);
        for (const Plane& limit : limits_) clip(limit, -1, 0);
        if (count == 0) return false;
        double lo = polygon[0].y;
        double hi = polygon[0].y;
        for (std::size_t i = 1; i < count; ++i)
        {
            lo = std::min(lo, polygon[i].y);
            hi = std::max(hi, polygon[i].y);
        }
        y_first = std::max(y_first, static_cast<std::int64_t>(std::floor(lo)) - 1);
        y_last = std::min(y_last, static_cast<std::int64_t>(std::ceil(hi)) + 1);
        return y_first <= y_last;
    }

    LatticeGrid grid_;
    NodeBox box_;
    double weight_;
    bool is_node_ = false;
    bool holds_nothing_ = false;
    Plane plane_;
    double length_ = 1;
    std::array<Plane, 3> limits_;
};

} // namespace

SlabRegion points_region(const std::vector<Vec3>& points, const LatticeGrid& grid)
{
    auto nodes = std::make_shared<std::vector<Node>>();
    for (const Vec3& p : points)
    {
        const Node n = snap(p, grid);
        if (is_inside(n, grid)) nodes->push_back(n);
    }
    std::sort(nodes->begin(), nodes->end(), [](const Node& a, const Node& b) { return a.x < b.x; });
    if (nodes->empty()) return {};
    SlabRegion region;
    region.x_begin = static_cast<std::uint32_t>(nodes->front().x);
    region.x_end = static_cast<std::uint32_t>(nodes->back().x) + 1;
    region.emit = [nodes](std::uint32_t x, Spans& out)
    {
        const auto less = [](const Node& n, std::int64_t value) { return n.x < value; };
        for (auto it =
                 std::lower_bound(nodes->begin(), nodes->end(), static_cast<std::int64_t>(x), less);
             it != nodes->end() && it->x == x; ++it)
            out.push_back(one_node(it->y, it->z));
    };
    return region;
}

namespace
{

/// The nodes near a segment between two nodes, in one slab.
class SegmentNodes
{
public:
    SegmentNodes(const std::pair<Node, Node>& segment, const LatticeGrid& grid, double width_dp,
                 std::uint32_t slab)
        : from_(segment.first),
          grid_(grid),
          slab_(slab),
          box_(box_of(segment.first, segment.second, grid)),
          a_(position(segment.first, grid)),
          b_(position(segment.second, grid)),
          length_(norm(b_ - a_)),
          limit_(width_dp * grid.dp),
          reach_(static_cast<std::int64_t>(std::ceil(width_dp * 1.8)) + 1),
          along_{static_cast<double>(segment.second.x - segment.first.x),
                 static_cast<double>(segment.second.y - segment.first.y),
                 static_cast<double>(segment.second.z - segment.first.z)}
    {
    }

    /// Where the slab's plane, or in it the row, meets the line: nodes in reach lie within `reach`
    /// of it along the other axes, the line's steepest axis being walked.
    void list(Spans& out) const
    {
        const double steepest =
            std::max({std::fabs(along_.x), std::fabs(along_.y), std::fabs(along_.z)});
        if (std::fabs(along_.x) == steepest)
            list_in(around(share(slab_, from_.x, along_.x)), out);
        else if (std::fabs(along_.y) == steepest)
            for (std::int64_t y = box_.begin[1]; y < box_.end[1]; ++y)
            {
                Rectangle near = around(share(y, from_.y, along_.y));
                near.y0 = near.y1 = y;
                list_in(near, out);
            }
        else
            for (std::int64_t z = box_.begin[2]; z < box_.end[2]; ++z)
            {
                Rectangle near = around(share(z, from_.z, along_.z));
                near.z0 = near.z1 = z;
                list_in(near, out);
            }
    }

private:
    /// Rows and heights, the last ones included.
    struct Rectangle
    {
        std::int64_t y0, y1, z0, z1;
    };

    static double share(std::int64_t at, std::int64_t from, double along)
    {
        return (static_cast<double>(at) - static_cast<double>(from)) / along;
    }

    Rectangle around(double t) const
    {
        const auto y =
            static_cast<std::int64_t>(std::floor(static_cast<double>(from_.y) + t * along_.y));
        const auto z =
            static_cast<std::int64_t>(std::floor(static_cast<double>(from_.z) + t * along_.z));
        return {std::max(y - reach_, box_.begin[1]), std::min(y + reach_ + 1, box_.end[1] - 1),
                std::max(z - reach_, box_.begin[2]), std::min(z + reach_ + 1, box_.end[2] - 1)};
    }

    void list_in(const Rectangle& near, Spans& out) const
    {
        for (std::int64_t y = near.y0; y <= near.y1; ++y)
            for (std::int64_t z = near.z0; z <= near.z1; ++z)
                if (holds(y, z)) out.push_back(one_node(y, z));
    }

    bool holds(std::int64_t y, std::int64_t z) const
    {
        const Vec3 p =
            grid_.place(static_cast<double>(slab_), static_cast<double>(y), static_cast<double>(z));
        const double area = norm(cross(a_ - p, b_ - p)) / 2;
        return 2 * area / length_ < limit_;
    }

    Node from_;
    const LatticeGrid& grid_;
    std::uint32_t slab_;
    NodeBox box_;
    Vec3 a_;
    Vec3 b_;
    double length_;
    double limit_;
    std::int64_t reach_;
    Vec3 along_;
};

} // namespace

SlabRegion lines_region(const std::vector<std::pair<Node, Node>>& segments, const LatticeGrid& grid,
                        double width_dp)
{
    auto shared = std::make_shared<std::vector<std::pair<Node, Node>>>(segments);
    auto index = std::make_shared<SlabIndex>(
        shared->size(), grid.n[0],
        [&](std::size_t i)
        {
            const NodeBox b = box_of((*shared)[i].first, (*shared)[i].second, grid);
            return b.is_empty() ? std::pair<std::int64_t, std::int64_t>{0, 0}
                                : std::pair{b.begin[0], b.end[0]};
        });
    SlabRegion region;
    region.x_begin = index->x_begin();
    region.x_end = index->x_end();
    region.emit = [shared, index, grid, width_dp](std::uint32_t slab, Spans& out)
    {
        index->for_each(slab,
                        [&](std::uint32_t item)
                        {
                            const std::pair<Node, Node>& segment = (*shared)[item];
                            if (segment.first == segment.second) return;
                            SegmentNodes(segment, grid, width_dp, slab).list(out);
                        });
    };
    return region;
}

SlabRegion triangles_region(std::vector<SnappedTriangle> triangles, const LatticeGrid& grid,
                            double weight_dp, double limits_dp)
{
    auto shared = std::make_shared<std::vector<SnappedTriangle>>(std::move(triangles));
    auto index = std::make_shared<SlabIndex>(
        shared->size(), grid.n[0],
        [&](std::size_t i)
        {
            const NodeBox b = box_of((*shared)[i], grid);
            return b.is_empty() ? std::pair<std::int64_t, std::int64_t>{0, 0}
                                : std::pair{b.begin[0], b.end[0]};
        });
    SlabRegion region;
    region.x_begin = index->x_begin();
    region.x_end = index->x_end();
    region.emit = [shared, index, grid, weight_dp, limits_dp](std::uint32_t x, Spans& out)
    {
        index->for_each(x,
                        [&](std::uint32_t item)
                        {
                            const TriangleTest test((*shared)[item], grid, weight_dp, limits_dp);
                            if (test.is_node())
                                out.push_back(one_node(test.box().begin[1], test.box().begin[2]));
                            else if (!test.holds_nothing())
                                test.emit(x, out);
                        });
    };
    return region;
}

std::vector<SnappedTriangle> snapped_triangles(const PolyhedronOp& polyhedron,
                                               const LatticeGrid& grid, bool only_visible)
{
    std::vector<SnappedTriangle> out;
    std::vector<Node> nodes;
    for (const Vec3& v : polyhedron.vertices) nodes.push_back(snap(v, grid));
    for (const PolyhedronFace& face : polyhedron.faces)
    {
        if (only_visible && !face.is_visible) continue;
        for (const auto& t : face_triangles(polyhedron, face))
            out.push_back({nodes[t[0]], nodes[t[1]], nodes[t[2]]});
    }
    return out;
}

} // namespace fppg
