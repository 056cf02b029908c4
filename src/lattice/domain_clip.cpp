#include "lattice/domain_clip.h"

#include "shapes/mesh_builder.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fppg
{
namespace
{

/// A corner as the file has it, and where it is placed.
struct Corner
{
    Vec3 in_file;
    Vec3 placed;
};

struct Side
{
    int axis;
    bool is_upper;
    double limit;
    const Transform& place;

    double inside(const Corner& c) const
    {
        return is_upper ? limit - c.placed[axis] : c.placed[axis] - limit;
    }

    Corner crossing(const Corner& a, const Corner& b) const
    {
        const double va = inside(a);
        const double share = va / (va - inside(b));
        const Vec3 p = a.in_file + (b.in_file - a.in_file) * share;
        Corner c{p, place(p)};
        c.placed[axis] = limit;
        return c;
    }
};

void cut_at(const Side& side, const std::vector<Corner>& polygon, std::vector<Corner>& kept)
{
    kept.clear();
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        const Corner& p = polygon[i];
        if (side.inside(p) >= 0)
        {
            kept.push_back(p);
            continue;
        }
        const Corner& before = polygon[(i + n - 1) % n];
        const Corner& after = polygon[(i + 1) % n];
        if (side.inside(before) >= 0) kept.push_back(side.crossing(before, p));
        if (side.inside(after) >= 0) kept.push_back(side.crossing(p, after));
    }
}

void add_face(const std::vector<Corner>& polygon, const Transform& place, bool keeps_quads,
              FigureOp& out)
{
    FigureFace face;
    std::vector<Vec3> in_file;
    for (const Corner& c : polygon)
    {
        const Vec3& p = c.in_file;
        in_file.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        face.vertices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
        out.vertices.push_back(place(in_file.back()));
    }
    const std::vector<std::uint32_t>& v = face.vertices;
    if (!keeps_quads)
        for (std::size_t i = 2; i < v.size(); ++i) face.triangles.push_back({v[0], v[i - 1], v[i]});
    else if (v.size() > 4)
        for (const auto& corners : cut_into_ears(in_file))
            face.triangles.push_back({v[corners[0]], v[corners[1]], v[corners[2]]});
    out.faces.push_back(std::move(face));
}

} // namespace

Box3 clip_box(const CaseDef& def, double resize)
{
    Box3 box;
    for (int axis = 0; axis < 3; ++axis)
    {
        box.min[axis] = def.case_pos_min[axis] - resize;
        box.max[axis] = def.case_pos_max[axis] + resize;
    }
    return box;
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

FigureOp clip_to_box(const MeshFile& mesh, const Transform& place, const Box3& box,
                     bool keeps_quads)
{
    FigureOp out;
    std::vector<Corner> polygon;
    std::vector<Corner> kept;
    const auto add_corner = [&](const Vec3& p) { polygon.push_back({p, place(p)}); };
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
                cut_at({axis, is_upper, is_upper ? box.max[axis] : box.min[axis], place}, polygon,
                       kept);
                polygon.swap(kept);
            }
        if (polygon.size() >= 3) add_face(polygon, place, keeps_quads, out);
    }
    return out;
}

} // namespace fppg
