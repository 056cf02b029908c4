#include "lattice/domain_clip.h"

#include <vector>

namespace fppg
{

FigureOp clip_to_box(const TriangleSoup& soup, const Box3& box)
{
    FigureOp out;
    std::vector<Vec3> polygon;
    std::vector<Vec3> kept;
    for (std::size_t t = 0; t < soup.size(); ++t)
    {
        polygon.assign(soup.vertices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                       soup.vertices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
        for (int side = 0; side < 6; ++side)
        {
            const int axis = side / 2;
            const bool is_upper = side % 2 == 1;
            const double limit = is_upper ? box.max[axis] : box.min[axis];
            const auto inside = [&](const Vec3& p)
            { return is_upper ? limit - p[axis] : p[axis] - limit; };
            kept.clear();
            for (std::size_t i = 0; i < polygon.size(); ++i)
            {
                const Vec3& a = polygon[i];
                const Vec3& b = polygon[(i + 1) % polygon.size()];
                const double va = inside(a);
                const double vb = inside(b);
                if (va >= 0) kept.push_back(a);
                if ((va > 0 && vb < 0) || (va < 0 && vb > 0))
                {
                    kept.push_back(a + (b - a) * (va / (va - vb)));
                    kept.back()[axis] = limit;
                }
            }
            polygon.swap(kept);
        }
        if (polygon.size() < 3) continue;
        FigureFace face;
        for (const Vec3& p : polygon)
        {
            face.vertices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
            out.vertices.push_back(p);
        }
        if (polygon.size() > 4) face.cut = face.vertices;
        out.faces.push_back(std::move(face));
    }
    return out;
}

} // namespace fppg
