#include "lattice/domain_clip.h"

#include "shapes/mesh_builder.h"

#include <cstdint>
#include <span>
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

    double inside(const Vec3& p) const { return is_upper ? limit - p[axis] : p[axis] - limit; }

    Vec3 crossing(const Vec3& a, const Vec3& b) const
    {
        const double va = inside(a);
        Vec3 p = a + (b - a) * (va / (va - inside(b)));
        p[axis] = limit;
        return p;
    }
};

void cut_at(const Side& side, const std::vector<Vec3>& polygon, std::vector<Vec3>& kept)
{
    kept.clear();
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        const Vec3& p = polygon[i];
        if (side.inside(p) >= 0)
        {
            kept.push_back(p);
            continue;
        }
        const Vec3& before = polygon[(i + n - 1) % n];
        const Vec3& after = polygon[(i + 1) % n];
        if (side.inside(before) >= 0) kept.push_back(side.crossing(before, p));
        if (side.inside(after) >= 0) kept.push_back(side.crossing(p, after));
    }
}

void add_face(const std::vector<Vec3>& polygon, bool keeps_quads, FigureOp& out)
{
    FigureFace face;
    for (const Vec3& p : polygon)
    {
        face.vertices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
        out.vertices.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    const std::vector<std::uint32_t>& v = face.vertices;
    if (!keeps_quads)
        for (std::size_t i = 2; i < v.size(); ++i) face.triangles.push_back({v[0], v[i - 1], v[i]});
    else if (v.size() > 4)
        for (const auto& corners : cut_into_ears(std::span(out.vertices).last(v.size())))
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

FigureOp clip_to_box(const MeshFile& mesh, const Transform& place, const Box3& box,
                     bool keeps_quads)
{
    FigureOp out;
    std::vector<Vec3> polygon;
    std::vector<Vec3> kept;
    auto quad = mesh.quads.begin();
    auto wide = mesh.wide_polygons.begin();
    for (std::size_t t = 0; t < mesh.soup.size();)
    {
        polygon.clear();
        if (wide != mesh.wide_polygons.end() && wide->first == t)
        {
            for (const Vec3& p : wide->corners) polygon.push_back(place(p));
            t += wide->corners.size() - 2;
            ++wide;
        }
        else
        {
            for (std::size_t i = 0; i < 3; ++i)
                polygon.push_back(place(mesh.soup.vertices[3 * t + i]));
            if (quad != mesh.quads.end() && *quad == t)
            {
                ++quad;
                polygon.push_back(place(mesh.soup.vertices[3 * ++t + 2]));
            }
            ++t;
        }
        for (const bool is_upper : {false, true})
            for (int axis = 0; axis < 3; ++axis)
            {
                cut_at({axis, is_upper, is_upper ? box.max[axis] : box.min[axis]}, polygon, kept);
                polygon.swap(kept);
            }
        if (polygon.size() >= 3) add_face(polygon, keeps_quads, out);
    }
    return out;
}

} // namespace fppg
