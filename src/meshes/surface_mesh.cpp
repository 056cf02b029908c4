#include "fppg/surface_mesh.h"

namespace fppg
{

TriangleSoup soup_of(const SurfaceMesh& mesh)
{
    TriangleSoup soup;
    soup.vertices.reserve(3 * mesh.facets.size());
    for (const auto& facet : mesh.facets)
        for (const std::uint32_t v : facet) soup.vertices.push_back(mesh.vertices[v]);
    return soup;
}

} // namespace fppg
