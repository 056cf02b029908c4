#pragma once

#include "fppg/case_def.h"
#include "meshes/inside_test.h"

#include <vector>

namespace fppg
{

/// The true shape of a draw, for asking what is in it. Places are those of the case, before any
/// motion.
class Solid
{
public:
    /// soup   at least one facet
    /// clips  the shape is cut at these
    Solid(TriangleSoup soup, std::vector<ClipPlane> clips, int threads);

    /// InsideTest, where facets that face inwards bound as well.
    bool is_inside(const Vec3& p) const;
    /// Metres to the surface.
    double distance(const Vec3& p) const { return inside_.query().closest_point(p).distance; }
    bool is_nearer(const Vec3& p, double distance) const;
    const Box3& bounds() const { return bounds_; }
    const TriangleSoup& soup() const { return inside_.query().soup(); }

private:
    InsideTest inside_;
    std::vector<ClipPlane> clips_;
    Box3 bounds_;
};

} // namespace fppg
