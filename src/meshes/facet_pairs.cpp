#include "meshes/facet_pairs.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/predicates.h"
#include "meshes/box_tree.h"

namespace fppg
{

namespace
{

using Corners = std::array<Vec3, 3>;

/// Whether `a` reaches farther than `depth` to both sides of `b`'s plane.
bool reaches_through(const Corners& a, const Corners& b, double depth)
{
    const Vec3 normal = cross(b[1] - b[0], b[2] - b[0]);
    double lowest = 0, highest = 0;
    for (const Vec3& p : a)
    {
        lowest = std::min(lowest, dot(p - b[0], normal));
        highest = std::max(highest, dot(p - b[0], normal));
    }
    const double least = depth * norm(normal);
    return lowest < -least && highest > least;
}

/// Whether a side of `a` has its ends on both sides of `b`'s plane and passes inside the facet.
bool pierces(const Corners& a, const Corners& b)
{
    std::array<int, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) side[i] = orient3d(b[0], b[1], b[2], a[i]);
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::size_t j = (i + 1) % 3;
        if (side[i] * side[j] >= 0) continue;
        int turns = 0;
        for (std::size_t k = 0; k < 3; ++k) turns += orient3d(a[i], a[j], b[k], b[(k + 1) % 3]);
        if (turns == 3 || turns == -3) return true;
    }
    return false;
}

/// Whether two facets cross, each reaching farther than `depth` through the other's plane.
bool cross_deeply(const Corners& a, const Corners& b, double depth)
{
    if (depth > 0 && !(reaches_through(a, b, depth) && reaches_through(b, a, depth))) return false;
    return pierces(a, b) || pierces(b, a);
}

FacetPairs find_pairs(const SurfaceMesh& mesh, bool of_one_shell, double depth, int threads)
{
    const std::size_t n = mesh.facets.size();
    const auto corners_of = [&mesh](std::size_t f)
    {
        const auto& c = mesh.facets[f];
        return Corners{mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]};
    };
    std::vector<Box3> boxes(n);
    parallel_for(
        n, threads,
        [&](std::size_t f)
        {
            for (const Vec3& p : corners_of(f)) boxes[f].add(p);
        },
        4096);
    const BoxTree tree(boxes, threads);

    const auto cross = [&](std::uint32_t f, std::uint32_t other)
    {
        if (of_one_shell && mesh.shells[other] != mesh.shells[f]) return false;
        for (const std::uint32_t v : mesh.facets[f])
            if (std::find(mesh.facets[other].begin(), mesh.facets[other].end(), v) !=
                mesh.facets[other].end())
                return false;
        return cross_deeply(corners_of(f), corners_of(other), depth);
    };
    std::vector<FacetPairs> of_group(tree.groups());
    parallel_for(
        of_group.size(), threads,
        [&](std::size_t group)
        {
            tree.for_each_pair_of(
                group,
                [&](std::uint32_t f, std::uint32_t other)
                {
                    if (!cross(f, other)) return;
                    FacetPairs& pairs = of_group[group];
                    ++pairs.count;
                    pairs.first = std::min(pairs.first, {std::min(f, other), std::max(f, other)});
                });
        },
        16);
    FacetPairs all;
    for (const FacetPairs& pairs : of_group)
    {
        all.count += pairs.count;
        all.first = std::min(all.first, pairs.first);
    }
    return all;
}

} // namespace

FacetPairs find_crossing_facets(const SurfaceMesh& mesh, int threads)
{
    return find_pairs(mesh, false, 0, threads);
}

FacetPairs find_folded_facets(const SurfaceMesh& mesh, double depth, int threads)
{
    return find_pairs(mesh, true, depth, threads);
}

} // namespace fppg
