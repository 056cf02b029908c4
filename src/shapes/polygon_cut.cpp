#include "shapes/polygon_cut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fppg
{
namespace
{

using Whole = __int128;
using WholeVec = std::array<Whole, 3>;

/// A corner on a fine lattice.
struct FineNode
{
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;

    bool operator==(const FineNode&) const = default;
};

WholeVec minus(const FineNode& a, const FineNode& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

WholeVec cross(const WholeVec& a, const WholeVec& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Whole dot(const WholeVec& a, const WholeVec& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The polygon's area vector: the sum over its sides, in whole numbers.
WholeVec area_of(const std::vector<FineNode>& nodes, const std::vector<std::size_t>& polygon)
{
    WholeVec area{};
    const FineNode& from = nodes[polygon[0]];
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    {
        const WholeVec part =
            cross(minus(nodes[polygon[i]], from), minus(nodes[polygon[i + 1]], from));
        for (std::size_t k = 0; k < 3; ++k) area[k] += part[k];
    }
    return area;
}

/// The corners of a polygon on a lattice far finer than any dp, as the cutter works on whole
/// numbers.
std::vector<FineNode> fine_nodes(const std::vector<Vec3>& vertices,
                                 const std::vector<std::size_t>& polygon)
{
    Box3 box;
    for (const std::size_t v : polygon) box.add(vertices[v]);
    const Vec3 size = box.max - box.min;
    const double step = std::max({size.x, size.y, size.z}) / (1 << 26);
    std::vector<FineNode> nodes(vertices.size());
    if (step > 0)
        for (const std::size_t v : polygon)
        {
            const Vec3 steps = (vertices[v] - box.min) / step;
            nodes[v] = {std::llround(steps.x), std::llround(steps.y), std::llround(steps.z)};
        }
    return nodes;
}

class PolygonCutter
{
public:
    PolygonCutter(const std::vector<Vec3>& vertices, const std::vector<std::size_t>& polygon)
        : vertices_(vertices),
          nodes_(fine_nodes(vertices, polygon)),
          rest_(polygon),
          area_(area_of(nodes_, polygon)),
          slack_(1e-6 * static_cast<double>(dot(area_, area_)))
    {
    }

    std::vector<std::array<std::size_t, 3>> run()
    {
        std::vector<std::array<std::size_t, 3>> triangles;
        while (rest_.size() > 3)
        {
            const std::size_t k = next_corner();
            triangles.push_back({before(k), rest_[k], after(k)});
            rest_.erase(rest_.begin() + static_cast<std::ptrdiff_t>(k));
        }
        triangles.push_back({rest_[0], rest_[1], rest_[2]});
        return triangles;
    }

private:
    std::size_t before(std::size_t k) const { return rest_[(k + rest_.size() - 1) % rest_.size()]; }
    std::size_t after(std::size_t k) const { return rest_[(k + 1) % rest_.size()]; }

    double distance(std::size_t i, std::size_t j) const
    {
        return norm(vertices_[i] - vertices_[j]);
    }

    /// Twice the area of a, b, p, times that of the polygon: positive on the inner side of a side.
    double side(const FineNode& a, const FineNode& b, const FineNode& p) const
    {
        return static_cast<double>(dot(cross(minus(b, a), minus(p, a)), area_));
    }

    bool is_ear(std::size_t k) const
    {
        const FineNode& a = nodes_[before(k)];
        const FineNode& b = nodes_[rest_[k]];
        const FineNode& c = nodes_[after(k)];
        if (side(a, b, c) <= slack_) return false;
        for (const std::size_t i : rest_)
        {
            const FineNode& p = nodes_[i];
            if (p == a || p == b || p == c) continue;
            if (side(a, b, p) >= -slack_ && side(b, c, p) >= -slack_ && side(c, a, p) >= -slack_)
                return false;
        }
        return true;
    }

    /// The corner to cut off; where no corner is an ear (corners on one line), the one of least
    /// perimeter.
    std::size_t next_corner() const
    {
        for (const bool only_ears : {true, false})
        {
            std::size_t best = rest_.size();
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < rest_.size(); ++k)
            {
                const double perimeter = distance(before(k), rest_[k]) +
                                         distance(rest_[k], after(k)) +
                                         distance(before(k), after(k));
                if (perimeter < least && (!only_ears || is_ear(k)))
                {
                    least = perimeter;
                    best = k;
                }
            }
            if (best < rest_.size()) return best;
        }
        return 0;
    }

    const std::vector<Vec3>& vertices_;
    std::vector<FineNode> nodes_;
    std::vector<std::size_t> rest_;
    WholeVec area_;
    double slack_; ///< what rounding to the fine lattice may do to side()
};

} // namespace

std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Vec3>& vertices,
                                                    const std::vector<std::size_t>& polygon)
{
    return PolygonCutter(vertices, polygon).run();
}

} // namespace fppg
