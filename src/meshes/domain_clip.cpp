#include "fppg/domain_clip.h"
#include "fppg/shapes.h"

#include "core/float32.h"
#include "meshes/cut_at_plane.h"
#include "meshes/mesh_builder.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fppg
{
namespace
{

struct Side
{
    int axis;
    bool is_upper;
    double limit;

    bool holds(const Vec3& p) const { return is_upper ? p[axis] <= limit : p[axis] >= limit; }

    Vec3 crossing(const Vec3& a, const Vec3& b) const
    {
        return a + (b - a) * ((limit - a[axis]) / (b[axis] - a[axis]));
    }
};

/// The way back. Without one, where a scale of 0 flattens, all goes to the origin.
Transform inverse(const Transform& t)
{
    const auto& [a, b, c] = t.linear;
    const Vec3 bc = cross(b, c);
    const Vec3 ca = cross(c, a);
    const Vec3 ab = cross(a, b);
    const double volume = dot(a, bc);
    Transform back;
    if (volume == 0)
        back.linear = {};
    else
        back.linear = {Vec3{bc.x, ca.x, ab.x} / volume, Vec3{bc.y, ca.y, ab.y} / volume,
                       Vec3{bc.z, ca.z, ab.z} / volume};
    back.offset = Transform{back.linear, {}}(t.offset) * -1.0;
    return back;
}

void add_polygon(const std::vector<Vec3>& corners, const MeshReading& reading, MeshFile& out)
{
    const ShapeSelection& shapes = reading.shapes;
    const bool takes_others = shapes.triangles && shapes.quads && shapes.other_polygons;
    const std::size_t n = corners.size();
    if (n < 3 || !(n == 3 ? shapes.triangles : n == 4 ? shapes.quads : takes_others)) return;
    const auto first = static_cast<std::uint32_t>(out.soup.size());
    const auto add_triangle = [&](std::size_t a, std::size_t b, std::size_t c)
    {
        for (const std::size_t i : {a, b, c}) out.soup.vertices.push_back(corners[i]);
    };
    if (n > 4 && reading.format != MeshFormat::Stl)
    {
        out.wide_polygons.push_back({first, corners});
        for (const auto& [a, b, c] : cut_into_ears(corners)) add_triangle(a, b, c);
        return;
    }
    if (n == 4 && reading.format != MeshFormat::Stl) out.quads.push_back(first);
    for (std::size_t i = 2; i < n; ++i) add_triangle(0, i - 1, i);
}

} // namespace

MeshReading reading_to_clip(MeshReading reading)
{
    reading.shapes = {};
    return reading;
}

Box3 clip_box(const Vec3& domain_min, const Vec3& domain_max, double resize)
{
    const Vec3 more{resize, resize, resize};
    return {domain_min - more, domain_max + more};
}

bool is_within(const MeshFile& mesh, const Transform& place, const Box3& box)
{
    const auto is_in = [&](const Vec3& p)
    {
        const Vec3 q = place(p);
        for (int axis = 0; axis < 3; ++axis)
            if (q[axis] < box.min[axis] || q[axis] > box.max[axis]) return false;
        return true;
    };
    const auto all_in = [&](const std::vector<Vec3>& points)
    { return std::all_of(points.begin(), points.end(), is_in); };
    return all_in(mesh.soup.vertices) && all_in(mesh.points) &&
           std::all_of(mesh.lines.begin(), mesh.lines.end(), all_in);
}

MeshFile clip_to_box(const MeshFile& mesh, const Transform& place, const Box3& box,
                     const MeshReading& reading)
{
    MeshFile out;
    const Transform back = inverse(place);
    std::vector<Vec3> polygon;
    std::vector<Vec3> kept;
    const auto add_corner = [&](const Vec3& p) { polygon.push_back(place(p)); };
    auto quad = mesh.quads.begin();
    auto wide = mesh.wide_polygons.begin();
    for (std::size_t t = 0; t < mesh.soup.size();)
    {
        polygon.clear();
        if (wide != mesh.wide_polygons.end() && wide->first == t)
        {
            for (const Vec3& p : wide->corners) add_corner(p);
            t += wide->corners.size() - 2;
            ++wide;
        }
        else
        {
            for (std::size_t i = 0; i < 3; ++i) add_corner(mesh.soup.vertices[3 * t + i]);
            if (quad != mesh.quads.end() && *quad == t)
            {
                ++quad;
                add_corner(mesh.soup.vertices[3 * ++t + 2]);
            }
            ++t;
        }
        for (const bool is_upper : {false, true})
            for (int axis = 0; axis < 3; ++axis)
            {
                const Side side{axis, is_upper, is_upper ? box.max[axis] : box.min[axis]};
                cut_at_plane(
                    polygon, [&](const Vec3& p) { return side.holds(p); },
                    [&](const Vec3& p, const Vec3& q) { return side.crossing(p, q); }, kept);
                polygon.swap(kept);
            }
        kept.clear();
        for (const Vec3& p : polygon) kept.push_back(as_float32(back(p)));
        add_polygon(kept, reading, out);
    }
    return out;
}

} // namespace fppg
