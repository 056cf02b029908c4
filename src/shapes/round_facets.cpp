#include "shapes/round_facets.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace fppg
{
namespace
{

using Corners = std::array<std::uint32_t, 3>;

/// With the trees to search them they need about 12 GB.
constexpr double most_facets = 2e7;

} // namespace

TriangleSoup SharedFacets::soup() const
{
    TriangleSoup out;
    out.vertices.reserve(3 * facets.size());
    for (const Corners& f : facets)
        for (const std::uint32_t corner : f) out.vertices.push_back(vertices[corner]);
    return out;
}

void check_size(const char* shape, double size)
{
    if (!(size > 0) || !std::isfinite(size))
        throw GeometryError(fmt::format(
            "{} of {:g} m has no surface for particles, expected more than 0", shape, size));
}

void check_facets(double count)
{
    if (!(count < most_facets))
        throw GeometryError(
            fmt::format("the round shape is so large for dp that its surface needs {:.3g} "
                        "triangles, expected at "
                        "most {:g}; a larger dp needs fewer",
                        count, most_facets));
}

std::array<Vec3, 2> across(const Vec3& u)
{
    const Vec3 helper = std::fabs(u.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 v = cross(u, helper) / norm(cross(u, helper));
    return {v, cross(u, v)};
}

double sides_for_chord(double radius, double dp)
{
    const double cosine = 1 - std::min(chord_error_dp * dp / radius, 0.5);
    return std::max(24.0, std::ceil(std::numbers::pi / std::acos(cosine)));
}

double parts_for_chord(double radius_dp)
{
    const double edge = 4 / std::sqrt(10 + 2 * std::sqrt(5.0));
    const double face_distance = std::sqrt(1 - edge * edge / 3);
    const double cosine = 1 - std::min(chord_error_dp / radius_dp, 0.5);
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    return std::ceil(edge / (std::sqrt(3.0) * face_distance * tangent));
}

SharedFacets geodesic_sphere(std::uint32_t parts)
{
    const double phi = std::numbers::phi;
    const std::array<Vec3, 12> corners{Vec3{-1, phi, 0},  Vec3{1, phi, 0},   Vec3{-1, -phi, 0},
                                       Vec3{1, -phi, 0},  Vec3{0, -1, phi},  Vec3{0, 1, phi},
                                       Vec3{0, -1, -phi}, Vec3{0, 1, -phi},  Vec3{phi, 0, -1},
                                       Vec3{phi, 0, 1},   Vec3{-phi, 0, -1}, Vec3{-phi, 0, 1}};
    constexpr std::array<Corners, 20> faces{
        Corners{0, 11, 5}, {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2},       {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},         {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    SharedFacets mesh;
    const auto add = [&mesh](const Vec3& p) { return mesh.add(p / norm(p)); };
    for (const Vec3& c : corners) add(c);

    // Inner corners of an edge, from its smaller to its larger end.
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> first_on_edge;
    const auto on_edge = [&](std::uint32_t a, std::uint32_t b, std::uint32_t step)
    {
        if (step == 0) return a;
        if (step == parts) return b;
        const std::uint32_t low = std::min(a, b);
        const std::uint32_t high = std::max(a, b);
        const auto [at, is_new] = first_on_edge.try_emplace(
            {low, high}, static_cast<std::uint32_t>(mesh.vertices.size()));
        for (std::uint32_t k = 1; is_new && k < parts; ++k)
            add(corners[low] * (parts - k) + corners[high] * k);
        return at->second + (low == a ? step : parts - step) - 1;
    };
    std::vector<std::uint32_t> row;
    std::vector<std::uint32_t> next;
    for (const auto& [a, b, c] : faces)
    {
        row = {a};
        for (std::uint32_t i = 1; i <= parts; ++i)
        {
            // Row i runs from the side a b to the side a c.
            next.clear();
            for (std::uint32_t j = 0; j <= i; ++j)
            {
                if (j == 0)
                    next.push_back(on_edge(a, b, i));
                else if (j == i)
                    next.push_back(on_edge(a, c, i));
                else if (i == parts)
                    next.push_back(on_edge(b, c, j));
                else
                    next.push_back(
                        add(corners[a] * (parts - i) + corners[b] * (i - j) + corners[c] * j));
            }
            for (std::uint32_t j = 0; j < i; ++j)
            {
                mesh.facets.push_back({row[j], next[j], next[j + 1]});
                if (j + 1 < i) mesh.facets.push_back({row[j], next[j + 1], row[j + 1]});
            }
            row.swap(next);
        }
    }
    return mesh;
}

} // namespace fppg
