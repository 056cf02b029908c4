#include "fit/closed_part.h"

#include "core/disjoint_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fppg
{

namespace
{

constexpr double largest_hole_share = 0.1;
/// Volume over area to the power 1.5 below which a shell is a sheet folded on itself; a plate a
/// ten-thousandth as thick as it is wide has 4e-5.
constexpr double flattest = 1e-7;

/// A side of a facet that no other facet of its group continues.
struct Rim
{
    std::uint32_t group;
    std::uint32_t from;
    std::uint32_t to;
};

struct Group
{
    double area = 0;
    double volume = 0; ///< about the middle of the mesh; with holes closed
    double hole_area = 0;
    bool has_rim = false;

    bool is_closed() const
    {
        return hole_area < largest_hole_share * area &&
               std::abs(volume) > flattest * area * std::sqrt(area);
    }
};

/// The sides of each group whose edge its facets do not run along equally often both ways.
std::vector<Rim> find_rims(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& group_of)
{
    struct Side
    {
        std::uint32_t group;
        std::uint32_t edge;
        int way;
    };
    std::vector<Side> sides;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        if (group_of[f] == no_index) continue;
        for (std::size_t s = 0; s < 3; ++s)
        {
            const std::uint32_t from = mesh.facets[f][s];
            const std::uint32_t to = mesh.facets[f][(s + 1) % 3];
            const std::uint32_t other = mesh.neighbours[f][s];
            bool continues = false;
            if (other != no_index && group_of[other] == group_of[f])
                for (std::size_t t = 0; t < 3; ++t)
                    continues = continues || (mesh.facets[other][t] == to &&
                                              mesh.facets[other][(t + 1) % 3] == from);
            if (!continues)
                sides.push_back({group_of[f], mesh.facet_edges[f][s], from < to ? 1 : -1});
        }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b)
              { return a.group != b.group ? a.group < b.group : a.edge < b.edge; });
    std::vector<Rim> rims;
    for (std::size_t i = 0; i < sides.size();)
    {
        const Side& first = sides[i];
        int sum = 0;
        for (; i < sides.size() && sides[i].group == first.group && sides[i].edge == first.edge;
             ++i)
            sum += sides[i].way;
        const auto [low, high] = mesh.edges[first.edge];
        for (int n = 0; n < std::abs(sum); ++n)
            rims.push_back(sum > 0 ? Rim{first.group, low, high} : Rim{first.group, high, low});
    }
    return rims;
}

/// Closes every loop of rims with a fan around the mean of its vertices.
void close_holes(const SurfaceMesh& mesh, const std::vector<Rim>& rims, const Vec3& middle,
                 std::vector<Group>& groups)
{
    for (std::size_t i = 0; i < rims.size();)
    {
        std::size_t end = i;
        while (end < rims.size() && rims[end].group == rims[i].group) ++end;
        std::vector<std::uint32_t> vertices;
        for (std::size_t r = i; r < end; ++r)
            for (const std::uint32_t v : {rims[r].from, rims[r].to}) vertices.push_back(v);
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        const auto number_of = [&](std::uint32_t v)
        {
            return static_cast<std::uint32_t>(
                std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
        };
        DisjointSet loops(vertices.size());
        for (std::size_t r = i; r < end; ++r)
            loops.join(number_of(rims[r].from), number_of(rims[r].to));
        struct Centre
        {
            Vec3 sum;
            double count = 0;
        };
        std::vector<Centre> centres(vertices.size());
        for (std::size_t r = i; r < end; ++r)
        {
            Centre& centre = centres[loops.find(number_of(rims[r].from))];
            centre.sum = centre.sum + mesh.vertices[rims[r].from] + mesh.vertices[rims[r].to];
            centre.count += 2;
        }
        Group& group = groups[rims[i].group];
        group.has_rim = true;
        for (std::size_t r = i; r < end; ++r)
        {
            const Centre& centre = centres[loops.find(number_of(rims[r].from))];
            const Vec3 c = centre.sum / centre.count - middle;
            const Vec3 a = mesh.vertices[rims[r].to] - middle;
            const Vec3 b = mesh.vertices[rims[r].from] - middle;
            group.hole_area += 0.5 * norm(cross(a - c, b - c));
            group.volume += dot(a, cross(b, c)) / 6;
        }
        i = end;
    }
}

std::vector<Group> measure_groups(const SurfaceMesh& mesh,
                                  const std::vector<std::uint32_t>& group_of, std::size_t count,
                                  const Vec3& middle)
{
    std::vector<Group> groups(count);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        if (group_of[f] == no_index) continue;
        const auto& corners = mesh.facets[f];
        const Vec3 a = mesh.vertices[corners[0]] - middle;
        const Vec3 b = mesh.vertices[corners[1]] - middle;
        const Vec3 c = mesh.vertices[corners[2]] - middle;
        groups[group_of[f]].area += mesh.areas[f];
        groups[group_of[f]].volume += dot(a, cross(b, c)) / 6;
    }
    close_holes(mesh, find_rims(mesh, group_of), middle, groups);
    return groups;
}

} // namespace

ClosedPart find_closed_part(const SurfaceMesh& mesh)
{
    ClosedPart part;
    part.is_bounding.assign(mesh.facets.size(), 0);
    Box3 bounds;
    for (const auto& facet : mesh.facets)
        for (const std::uint32_t v : facet) bounds.add(mesh.vertices[v]);
    const Vec3 middle = bounds.min + 0.5 * (bounds.max - bounds.min);

    std::vector<std::uint32_t> group_of = mesh.shells;
    const std::uint32_t shells =
        group_of.empty() ? 0 : *std::max_element(group_of.begin(), group_of.end()) + 1;
    const std::vector<Group> alone = measure_groups(mesh, group_of, shells, middle);
    for (std::uint32_t& group : group_of) group = alone[group].is_closed() ? no_index : 0;
    const std::vector<Group> together = measure_groups(mesh, group_of, 1, middle);
    const bool closes_together = together[0].is_closed() && together[0].volume > 0;

    const auto take = [&part](const Group& group)
    {
        part.is_exact = part.is_exact && !group.has_rim;
        part.hole_area += group.hole_area;
        part.volume += group.volume;
    };
    for (const Group& group : alone)
        if (group.is_closed()) take(group);
    if (closes_together) take(together[0]);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        part.is_bounding[f] = static_cast<char>(group_of[f] == no_index || closes_together ? 1 : 0);
        if (part.is_bounding[f] == 0) ++part.sheet_facets;
    }
    if (!(part.volume > 0))
    {
        part.is_bounding.assign(mesh.facets.size(), 0);
        part.sheet_facets = mesh.facets.size();
        part.volume = part.hole_area = 0;
    }
    return part;
}

TriangleSoup soup_of_closed_part(const SurfaceMesh& mesh, const ClosedPart& part)
{
    TriangleSoup soup;
    soup.vertices.reserve(3 * (mesh.facets.size() - part.sheet_facets));
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (part.is_bounding[f] != 0)
            for (const std::uint32_t v : mesh.facets[f]) soup.vertices.push_back(mesh.vertices[v]);
    return soup;
}

} // namespace fppg
