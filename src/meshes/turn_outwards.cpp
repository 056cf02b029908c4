#include "meshes/turn_outwards.h"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "core/parallel.h"
#include "meshes/mesh_facets.h"
#include "meshes/mesh_query.h"

namespace fppg
{

namespace
{

struct Shell
{
    Box3 bounds;
    std::vector<std::uint32_t> probes; ///< a few facets, evenly spread
    std::uint32_t first = no_index;
    std::size_t facets = 0;
    double volume = 0; ///< times six
    double area = 0;   ///< times two
    Vec3 area_vector;  ///< times two
    bool is_closed() const { return norm(area_vector) < 0.1 * area; }
};

std::vector<Shell> measure_shells(const SurfaceMesh& mesh, std::size_t count)
{
    std::vector<Shell> shells(count);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        Shell& shell = shells[mesh.shells[f]];
        if (shell.first == no_index) shell.first = static_cast<std::uint32_t>(f);
        ++shell.facets;
        for (const std::uint32_t v : mesh.facets[f]) shell.bounds.add(mesh.vertices[v]);
    }
    std::vector<std::size_t> passed(count, 0);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        Shell& shell = shells[mesh.shells[f]];
        const Facet& c = mesh.facets[f];
        const Vec3 twice = cross(mesh.vertices[c[1]] - mesh.vertices[c[0]],
                                 mesh.vertices[c[2]] - mesh.vertices[c[0]]);
        const Vec3 middle = shell.bounds.min + 0.5 * (shell.bounds.max - shell.bounds.min);
        shell.volume += volume_times_six(mesh, f, middle);
        shell.area += norm(twice);
        shell.area_vector = shell.area_vector + twice;
        const std::size_t step = std::max<std::size_t>(shell.facets / 5, 1);
        if (passed[mesh.shells[f]]++ % step == 0)
            shell.probes.push_back(static_cast<std::uint32_t>(f));
    }
    return shells;
}

/// The closed shells that hold shell s: those that rays from its facets cross an odd number of
/// times, by the vote of a few facets and three axes, so that touching shells do no harm.
std::vector<std::uint32_t> holders(const SurfaceMesh& mesh, const MeshQuery& query,
                                   const std::vector<Shell>& shells, std::uint32_t s)
{
    std::unordered_map<std::uint32_t, std::size_t> votes;
    for (const std::uint32_t f : shells[s].probes)
    {
        const Facet& c = mesh.facets[f];
        const Vec3 at = (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3.0;
        for (int axis = 0; axis < 3; ++axis)
        {
            std::vector<std::uint32_t> crossed;
            for (const Crossing& crossing : query.crossings(at, axis))
                if (mesh.shells[crossing.facet] != s)
                    crossed.push_back(mesh.shells[crossing.facet]);
            std::sort(crossed.begin(), crossed.end());
            for (std::size_t i = 0; i < crossed.size();)
            {
                std::size_t end = i;
                while (end < crossed.size() && crossed[end] == crossed[i]) ++end;
                if ((end - i) % 2 == 1) ++votes[crossed[i]];
                i = end;
            }
        }
    }
    std::vector<std::uint32_t> result;
    for (const auto& [other, count] : votes)
        if (shells[other].is_closed() && 2 * count > 3 * shells[s].probes.size())
            result.push_back(other);
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace

void turn_outwards(SurfaceMesh& mesh, std::size_t count, int threads, std::vector<char>& is_turned)
{
    const std::vector<Shell> shells = measure_shells(mesh, count);
    if (std::none_of(shells.begin(), shells.end(),
                     [](const Shell& s) { return s.is_closed() && s.volume < 0; }))
        return;
    std::vector<char> turn(count, 0);
    if (count == 1)
        turn[0] = 1;
    else
    {
        const MeshQuery query(soup_of(mesh), threads);
        std::vector<std::vector<std::uint32_t>> holding(count);
        parallel_for(count, threads,
                     [&](std::size_t s)
                     { holding[s] = holders(mesh, query, shells, static_cast<std::uint32_t>(s)); });
        for (std::size_t s = 0; s < count; ++s)
            if (holding[s].empty())
                turn[s] = static_cast<char>(shells[s].is_closed() && shells[s].volume < 0);
        for (std::size_t s = 0; s < count; ++s)
            for (const std::uint32_t holder : holding[s])
                if (holding[holder].empty()) turn[s] = turn[holder];
    }
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (turn[mesh.shells[f]] != 0)
        {
            flip(mesh, f);
            is_turned[f] = static_cast<char>(!is_turned[f]);
        }
}

} // namespace fppg
