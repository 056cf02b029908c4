#include "normals/geometry_normals.h"
#include "core/float32.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fppg
{
namespace
{

/// Joined vectors are no longer than this, in D.
constexpr double longest = 1.5;

std::vector<Box3> boxes_of(const std::vector<NormalFacet>& facets)
{
    std::vector<Box3> boxes(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f)
        for (std::uint32_t i = 0; i < facets[f].size; ++i) boxes[f].add(facets[f].corners[i]);
    return boxes;
}

Vec3 nearest_on_edge(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 along = b - a;
    const double length = dot(along, along);
    if (!(length > 0)) return a;
    return a + std::clamp(dot(p - a, along) / length, 0.0, 1.0) * along;
}

/// The point of the facet's outline that is nearest to p.
Vec3 nearest_on_outline(const NormalFacet& facet, const Vec3& p)
{
    double least = std::numeric_limits<double>::infinity();
    Vec3 nearest;
    for (std::uint32_t k = 0, last = facet.size - 1; k < facet.size; last = k++)
    {
        const Vec3 q = nearest_on_edge(p, facet.corners[last], facet.corners[k]);
        const double squared = dot(q - p, q - p);
        if (squared >= least) continue;
        least = squared;
        nearest = q;
    }
    return nearest;
}

/// Whether a point of the facet's plane is inside its outline, by the edges that a ray in the plane
/// crosses; seen along the axis that the normal is nearest to.
bool is_inside(const NormalFacet& facet, const Vec3& p)
{
    const Vec3 u{std::fabs(facet.unit.x), std::fabs(facet.unit.y), std::fabs(facet.unit.z)};
    const int axis = u.x >= u.y && u.x >= u.z ? 0 : u.y >= u.z ? 1 : 2;
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    bool inside = false;
    for (std::uint32_t k = 0, last = facet.size - 1; k < facet.size; last = k++)
    {
        const Vec3& a = facet.corners[k];
        const Vec3& b = facet.corners[last];
        if ((a[j] > p[j]) != (b[j] > p[j]) &&
            p[i] < (b[i] - a[i]) * (p[j] - a[j]) / (b[j] - a[j]) + a[i])
            inside = !inside;
    }
    return inside;
}

} // namespace

std::vector<NormalFacet> normal_facets(const std::vector<ShapePolygons>& geometry)
{
    std::vector<NormalFacet> facets;
    for (const ShapePolygons& shape : geometry)
        for (const std::vector<std::uint32_t>& polygon : shape.polygons)
        {
            const auto corner = [&](std::size_t i)
            { return as_float32(shape.vertices[polygon[i]]); };
            const auto add = [&](std::initializer_list<std::size_t> places)
            {
                NormalFacet facet;
                for (const std::size_t i : places) facet.corners[facet.size++] = corner(i);
                const Vec3 n =
                    cross(facet.corners[1] - facet.corners[0], facet.corners[2] - facet.corners[0]);
                if (norm(n) > 0) facet.unit = n / norm(n);
                facets.push_back(facet);
            };
            if (polygon.size() == 4)
                add({0, 1, 2, 3});
            else
                for (std::size_t i = 2; i < polygon.size(); ++i) add({0, i - 1, i});
        }
    return facets;
}

GeometryQuery::GeometryQuery(std::vector<NormalFacet> facets, double reach, double dp, int threads)
    : facets_(std::move(facets)),
      reach_(reach),
      tolerance_(1e-4 * dp),
      tree_(boxes_of(facets_), threads)
{
}

GeometryQuery::Answer GeometryQuery::at(const Vec3& particle) const
{
    Answer answer;
    thread_local std::vector<Facing> facing;
    thread_local std::vector<Aside> aside;
    facing.clear();
    aside.clear();
    double least = std::numeric_limits<double>::infinity();
    double least_aside = std::numeric_limits<double>::infinity();
    const Vec3 room{reach_, reach_, reach_};
    tree_.for_each_overlap({particle - room, particle + room},
                           [&](std::uint32_t index)
                           {
                               const NormalFacet& facet = facets_[index];
                               const double d = dot(facet.corners[0] - particle, facet.unit);
                               if (!(d > 0 && d <= reach_)) return;
                               const Vec3 foot = particle + d * facet.unit;
                               double e = 0;
                               Vec3 nearest = foot;
                               if (!is_inside(facet, foot))
                               {
                                   nearest = nearest_on_outline(facet, foot);
                                   e = norm(nearest - foot);
                               }
                               if (!(e <= reach_)) return;
                               ++answer.candidates;
                               if (e <= tolerance_)
                               {
                                   facing.push_back({index, d});
                                   least = std::min(least, d);
                                   return;
                               }
                               const Vec3 vector = nearest - particle;
                               aside.push_back({index, vector, norm(vector)});
                               least_aside = std::min(least_aside, aside.back().length);
                           });
    if (!facing.empty())
        answer.normal = join(facing, least);
    else if (!aside.empty())
        answer.normal = nearest_of(aside, least_aside);
    return answer;
}

int GeometryQuery::side_at(const Vec3& p, const Vec3& n, double within) const
{
    struct Near
    {
        double distance;
        double along;
    };
    thread_local std::vector<Near> near;
    near.clear();
    double least = within;
    const Vec3 room{within, within, within};
    tree_.for_each_overlap(
        {p - room, p + room},
        [&](std::uint32_t index)
        {
            const NormalFacet& facet = facets_[index];
            const Vec3 foot = p + dot(facet.corners[0] - p, facet.unit) * facet.unit;
            const Vec3 nearest = is_inside(facet, foot) ? foot : nearest_on_outline(facet, foot);
            const double distance = norm(nearest - p);
            if (!(distance <= within)) return;
            near.push_back({distance, dot(facet.unit, n)});
            least = std::min(least, distance);
        });
    double sum = 0;
    for (const Near& facet : near)
        if (facet.distance <= least + 100 * tolerance_) sum += facet.along;
    return sum > 1e-6 ? 1 : sum < -1e-6 ? -1 : 0;
}

bool GeometryQuery::is_same_direction(std::uint32_t facet, std::uint32_t other) const
{
    const Vec3 off = facets_[facet].unit - facets_[other].unit;
    return std::fabs(off.x) <= tolerance_ && std::fabs(off.y) <= tolerance_ &&
           std::fabs(off.z) <= tolerance_;
}

Vec3 GeometryQuery::join(std::vector<Facing>& facing, double least) const
{
    std::sort(facing.begin(), facing.end(),
              [](const Facing& a, const Facing& b) { return a.facet < b.facet; });
    const auto unit = [this](const Facing& f) -> const Vec3& { return facets_[f.facet].unit; };
    std::size_t kept = 0;
    for (const Facing& f : facing)
        if (std::none_of(facing.begin(), facing.begin() + static_cast<std::ptrdiff_t>(kept),
                         [&](const Facing& k) { return is_same_direction(f.facet, k.facet); }))
            facing[kept++] = f;
    facing.resize(kept);
    std::erase_if(facing, [&](const Facing& f) { return f.distance > least + tolerance_; });
    if (facing.empty()) return {};
    const Vec3 first = facing[0].distance * unit(facing[0]);
    if (facing.size() == 1) return first;
    Vec3 sum;
    for (const Facing& f : facing) sum = sum + f.distance * unit(f);
    const double length = norm(sum);
    if (length == 0) return {};
    const Vec3 w = sum / length;
    double reach = std::numeric_limits<double>::infinity();
    for (const Facing& f : facing)
    {
        const double along = dot(w, unit(f));
        if (along > 0) reach = std::min(reach, f.distance / along);
    }
    return reach > longest * reach_ ? first : reach * w;
}

Vec3 GeometryQuery::nearest_of(std::vector<Aside>& aside, double least) const
{
    std::sort(aside.begin(), aside.end(),
              [](const Aside& a, const Aside& b) { return a.facet < b.facet; });
    // Far longer ones are in no group with the shortest, but give their place in the file.
    std::vector<std::pair<std::uint32_t, Aside>> placed;
    for (const Aside& candidate : aside)
    {
        if (candidate.length > least + 4 * tolerance_) continue;
        const auto first = std::find_if(aside.begin(), aside.end(),
                                        [&](const Aside& a)
                                        { return is_same_direction(a.facet, candidate.facet); });
        placed.emplace_back(first->facet, candidate);
    }
    std::stable_sort(
        placed.begin(), placed.end(),
        [](const auto& a, const auto& b)
        { return std::pair(a.first, a.second.length) < std::pair(b.first, b.second.length); });
    std::vector<Aside> shortest;
    for (std::size_t i = 0; i < placed.size(); ++i)
        if (i == 0 || placed[i].first != placed[i - 1].first) shortest.push_back(placed[i].second);
    if (const auto crossing = crossing_of_three(shortest)) return *crossing;
    return std::min_element(shortest.begin(), shortest.end(),
                            [](const Aside& a, const Aside& b) { return a.length < b.length; })
        ->vector;
}

std::optional<Vec3> GeometryQuery::crossing_of_three(const std::vector<Aside>& aside) const
{
    double length = std::numeric_limits<double>::infinity();
    std::size_t count = 0;
    for (const Aside& a : aside)
    {
        if (std::fabs(a.length - length) <= tolerance_)
            ++count;
        else if (a.length < length)
        {
            length = a.length;
            count = 1;
        }
    }
    if (count != 3) return std::nullopt;
    std::array<Vec3, 3> unit;
    std::array<double, 3> distance{};
    std::size_t k = 0;
    for (const Aside& a : aside)
    {
        if (k == 3 || std::fabs(a.length - length) > tolerance_) continue;
        unit[k] = facets_[a.facet].unit;
        distance[k] = dot(a.vector, unit[k]);
        ++k;
    }
    const Vec3 across = cross(unit[1], unit[2]);
    const double volume = dot(unit[0], across);
    const Vec3 point = (distance[0] * across + distance[1] * cross(unit[2], unit[0]) +
                        distance[2] * cross(unit[0], unit[1])) /
                       volume;
    // Not a number where the planes are parallel.
    if (!(norm(point) <= longest * reach_)) return std::nullopt;
    return point;
}

} // namespace fppg
