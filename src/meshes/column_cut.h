#pragma once

#include "core/predicates.h"
#include "fppg/vec.h"

namespace fppg
{

/// A facet seen along an axis, for the question where lines along that axis pass through it.
/// Coordinates are turned so that the axis is z (x -> y -> z -> x); the orientation is kept.
struct ColumnFacet
{
    Vec3 a;
    Vec3 b;
    Vec3 c;
    int facing = 0; ///< +1 the outside is above, -1 below, 0 the facet is parallel to the axis

    /// corners  three, counter-clockwise from outside; axis 0, 1 or 2
    ColumnFacet(const Vec3* corners, int axis)
        : a(turned(corners[0], axis)),
          b(turned(corners[1], axis)),
          c(turned(corners[2], axis)),
          facing(orient2d(a.x, a.y, b.x, b.y, c.x, c.y))
    {
    }

    static Vec3 turned(const Vec3& p, int axis)
    {
        return {p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]};
    }
};

/// How a column lies to a facet that is not parallel to it.
struct ColumnCut
{
    bool is_crossed = false;   ///< the column, moved by an infinitesimal amount, passes through it
    bool is_on_border = false; ///< the column passes exactly through an edge or a vertex
};

/// The column at (x, y) is taken to stand at (x + e, y + e^2), e > 0 and smaller than any number:
/// there it meets no edge, so that of the facets around an edge or a vertex exactly those are
/// crossed that a neighbouring column would cross.
inline ColumnCut cut_column(const ColumnFacet& facet, double x, double y)
{
    ColumnCut cut;
    if (facet.facing == 0) return cut;
    bool is_crossed = true;
    bool is_on_border = false;
    const Vec3* const corners[4] = {&facet.a, &facet.b, &facet.c, &facet.a};
    for (int i = 0; i < 3; ++i)
    {
        const Vec3& p = *corners[i];
        const Vec3& q = *corners[i + 1];
        int side = orient2d(p.x, p.y, q.x, q.y, x, y);
        if (side == -facet.facing) return cut;
        if (side == 0)
        {
            is_on_border = true;
            side = p.y != q.y ? sign_of(p.y - q.y) : sign_of(q.x - p.x);
        }
        is_crossed = is_crossed && side == facet.facing;
    }
    cut.is_crossed = is_crossed;
    cut.is_on_border = is_on_border;
    return cut;
}

/// Where the plane of a facet stands above (x, y), and how far rounding may have moved it.
struct Height
{
    double z = 0;
    double error = 0;
};

/// facet  not parallel to the column; (x, y) within it or on its border
Height height_above(const ColumnFacet& facet, double x, double y);

/// -1 if (x, y, z) lies below the plane of the facet, 0 in it, +1 above; exact.
inline int side_of_plane(const ColumnFacet& facet, double x, double y, double z)
{
    if (facet.a.z == facet.b.z && facet.b.z == facet.c.z) return sign_of(z - facet.a.z);
    return -facet.facing * orient3d(facet.a, facet.b, facet.c, {x, y, z});
}

} // namespace fppg
