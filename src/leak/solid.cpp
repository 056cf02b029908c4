#include "leak/solid.h"

#include <algorithm>
#include <cmath>

namespace fppg
{

Solid::Solid(TriangleSoup soup, std::vector<ClipPlane> clips, int threads)
    : query_(std::move(soup), threads),
      winding_(std::make_unique<WindingTree>(query_.soup())),
      clips_(std::move(clips))
{
    for (const Vec3& v : query_.soup().vertices) bounds_.add(v);
}

bool Solid::is_inside(const Vec3& p) const
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < bounds_.min[axis] || p[axis] > bounds_.max[axis]) return false;
    for (const ClipPlane& clip : clips_)
        if (dot(p - clip.point, clip.normal) > 0) return false;
    int votes = 0;
    int in = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3 from = p;
        from[axis] = bounds_.min[axis] - 1 - 0.01 * std::abs(bounds_.min[axis]);
        int before = 0;
        int all = 0;
        for (const Crossing& c : query_.crossings(from, axis))
        {
            all += c.step;
            if (c.position < p[axis]) before += c.step;
        }
        if (all != 0) continue;
        ++votes;
        // Facets that look inwards bound as well.
        in += before != 0 ? 1 : 0;
    }
    if (votes >= 2 && (in == 0 || in == votes)) return in > 0;
    return std::abs(winding_->winding_number(p)) > 0.5;
}

bool Solid::is_nearer(const Vec3& p, double distance) const
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < bounds_.min[axis] - distance || p[axis] > bounds_.max[axis] + distance)
            return false;
    return query_.closest_point(p, distance).distance <= distance;
}

} // namespace fppg
