#pragma once

#include "fppg/vec.h"

#include <cstddef>

namespace fppg
{

/// What is left of a facet between planes across the axes: at most nine corners after six cuts.
struct Outline
{
    Vec3 corners[9];
    std::size_t count = 0;

    void add(const Vec3& p) { corners[count++] = p; }
};

/// The part of an outline on one side of the plane at `at` metres across an axis; what lies on the
/// plane is kept.
inline Outline cut_outline(const Outline& outline, int axis, double at, bool keeps_above)
{
    const auto is_kept = [&](const Vec3& p) { return keeps_above ? p[axis] >= at : p[axis] <= at; };
    Outline result;
    for (std::size_t i = 0; i < outline.count; ++i)
    {
        const Vec3& p = outline.corners[i];
        const Vec3& q = outline.corners[(i + 1) % outline.count];
        if (is_kept(p)) result.add(p);
        if (is_kept(p) == is_kept(q)) continue;
        Vec3 cut = p + (q - p) * ((at - p[axis]) / (q[axis] - p[axis]));
        cut[axis] = at;
        result.add(cut);
    }
    return result;
}

/// What of the area of a facet is in a box, m^2.
///
/// corners  three
inline double area_in_box(const Box3& box, const Vec3* corners)
{
    Outline outline;
    Box3 bounds;
    for (int k = 0; k < 3; ++k)
    {
        outline.add(corners[k]);
        bounds.add(corners[k]);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
        if (bounds.max[axis] < box.min[axis] || bounds.min[axis] > box.max[axis]) return 0;
        if (bounds.min[axis] < box.min[axis])
            outline = cut_outline(outline, axis, box.min[axis], true);
        if (bounds.max[axis] > box.max[axis])
            outline = cut_outline(outline, axis, box.max[axis], false);
    }
    Vec3 twice;
    for (std::size_t i = 2; i < outline.count; ++i)
        twice = twice + cross(outline.corners[i - 1] - outline.corners[0],
                              outline.corners[i] - outline.corners[0]);
    return 0.5 * norm(twice);
}

} // namespace fppg
