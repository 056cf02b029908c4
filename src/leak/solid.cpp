#include "leak/solid.h"

namespace fppg
{

Solid::Solid(TriangleSoup soup, std::vector<ClipPlane> clips, int threads)
    : inside_(std::move(soup), threads), clips_(std::move(clips))
{
    for (const Vec3& v : inside_.query().soup().vertices) bounds_.add(v);
}

bool Solid::is_inside(const Vec3& p) const
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < bounds_.min[axis] || p[axis] > bounds_.max[axis]) return false;
    for (const ClipPlane& clip : clips_)
        if (dot(p - clip.point, clip.normal) > 0) return false;
    return inside_.winding(p) != 0;
}

bool Solid::is_nearer(const Vec3& p, double distance) const
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < bounds_.min[axis] - distance || p[axis] > bounds_.max[axis] + distance)
            return false;
    return inside_.query().closest_point(p, distance).distance <= distance;
}

} // namespace fppg
