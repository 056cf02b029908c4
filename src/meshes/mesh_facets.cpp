#include "meshes/mesh_facets.h"

#include <algorithm>
#include <array>

namespace fppg
{

Measures measure(const SurfaceMesh& mesh, const Facet& f)
{
    Measures m;
    const Vec3 &a = mesh.vertices[f[0]], &b = mesh.vertices[f[1]], &c = mesh.vertices[f[2]];
    const std::array<double, 3> sides{norm(b - a), norm(c - b), norm(a - c)};
    m.longest = static_cast<int>(std::max_element(sides.begin(), sides.end()) - sides.begin());
    const double longest = sides[static_cast<std::size_t>(m.longest)];
    if (!(longest > 0)) return m;
    // Divided first, so that neither tiny nor huge facets leave the range of double.
    const Vec3 n = cross((b - a) / longest, (c - a) / longest);
    const double length = norm(n);
    m.area = 0.5 * length * longest * longest;
    m.height = length * longest;
    if (length > 0) m.normal = n / length;
    return m;
}

void erase_facets(const std::vector<char>& is_dropped, SurfaceMesh& mesh)
{
    std::size_t kept = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        if (is_dropped[f] == 0) mesh.facets[kept++] = mesh.facets[f];
    mesh.facets.resize(kept);
}

} // namespace fppg
