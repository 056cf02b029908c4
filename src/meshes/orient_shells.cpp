#include "meshes/orient_shells.h"

#include <cstdint>

#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

std::vector<char> orient_shells(SurfaceMesh& mesh, std::size_t& shells)
{
    const std::size_t n = mesh.facets.size();
    mesh.shells.assign(n, no_index);
    std::vector<char> is_turned(n, 0);
    std::vector<std::uint32_t> shell;
    shells = 0;
    for (std::size_t seed = 0; seed < n; ++seed)
    {
        if (mesh.shells[seed] != no_index) continue;
        shell.assign(1, static_cast<std::uint32_t>(seed));
        mesh.shells[seed] = static_cast<std::uint32_t>(shells);
        std::size_t turned = 0;
        for (std::size_t next = 0; next < shell.size(); ++next)
        {
            const std::uint32_t f = shell[next];
            for (std::size_t s = 0; s < 3; ++s)
            {
                const std::uint32_t other = mesh.neighbours[f][s];
                if (other == no_index || mesh.shells[other] != no_index) continue;
                mesh.shells[other] = static_cast<std::uint32_t>(shells);
                shell.push_back(other);
                std::size_t t = 0;
                while (mesh.facet_edges[other][t] != mesh.facet_edges[f][s]) ++t;
                const bool clash = runs_upwards(mesh, f, s) == runs_upwards(mesh, other, t);
                is_turned[other] = static_cast<char>(clash ? !is_turned[f] : is_turned[f]);
                turned += static_cast<std::size_t>(is_turned[other]);
            }
        }
        const bool most = 2 * turned > shell.size();
        for (const std::uint32_t f : shell) is_turned[f] = static_cast<char>(is_turned[f] != most);
        ++shells;
    }
    for (std::size_t f = 0; f < n; ++f)
        if (is_turned[f] != 0) flip(mesh, f);
    return is_turned;
}

} // namespace fppg
