#include "shapes/round_mesh.h"

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

constexpr double pi = std::numbers::pi;
constexpr double most_facets = 2147483648.0;

/// Triangles whose corners are shared by index.
struct IndexedMesh
{
    std::vector<Vec3> vertices;
    std::vector<Corners> facets;

    std::uint32_t add(const Vec3& p)
    {
        vertices.push_back(p);
        return static_cast<std::uint32_t>(vertices.size() - 1);
    }
    TriangleSoup soup() const
    {
        TriangleSoup out;
        out.vertices.reserve(3 * facets.size());
        for (const Corners& f : facets)
            for (const std::uint32_t corner : f) out.vertices.push_back(vertices[corner]);
        return out;
    }
};

void check_size(const char* shape, double size)
{
    if (!(size > 0) || !std::isfinite(size))
        throw GeometryError(fmt::format(
            "{} of {:g} m has no surface for particles, expected more than 0", shape, size));
}

void check_facets(double count)
{
    if (!(count < most_facets))
        throw GeometryError(fmt::format(
            "the round shape is so large for dp that its surface needs {:g} triangles", count));
}

/// Into how many parts the edges of an icosahedron must be cut so that no facet of the sphere
/// around it lies deeper than chord_error_dp. The deepest facets lie in the middle of the faces,
/// where a triangle of circumradius edge / (sqrt(3) parts) stands at the face's distance from the
/// centre.
double parts_for_chord(double radius_dp)
{
    const double edge = 4 / std::sqrt(10 + 2 * std::sqrt(5.0));
    const double face_distance = std::sqrt(1 - edge * edge / 3);
    const double cosine = 1 - std::min(chord_error_dp / radius_dp, 0.5);
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    return std::ceil(edge / (std::sqrt(3.0) * face_distance * tangent));
}

/// Directions to the corners of a geodesic sphere; the icosahedron's edges are cut into `parts`.
IndexedMesh geodesic_sphere(std::uint32_t parts)
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
    IndexedMesh mesh;
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

/// Two directions that make a right-handed system with the unit vector u: v, then w = u x v.
std::array<Vec3, 2> across(const Vec3& u)
{
    const Vec3 helper = std::fabs(u.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 v = cross(u, helper) / norm(cross(u, helper));
    return {v, cross(u, v)};
}

/// A ring of corners, counter-clockwise seen from the tip of the axis.
using Ring = std::vector<std::uint32_t>;

class CylinderMesher
{
public:
    CylinderMesher(const Vec3& p0, const Vec3& p1, double radius, double dp) : p0_(p0), p1_(p1)
    {
        const Vec3 axis = p1 - p0;
        u_ = axis / norm(axis);
        [[maybe_unused]] const auto [v, w] = across(u_);
        const double cosine = 1 - std::min(chord_error_dp * dp / radius, 0.5);
        const double least = std::max(24.0, std::ceil(pi / std::acos(cosine)));
        check_facets(least);
        // The number of sides is such that it can be halved towards the middle of a cover.
        while (least / (1U << (halvings_ + 1)) >= 6) ++halvings_;
        sides_ = static_cast<std::uint32_t>(std::ceil(least / (1U << halvings_))) << halvings_;
        for (std::uint32_t i = 0; i < sides_; ++i)
        {
            const double turn = 2 * pi * i / sides_;
            spokes_.push_back(v * (radius * std::cos(turn)) + w * (radius * std::sin(turn)));
        }
        // Facets of the tube are at most four times as long as wide.
        rows_ = std::max(1.0, std::ceil(norm(axis) / (8 * pi * radius / sides_)));
        check_facets(2 * rows_ * sides_);
    }

    IndexedMesh run(const std::array<bool, 3>& is_visible)
    {
        const Ring bottom = is_visible[0] || is_visible[2] ? ring(p0_, 1, 1) : Ring{};
        Ring top;
        if (is_visible[2])
        {
            Ring below = bottom;
            const auto rows = static_cast<std::uint32_t>(rows_);
            for (std::uint32_t row = 1; row <= rows; ++row)
            {
                top = ring(row == rows ? p1_ : p0_ + (p1_ - p0_) * (row / rows_), 1, 1);
                add_band(below, top);
                below = top;
            }
        }
        else if (is_visible[1])
            top = ring(p1_, 1, 1);
        if (is_visible[0]) add_cover(p0_, bottom, true);
        if (is_visible[1]) add_cover(p1_, top, false);
        return std::move(mesh_);
    }

private:
    Ring ring(const Vec3& center, double share, std::uint32_t step)
    {
        Ring out;
        for (std::uint32_t i = 0; i < sides_; i += step)
            out.push_back(mesh_.add(center + spokes_[i] * share));
        return out;
    }

    void add_band(const Ring& below, const Ring& above)
    {
        for (std::uint32_t i = 0; i < sides_; ++i)
        {
            const std::uint32_t j = (i + 1) % sides_;
            mesh_.facets.push_back({below[i], below[j], above[j]});
            mesh_.facets.push_back({below[i], above[j], above[i]});
        }
    }

    /// Rings with half as many corners each towards the middle, so that facets stay well shaped.
    void add_cover(const Vec3& center, const Ring& rim, bool looks_down)
    {
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mesh_.facets.push_back(looks_down ? Corners{a, c, b} : Corners{a, b, c});
        };
        Ring outer = rim;
        for (int halving = 1; halving <= halvings_; ++halving)
        {
            const std::uint32_t step = 1U << halving;
            const Ring inner = ring(center, 1 - 0.6 * (step - 1) / (1U << halvings_), step);
            for (std::size_t i = 0; i < inner.size(); ++i)
            {
                const std::uint32_t next = inner[(i + 1) % inner.size()];
                const std::uint32_t after = outer[(2 * i + 2) % outer.size()];
                add(outer[2 * i], outer[2 * i + 1], inner[i]);
                add(outer[2 * i + 1], next, inner[i]);
                add(outer[2 * i + 1], after, next);
            }
            outer = inner;
        }
        const std::uint32_t middle = mesh_.add(center);
        for (std::size_t i = 0; i < outer.size(); ++i)
            add(outer[i], outer[(i + 1) % outer.size()], middle);
    }

    Vec3 p0_;
    Vec3 p1_;
    Vec3 u_;
    double rows_ = 1;
    int halvings_ = 0;
    std::uint32_t sides_ = 0;
    std::vector<Vec3> spokes_; ///< from the axis to the rim
    IndexedMesh mesh_;
};

} // namespace

