#include "newcase/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace fppg
{

namespace
{

/// Facets of a flat face look the same way, to about a degree.
constexpr double same_way = 0.9998;
/// Discs are drawn by few facets: an octagon fills 0.9 of its circle.
constexpr double least_disc = 0.89;
constexpr double least_rectangle = 0.97;

/// Adds to a face all facets that join it and lie in its plane.
void grow_face(const NewPart& part, std::uint32_t first, std::vector<char>& taken, FlatFace& face)
{
    const SurfaceMesh& mesh = part.mesh;
    const Vec3 normal = mesh.normals[first];
    const Vec3 origin = mesh.vertices[mesh.facets[first][0]];
    const double thick = 1e-4 * norm(part.box().max - part.box().min);
    std::vector<std::uint32_t> now{first};
    taken[first] = 1;
    for (std::size_t k = 0; k < now.size(); ++k)
        for (const std::uint32_t beside : mesh.neighbours[now[k]])
        {
            if (beside == no_index || taken[beside] != 0) continue;
            const bool is_flat =
                std::all_of(mesh.facets[beside].begin(), mesh.facets[beside].end(),
                            [&](std::uint32_t v)
                            { return std::abs(dot(mesh.vertices[v] - origin, normal)) < thick; });
            if (!is_flat || dot(mesh.normals[beside], normal) < same_way) continue;
            taken[beside] = 1;
            now.push_back(beside);
        }
    std::sort(now.begin(), now.end());
    face.facets = std::move(now);
}

/// The corners on the rim of a face, and the ways of its sides.
struct FaceRim
{
    std::vector<Vec3> corners;
    std::vector<Vec3> ways;
};

FaceRim rim_of(const NewPart& part, const FlatFace& face)
{
    const SurfaceMesh& mesh = part.mesh;
    FaceRim out;
    for (const std::uint32_t f : face.facets)
        for (std::size_t side = 0; side < 3; ++side)
        {
            const std::uint32_t beside = mesh.neighbours[f][side];
            if (beside != no_index &&
                std::binary_search(face.facets.begin(), face.facets.end(), beside))
                continue;
            const Vec3& a = mesh.vertices[mesh.facets[f][side]];
            const Vec3& b = mesh.vertices[mesh.facets[f][(side + 1) % 3]];
            out.corners.push_back(a);
            out.ways.push_back(b - a);
        }
    return out;
}

FaceOutline rectangle_of(const FlatFace& face, const FaceRim& rim)
{
    FaceOutline best;
    for (const Vec3& way : rim.ways)
    {
        Vec3 along = way - dot(way, face.normal) * face.normal;
        if (!(norm(along) > 0)) continue;
        along = along / norm(along);
        const Vec3 across = cross(face.normal, along);
        double low_a = 1e300, high_a = -1e300, low_c = 1e300, high_c = -1e300;
        for (const Vec3& corner : rim.corners)
        {
            const Vec3 from = corner - face.middle;
            low_a = std::min(low_a, dot(from, along));
            high_a = std::max(high_a, dot(from, along));
            low_c = std::min(low_c, dot(from, across));
            high_c = std::max(high_c, dot(from, across));
        }
        const double filled = face.area / ((high_a - low_a) * (high_c - low_c));
        if (filled <= best.filled * (1 + 1e-9)) continue;
        best.filled = filled;
        best.along = along;
        best.across = across;
        best.length = high_a - low_a;
        best.width = high_c - low_c;
        best.middle =
            face.middle + 0.5 * (low_a + high_a) * along + 0.5 * (low_c + high_c) * across;
    }
    return best;
}

} // namespace

std::vector<FlatFace> flat_faces(const NewPart& part)
{
    const SurfaceMesh& mesh = part.mesh;
    std::vector<std::uint32_t> order(mesh.facets.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b)
                     { return mesh.areas[a] > mesh.areas[b]; });
    std::vector<char> taken(mesh.facets.size(), 0);
    std::vector<FlatFace> out;
    for (const std::uint32_t first : order)
    {
        if (taken[first] != 0) continue;
        FlatFace face;
        grow_face(part, first, taken, face);
        for (const std::uint32_t f : face.facets)
        {
            const auto& c = mesh.facets[f];
            face.area += mesh.areas[f];
            face.normal = face.normal + mesh.areas[f] * mesh.normals[f];
            face.middle =
                face.middle + mesh.areas[f] / 3 *
                                  (mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]);
        }
        if (!(face.area > 0) || !(norm(face.normal) > 0)) continue;
        face.middle = face.middle / face.area;
        face.normal = face.normal / norm(face.normal);
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(face.normal[axis]) < 1e-7) face.normal[axis] = 0;
        face.normal = face.normal / norm(face.normal);
        out.push_back(std::move(face));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const FlatFace& a, const FlatFace& b) { return a.area > b.area; });
    return out;
}

FaceOutline outline_of(const NewPart& part, const FlatFace& face)
{
    const FaceRim rim = rim_of(part, face);
    FaceOutline disc;
    disc.is_disc = true;
    disc.middle = face.middle;
    for (const Vec3& corner : rim.corners)
        disc.radius = std::max(disc.radius, norm(corner - face.middle));
    disc.filled = face.area / (std::numbers::pi * disc.radius * disc.radius);
    FaceOutline rectangle = rectangle_of(face, rim);
    disc.is_near_enough = disc.filled >= least_disc;
    rectangle.is_near_enough = rectangle.filled >= least_rectangle;
    if (disc.is_near_enough != rectangle.is_near_enough)
        return disc.is_near_enough ? disc : rectangle;
    return disc.filled >= rectangle.filled ? disc : rectangle;
}

} // namespace fppg
