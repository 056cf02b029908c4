#include "lattice/depth_region.h"
#include "core/float32.h"

#include "core/parallel.h"
#include "nodes/snap.h"
#include "shapes/planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace fppg
{
namespace
{

/// Its normal has length one.
Plane plane_of(const Vec3& normal, const Vec3& point)
{
    const double length = norm(normal);
    return {{normal.x / length, normal.y / length, normal.z / length},
            -dot(normal, point) / length};
}

struct Facet
{
    std::array<Vec3, 3> corners;
    Plane plane;
    NodeBox reach;
};

/// Distance from a point to a triangle, by the region of the plane that the point projects into.
double distance_to(const Vec3& p, const std::array<Vec3, 3>& t)
{
    const auto& [a, b, c] = t;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = p - a;
    const double d1 = dot(ab, ap);
    const double d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return norm(p - a);
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp);
    const double d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return norm(p - b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(p - (a + ab * (d1 / (d1 - d3))));
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp);
    const double d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return norm(p - c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(p - (a + ac * (d2 / (d2 - d6))));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return norm(p - (b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))));
    const Vec3 n = cross(ab, ac);
    return std::fabs(dot(n, ap)) / norm(n);
}

/// Through the edge from a to b, at right angles to the facet; its normal points outwards.
Plane side_plane(const Vec3& a, const Vec3& b, const Vec3& raised, const Vec3& normal)
{
    return plane_of(cross(b - a, raised + normal - a), a);
}

/// Where a row along x passes a facet.
struct RowCrossing
{
    std::uint32_t y = 0;
    std::uint32_t z = 0;
    double x = 0;
    bool is_entry = false;
};

class DepthFinder
{
public:
    DepthFinder(const TriangleSoup& soup, const MeshFileOp& op, const LatticeGrid& grid)
        : grid_(grid),
          depth_min_(op.depth_min),
          depth_max_(op.depth_max),
          starts_inside_(op.reverse),
          takes_any_depth_(op.any_depth)
    {
        // Beyond this distance a facet decides nothing.
        reach_ = std::isfinite(depth_max_) ? depth_max_ : depth_min_;
        margin_ = std::isfinite(depth_max_) && !takes_any_depth_ ? depth_max_ : 0;
        box_ = {{INT64_MAX, INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN, INT64_MIN}};
        constexpr double far = std::numeric_limits<double>::infinity();
        double lowest_x = far;
        double highest_x = -far;
        for (std::size_t t = 0; t < soup.size(); ++t)
        {
            add_facet(soup, t);
            for (std::size_t i = 0; i < 3; ++i)
            {
                const double x = as_float32(soup.vertices[3 * t + i].x);
                lowest_x = std::min(lowest_x, x);
                highest_x = std::max(highest_x, x);
            }
        }
        for (std::size_t k = 0; k < 3; ++k)
            first_node_[k] = std::max(box_.begin[k], std::int64_t{-1});
        row_begin_ = grid_.origin.x +
                     std::trunc((lowest_x - grid_.origin.x) / grid_.step(0)) * grid_.step(0);
        if (row_begin_ > lowest_x) row_begin_ -= grid_.step(0);
        row_begin_ -= grid_.step(0) / 2;
        row_end_ = highest_x + grid_.step(0) / 2;
        box_ = intersect(box_, whole_lattice(grid_));
        for (Facet& f : facets_) f.reach = intersect(f.reach, box_);
    }

    const NodeBox& box() const { return box_; }

    /// The nodes that count, per slab of the box.
    std::vector<Spans> counted() const
    {
        std::vector<RowCrossing> crossings;
        for (const Facet& f : facets_) add_crossings(f, crossings);
        std::sort(
            crossings.begin(), crossings.end(),
            [](const RowCrossing& a, const RowCrossing& b)
            { return std::tie(a.y, a.z, a.x, a.is_entry) < std::tie(b.y, b.z, b.x, b.is_entry); });
        std::vector<Spans> slabs(static_cast<std::size_t>(box_.end[0] - box_.begin[0]));
        auto next = crossings.begin();
        for (auto y = static_cast<std::uint32_t>(box_.begin[1]); y < box_.end[1]; ++y)
            for (auto z = static_cast<std::uint32_t>(box_.begin[2]); z < box_.end[2]; ++z)
            {
                const auto first = next;
                while (next != crossings.end() && next->y == y && next->z == z) ++next;
                if (first == next && !starts_inside_) continue;
                bool counts = starts_inside_ || !first->is_entry;
                auto crossing = first;
                for (std::size_t i = 0; i < slabs.size(); ++i)
                {
                    const double x =
                        grid_.origin.x +
                        static_cast<double>(box_.begin[0] + static_cast<std::int64_t>(i)) *
                            grid_.step(0);
                    const double node = as_float32(x);
                    while (crossing != next &&
                           (crossing->is_entry ? as_float32(crossing->x) <= node
                                               : as_float32(crossing->x) < node))
                        counts = (crossing++)->is_entry;
                    if (counts) append_node(slabs[i], y, z);
                }
            }
        return slabs;
    }

