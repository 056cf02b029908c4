#include "lattice/polygon_cut.h"

#include <limits>

namespace fppg
{
namespace
{

using Whole = __int128;
using WholeVec = std::array<Whole, 3>;

WholeVec minus(const Node& a, const Node& b)
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
WholeVec area_of(const std::vector<Node>& nodes, const std::vector<std::size_t>& polygon)
{
    WholeVec area{};
    const Node& from = nodes[polygon[0]];
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    {
        const WholeVec part =
            cross(minus(nodes[polygon[i]], from), minus(nodes[polygon[i + 1]], from));
        for (std::size_t k = 0; k < 3; ++k) area[k] += part[k];
    }
    return area;
}

class PolygonCutter
{
public:
    PolygonCutter(const std::vector<Node>& nodes, const std::vector<std::size_t>& polygon,
                  const LatticeGrid& grid)
        : nodes_(nodes), rest_(polygon), grid_(grid), area_(area_of(nodes, polygon))
    {
        first_ = polygon.size() > 4 && !is_flat(nodes, polygon) ? 1 : 0;
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
        return norm(position(nodes_[i], grid_) - position(nodes_[j], grid_));
    }

    bool is_ear(std::size_t k) const
    {
        const Node& a = nodes_[before(k)];
        const Node& b = nodes_[rest_[k]];
        const Node& c = nodes_[after(k)];
        if (dot(cross(minus(b, a), minus(c, b)), area_) <= 0) return false;
        for (const std::size_t i : rest_)
        {
            const Node& p = nodes_[i];
            if (p == a || p == b || p == c) continue;
            if (dot(cross(minus(b, a), minus(p, a)), area_) >= 0 &&
                dot(cross(minus(c, b), minus(p, b)), area_) >= 0 &&
                dot(cross(minus(a, c), minus(p, c)), area_) >= 0)
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
            for (std::size_t k = first_; k < rest_.size(); ++k)
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
        return first_;
    }

    const std::vector<Node>& nodes_;
    std::vector<std::size_t> rest_;
    LatticeGrid grid_;
    WholeVec area_;
    std::size_t first_ = 0;
};

} // namespace

std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<Node>& nodes,
                                                    const std::vector<std::size_t>& polygon,
                                                    const LatticeGrid& grid)
{
    return PolygonCutter(nodes, polygon, grid).run();
}

bool is_flat(const std::vector<Node>& nodes, const std::vector<std::size_t>& polygon)
{
    const WholeVec normal = cross(minus(nodes[polygon[1]], nodes[polygon[0]]),
                                  minus(nodes[polygon[2]], nodes[polygon[0]]));
    for (std::size_t k = 3; k < polygon.size(); ++k)
        if (dot(normal, minus(nodes[polygon[k]], nodes[polygon[0]])) != 0) return false;
    return true;
}

} // namespace fppg
