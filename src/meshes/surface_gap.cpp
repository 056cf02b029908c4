#include "meshes/surface_gap.h"

#include "meshes/facet_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace fppg
{

namespace
{

constexpr std::uint32_t facets_of_a_leaf = 4;

using GapFacet = std::array<Vec3, 3>;

GapFacet gap_facet(const TriangleSoup& soup, std::uint32_t f)
{
    const std::size_t at = 3 * std::size_t{f};
    return {soup.vertices[at], soup.vertices[at + 1], soup.vertices[at + 2]};
}

/// The nearest places of two segments.
std::pair<Vec3, Vec3> closest_on_segments(const Vec3& a, const Vec3& b, const Vec3& c,
                                          const Vec3& d)
{
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    double s = determinant > 1e-14 * uu * vv ? (uv * vw - vv * uw) / determinant : 0;
    s = std::clamp(s, 0.0, 1.0);
    double t = vv > 0 ? (uv * s + vw) / vv : 0;
    if (t < 0 || t > 1)
    {
        t = std::clamp(t, 0.0, 1.0);
        s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0;
    }
    return {a + s * u, c + t * v};
}

/// Where a segment passes through a facet; false where it does not, or lies in its plane.
bool crossing_place(const Vec3& a, const Vec3& b, const GapFacet& f, Vec3& place)
{
    const Vec3 normal = cross(f[1] - f[0], f[2] - f[0]);
    const double from = dot(normal, a - f[0]), to = dot(normal, b - f[0]);
    if (!((from < 0 && to > 0) || (from > 0 && to < 0))) return false;
    place = a + (from / (from - to)) * (b - a);
    for (std::size_t s = 0; s < 3; ++s)
        if (dot(cross(f[(s + 1) % 3] - f[s], place - f[s]), normal) < 0) return false;
    return true;
}

double squared_distance(const Box3& a, const Box3& b)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double away = std::max({a.min[axis] - b.max[axis], b.min[axis] - a.max[axis], 0.0});
        sum += away * away;
    }
    return sum;
}

Box3 moved_box(const Box3& box, const Transform& place)
{
    const Vec3 middle = place((box.min + box.max) * 0.5);
    const Vec3 half = (box.max - box.min) * 0.5;
    Vec3 reach;
    for (int axis = 0; axis < 3; ++axis)
    {
        const Vec3& row = place.linear[static_cast<std::size_t>(axis)];
        reach[axis] =
            std::abs(row.x) * half.x + std::abs(row.y) * half.y + std::abs(row.z) * half.z;
    }
    return {middle - reach, middle + reach};
}

} // namespace

/// One search through two trees.
class GapSearch
{
public:
    GapSearch(const GapTree& first, const GapTree& second, const Transform& place, double within)
        : first_(first), second_(second), place_(place), squared_(within * within)
    {
        if (!std::isfinite(within)) squared_ = within;
    }

    SurfaceGap run()
    {
        visit(0, 0,
              squared_distance(first_.nodes_[0].box, moved_box(second_.nodes_[0].box, place_)));
        return found_;
    }

private:
    void visit(std::uint32_t a, std::uint32_t b, double bound)
    {
        if (found_.crosses || !(bound < squared_)) return;
        const GapTree::Node& one = first_.nodes_[a];
        const GapTree::Node& other = second_.nodes_[b];
        if (one.left == 0 && other.left == 0)
        {
            for (std::uint32_t j = other.begin; j < other.end; ++j) take(one, second_.order_[j]);
            return;
        }
        std::array<std::pair<std::uint32_t, std::uint32_t>, 2> ways;
        if (other.left == 0 || (one.left != 0 && norm(one.box.max - one.box.min) >
                                                     norm(other.box.max - other.box.min)))
            ways = {{{one.left, b}, {one.right, b}}};
        else
            ways = {{{a, other.left}, {a, other.right}}};
        std::array<double, 2> bounds{};
        for (std::size_t k = 0; k < 2; ++k)
            bounds[k] = squared_distance(first_.nodes_[ways[k].first].box,
                                         moved_box(second_.nodes_[ways[k].second].box, place_));
        const std::size_t nearer = bounds[1] < bounds[0] ? 1 : 0;
        visit(ways[nearer].first, ways[nearer].second, bounds[nearer]);
        visit(ways[1 - nearer].first, ways[1 - nearer].second, bounds[1 - nearer]);
    }