    /// The nodes of `counted` whose depth is wanted, in slab x.
    void take(std::uint32_t slab, const Spans& counted, Spans& out) const
    {
        if (takes_any_depth_)
        {
            out = counted;
            return;
        }
        const auto rows = static_cast<std::size_t>(box_.end[1] - box_.begin[1]);
        const auto height = static_cast<std::size_t>(box_.end[2] - box_.begin[2]);
        constexpr double far = std::numeric_limits<double>::infinity();
        std::vector<double> depth(rows * height, far);
        const double x = node_at(slab, 0);
        for (const Facet& f : facets_)
        {
            if (slab < f.reach.begin[0] || slab >= f.reach.end[0]) continue;
            for (std::int64_t y = f.reach.begin[1]; y < f.reach.end[1]; ++y)
                for (std::int64_t z = f.reach.begin[2]; z < f.reach.end[2]; ++z)
                {
                    const Vec3 p{x, node_at(y, 1), node_at(z, 2)};
                    if (f.plane.value(p) > 0) continue;
                    double& d = depth[static_cast<std::size_t>(y - box_.begin[1]) * height +
                                      static_cast<std::size_t>(z - box_.begin[2])];
                    d = std::min(d, distance_to(p, f.corners));
                }
        }
        // Limits are met to rounding: nodes stand on the lattice, faces often too.
        const double slack = 1e-9 * grid_.dp;
        for (const Span& s : counted)
            for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
            {
                const double d = depth[static_cast<std::size_t>(s.y - box_.begin[1]) * height +
                                       static_cast<std::size_t>(z - box_.begin[2])];
                if (d >= depth_min_ - slack && d <= depth_max_ + slack) append_node(out, s.y, z);
            }
    }

private:
    /// The last node that is not beyond a coordinate.
    std::int64_t node_below(double coordinate, int axis) const
    {
        return to_index(std::floor((coordinate - grid_.origin[axis]) / grid_.step(axis)));
    }

    void add_facet(const TriangleSoup& soup, std::size_t t)
    {
        Facet f;
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Vec3& v = soup.vertices[3 * t + i];
            f.corners[i] = {as_float32(v.x), as_float32(v.y), as_float32(v.z)};
        }
        const Vec3 normal = cross(f.corners[1] - f.corners[0], f.corners[2] - f.corners[0]);
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto k = static_cast<std::size_t>(axis);
            const double low =
                std::min({f.corners[0][axis], f.corners[1][axis], f.corners[2][axis]});
            const double high =
                std::max({f.corners[0][axis], f.corners[1][axis], f.corners[2][axis]});
            f.reach.begin[k] = snap(low - reach_, grid_.origin[axis], grid_.step(axis)) - 1;
            f.reach.end[k] = snap(high + reach_, grid_.origin[axis], grid_.step(axis)) + 2;
            box_.begin[k] = std::min(box_.begin[k], node_below(low - margin_, axis));
            box_.end[k] = std::max(box_.end[k], node_below(high + margin_, axis) + 1);
        }
        if (!(norm(normal) > 0)) return;
        f.plane = plane_of(normal, f.corners[0]);
        facets_.push_back(f);
    }

    /// Counted from the box round the mesh, as GenCase does.
    double node_at(std::int64_t index, int axis) const
    {
        const std::int64_t first = first_node_[static_cast<std::size_t>(axis)];
        return grid_.origin[axis] + static_cast<double>(first) * grid_.step(axis) +
               static_cast<double>(index - first) * grid_.step(axis);
    }

    void add_crossings(const Facet& f, std::vector<RowCrossing>& out) const
    {
        const Plane& plane = f.plane;
        if (plane.normal.x == 0) return;
        const double x_begin = row_begin_;
        const double length = row_end_ - row_begin_;
        const auto& [a, b, c] = f.corners;
        const std::array<Plane, 3> sides{side_plane(a, b, a, plane.normal),
                                         side_plane(b, c, b, plane.normal),
                                         side_plane(c, a, a, plane.normal)};
        for (std::int64_t y = f.reach.begin[1]; y < f.reach.end[1]; ++y)
            for (std::int64_t z = f.reach.begin[2]; z < f.reach.end[2]; ++z)
            {
                Vec3 p{x_begin, node_at(y, 1), node_at(z, 2)};
                p.x += length * (-plane.value(p) / (plane.normal.x * length));
                if (std::any_of(sides.begin(), sides.end(),
                                [&p](const Plane& side) { return side.value(p) > 0; }))
                    continue;
                out.push_back({static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z), p.x,
                               plane.normal.x < 0});
            }
    }

    LatticeGrid grid_;
    double depth_min_;
    double depth_max_;
    bool starts_inside_;
    bool takes_any_depth_;
    double reach_ = 0;
    double margin_ = 0; ///< of the box round the mesh
    NodeBox box_;
    std::array<std::int64_t, 3> first_node_{};
    double row_begin_ = 0;
    double row_end_ = 0;
    std::vector<Facet> facets_;
};

} // namespace

SlabRegion depth_region(const TriangleSoup& soup, const MeshFileOp& op, const LatticeGrid& grid,
                        int threads)
{
    const DepthFinder finder(soup, op, grid);
    SlabRegion region;
    if (finder.box().is_empty()) return region;
    const auto counted = finder.counted();
    auto taken = std::make_shared<std::vector<Spans>>(counted.size());
    const auto x_begin = static_cast<std::uint32_t>(finder.box().begin[0]);
    parallel_for(counted.size(), threads,
                 [&](std::size_t i) {
                     finder.take(x_begin + static_cast<std::uint32_t>(i), counted[i], (*taken)[i]);
                 });
    region.x_begin = x_begin;
    region.x_end = x_begin + static_cast<std::uint32_t>(taken->size());
    region.emit = [taken, x_begin](std::uint32_t x, Spans& out) { out = (*taken)[x - x_begin]; };
    return region;
}

} // namespace fppg
