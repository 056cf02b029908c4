#pragma once

#include "fppg/case_def.h"
#include "meshes/mesh_query.h"
#include "meshes/winding_tree.h"

#include <memory>

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

    /// By the sum of signed crossings along each axis, where two axes at least balance and all that
    /// balance agree; else by the winding number.
    bool is_inside(const Vec3& p) const;
    /// Metres to the surface.
    double distance(const Vec3& p) const { return query_.closest_point(p).distance; }
    bool is_nearer(const Vec3& p, double distance) const;
    const Box3& bounds() const { return bounds_; }

private:
    MeshQuery query_;
    std::unique_ptr<WindingTree> winding_;
    std::vector<ClipPlane> clips_;
    Box3 bounds_;
};

} // namespace fppg