ShapeMesh sphere_mesh(const Vec3& center, double radius, double dp)
{
    check_size("a sphere with a radius", radius);
    const double parts = std::max(5.0, parts_for_chord(radius / dp));
    check_facets(20 * parts * parts);
    IndexedMesh mesh = geodesic_sphere(static_cast<std::uint32_t>(parts));
    for (Vec3& p : mesh.vertices) p = center + p * radius;
    ShapeMesh out;
    out.soup = mesh.soup();
    out.round = RoundShape::Sphere;
    out.p0 = center;
    out.p1 = center;
    out.radius = radius;
    return out;
}

ShapeMesh cylinder_mesh(const Vec3& p0, const Vec3& p1, double radius,
                        const std::array<bool, 3>& is_visible, double dp)
{
    check_size("a cylinder with a radius", radius);
    ShapeMesh out;
    out.round = RoundShape::Cylinder;
    out.p0 = p0;
    out.p1 = p1;
    out.radius = radius;
    if (norm(p1 - p0) > 0) out.soup = CylinderMesher(p0, p1, radius, dp).run(is_visible).soup();
    return out;
}

ShapeMesh ellipsoid_mesh(const Vec3& focus0, const Vec3& focus1, double sum, double dp)
{
    check_size("an ellipsoid with a sum of distances", sum);
    ShapeMesh out;
    out.round = RoundShape::Ellipsoid;
    out.p0 = focus0;
    out.p1 = focus1;
    out.radius = sum;
    const double apart = norm(focus1 - focus0);
    const double along = 0.5 * sum;
    const double side = 0.5 * std::sqrt(std::max(0.0, (sum - apart) * (sum + apart)));
    if (!(side > 0)) return out;
    // A facet's depth is stretched by no more than the half axis; edges of the tips are sharper
    // than those of the sphere by the ratio of the axes.
    const double parts =
        std::max({5.0, parts_for_chord(along / dp), std::ceil(std::min(5 * along / side, 150.0))});
    check_facets(20 * parts * parts);
    IndexedMesh mesh = geodesic_sphere(static_cast<std::uint32_t>(parts));
    const Vec3 u = apart > 0 ? (focus1 - focus0) / apart : Vec3{0, 0, 1};
    const auto [v, w] = across(u);
    const Vec3 center = (focus0 + focus1) * 0.5;
    // Between the sphere's z, x, y and the axes u, v, w nothing is mirrored.
    for (Vec3& p : mesh.vertices)
        p = center + u * (along * p.z) + v * (side * p.x) + w * (side * p.y);
    out.soup = mesh.soup();
    return out;
}

} // namespace fppg