    void take(const GapTree::Node& one, std::uint32_t g)
    {
        GapFacet other = gap_facet(second_.soup_, g);
        Box3 box;
        for (Vec3& corner : other) box.add(corner = place_(corner));
        for (std::uint32_t i = one.begin; i < one.end && !found_.crosses; ++i)
        {
            const GapFacet facet = gap_facet(first_.soup_, first_.order_[i]);
            Box3 own;
            for (const Vec3& corner : facet) own.add(corner);
            const double apart = squared_distance(own, box);
            if (apart < squared_) compare(facet, other, apart == 0);
        }
    }

    /// Whether all corners of one are farther from the plane of the other, on one side, than the
    /// least distance up to now.
    bool is_beyond_plane(const GapFacet& f, const GapFacet& g) const
    {
        const Vec3 normal = cross(f[1] - f[0], f[2] - f[0]);
        const double limit = squared_ * dot(normal, normal);
        const double a = dot(normal, g[0] - f[0]), b = dot(normal, g[1] - f[0]),
                     c = dot(normal, g[2] - f[0]);
        const double least = std::min({a, b, c}), most = std::max({a, b, c});
        return (least > 0 && least * least >= limit) || (most < 0 && most * most >= limit);
    }

    void compare(const GapFacet& f, const GapFacet& g, bool may_cross)
    {
        if (is_beyond_plane(f, g) || is_beyond_plane(g, f)) return;
        for (std::size_t s = 0; s < 3; ++s)
        {
            keep(f[s], closest_on_facet(f[s], g.data()));
            keep(closest_on_facet(g[s], f.data()), g[s]);
            for (std::size_t t = 0; t < 3; ++t)
            {
                const auto [p, q] = closest_on_segments(f[s], f[(s + 1) % 3], g[t], g[(t + 1) % 3]);
                keep(p, q);
            }
        }
        Vec3 place;
        if (!may_cross) return;
        for (std::size_t s = 0; s < 3; ++s)
            if (crossing_place(f[s], f[(s + 1) % 3], g, place) ||
                crossing_place(g[s], g[(s + 1) % 3], f, place))
            {
                found_ = {0, place, place, true};
                squared_ = 0;
                return;
            }
    }

    void keep(const Vec3& p, const Vec3& q)
    {
        const Vec3 way = q - p;
        const double squared = dot(way, way);
        if (!(squared < squared_)) return;
        squared_ = squared;
        found_ = {std::sqrt(squared), p, q, false};
    }

    const GapTree& first_;
    const GapTree& second_;
    Transform place_;
    double squared_;
    SurfaceGap found_;
};

GapTree::GapTree(TriangleSoup soup) : soup_(std::move(soup))
{
    const auto n = static_cast<std::uint32_t>(soup_.size());
    middles_.resize(n);
    order_.resize(n);
    for (std::uint32_t f = 0; f < n; ++f)
    {
        const GapFacet facet = gap_facet(soup_, f);
        Box3 box;
        for (const Vec3& corner : facet) box.add(corner);
        middles_[f] = (box.min + box.max) * 0.5;
        order_[f] = f;
    }
    nodes_.reserve(n);
    build(0, n);
}

std::uint32_t GapTree::build(std::uint32_t begin, std::uint32_t end)
{
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box3 box;
    Box3 spread;
    for (std::uint32_t i = begin; i < end; ++i)
    {
        for (const Vec3& corner : gap_facet(soup_, order_[i])) box.add(corner);
        spread.add(middles_[order_[i]]);
    }
    nodes_[at].box = box;
    nodes_[at].begin = begin;
    nodes_[at].end = end;
    if (end - begin <= facets_of_a_leaf) return at;
    const Vec3 size = spread.max - spread.min;
    int axis = 0;
    for (const int other : {1, 2})
        if (size[other] > size[axis]) axis = other;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b)
                     {
                         const double x = middles_[a][axis], y = middles_[b][axis];
                         return x != y ? x < y : a < b;
                     });
    const std::uint32_t left = build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[at].left = left;
    nodes_[at].right = right;
    return at;
}

SurfaceGap GapTree::gap_to(const GapTree& other, const Transform& place, double within) const
{
    return GapSearch(*this, other, place, within).run();
}

} // namespace fppg
