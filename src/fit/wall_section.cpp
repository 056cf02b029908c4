#include "fit/wall_section.h"

namespace fppg
{

WallSection wall_section(const SurfaceMesh& mesh, double plane_y)
{
    WallSection section;
    for (const bool on_plane_is_above : {false, true})
    {
        const auto is_above = [&](const Vec3& p)
        { return on_plane_is_above ? p.y >= plane_y : p.y > plane_y; };
        for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        {
            Vec3 ends[2]; // where the outline goes down through the plane, and where up
            int cuts = 0;
            for (std::size_t s = 0; s < 3; ++s)
            {
                const Vec3& p = mesh.vertices[mesh.facets[f][s]];
                const Vec3& q = mesh.vertices[mesh.facets[f][(s + 1) % 3]];
                if (is_above(p) == is_above(q)) continue;
                // From below to above, so that both facets of an edge find the same bits.
                const Vec3& low = is_above(p) ? q : p;
                const Vec3& high = is_above(p) ? p : q;
                Vec3 cut = low + (high - low) * ((plane_y - low.y) / (high.y - low.y));
                cut.y = plane_y;
                ends[is_above(p) ? 0 : 1] = cut;
                ++cuts;
            }
            if (cuts != 2 || ends[0] == ends[1]) continue;
            const Vec3 along = ends[1] - ends[0];
            const Vec3 side{-along.z, 0, along.x};
            const double length = norm(along);
            section.soup.vertices.insert(section.soup.vertices.end(), {ends[0], ends[1], ends[1]});
            section.normals.push_back(side * ((dot(side, mesh.normals[f]) < 0 ? -1 : 1) / length));
            section.lengths.push_back(length);
            section.facets.push_back(static_cast<std::uint32_t>(f));
        }
        if (section.soup.size() > 0) break;
    }
    return section;
}

} // namespace fppg
