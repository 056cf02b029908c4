#include "lattice/domain_clip.h"

#include <vector>

namespace fppg
{

TriangleSoup clip_to_box(const TriangleSoup& soup, const Box3& box)
{
    TriangleSoup out;
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
        for (std::size_t i = 2; i < polygon.size(); ++i)
            out.vertices.insert(out.vertices.end(), {polygon[0], polygon[i - 1], polygon[i]});
    }
    return out;
}

} // namespace fppg
