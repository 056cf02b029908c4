// Commands that set clips.
#include "casedef/command_table.h"
#include "core/transforms.h"
#include "shapes/polyhedra.h"

#include <algorithm>
#include <array>

namespace fppg::commands
{

void reset_clips(Program& p, const Element&)
{
    p.state.clips.clear();
    p.defined_clips.clear();
    p.clip_matrix = {};
}

void clip_domain(Program& p, const Element& e)
{
    const double resize = std::max(0.0, p.read.number_or(e, "resize", 0));
    const Vec3 low = p.def.case_pos_min - Vec3{resize, resize, resize};
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3 high = low;
        high[axis] = p.def.case_pos_max[axis] + resize;
        Vec3 upwards;
        upwards[axis] = 1;
        p.add_clip({low, upwards * -1.0});
        p.add_clip({high, upwards});
    }
}

void clip_plane(Program& p, const Element& e)
{
    ClipPlane plane;
    if (e.find_child("point1") != nullptr)
    {
        plane.point = p.read.child_vec3(e, "point1");
        plane.normal = cross(p.read.child_vec3(e, "point2") - plane.point,
                             p.read.child_vec3(e, "point3") - plane.point);
    }
    else
        plane = {p.read.child_vec3(e, "point"), p.read.child_vec3(e, "vector")};
    if (norm(plane.normal) == 0)
        p.read.fail(e, "the plane has no direction, expected a vector that is not zero");
    p.add_clip(plane);
}

/// The angles of a clipbox turn it about its lowest corner, about y, x and z in this order,
/// right-handed (found by experiment with GenCase v5.4.354: of the orders, signs and centres tried
/// only this one fits). clipdomain clips at <pointmin> and <pointmax>, farther out by resize; a
/// resize below 0 counts as 0 (a ball on the border of the domain, resize 0, 0.1, -0.1, -0.3). Its
/// lower planes go through the lowest corner, the upper ones through that corner moved along their
/// axis, which matters where a matrix shears (planes fitted to a shapeout).
void clip_box(Program& p, const Element& e)
{
    std::array<bool, 6> faces{true, true, true, true, true, true};
    if (const Element* which = e.find_child("boxfaces")) faces = p.box_sides(e, *which).sides;
    const BoxRegion box = p.box_of(e);
    Vec3 low;
    Vec3 high;
    for (int axis = 0; axis < 3; ++axis)
    {
        low[axis] = std::min(box.corner0[axis], box.corner1[axis]);
        high[axis] = std::max(box.corner0[axis], box.corner1[axis]);
    }
    Transform turned;
    if (const Element* c = e.find_child("angles"))
    {
        Transform rotation;
        const Vec3 angles = p.read.vec3(*c);
        for (const int axis : {2, 0, 1})
            rotation = rotation * rotation_about_axis(axis, radians(angles[axis]));
        turned = around(low, rotation);
    }
    const bool is_turned = !turned.is_identity();
    const auto side = [&](BoxSide which, const Vec3& at, const Vec3& outward)
    {
        if (!faces[which]) return;
        ClipPlane plane{at, outward};
        if (is_turned) plane = placed_clip(plane, turned);
        p.add_clip(plane);
    };
    side(BoxBottom, low, {0, 0, -1});
    side(BoxTop, is_turned ? high : Vec3{low.x, low.y, high.z}, {0, 0, 1});
    side(BoxLeft, low, {-1, 0, 0});
    side(BoxRight, is_turned ? high : Vec3{high.x, low.y, low.z}, {1, 0, 0});
    side(BoxFront, low, {0, -1, 0});
    side(BoxBack, is_turned ? high : Vec3{high.x, high.y, low.z}, {0, 1, 0});
}

} // namespace fppg::commands
