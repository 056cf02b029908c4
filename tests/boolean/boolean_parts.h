#pragma once

#include "fit/fit_shapes.h"
#include "fppg/boolean.h"
#include "meshes/test_shapes.h"

#include <cmath>
#include <deque>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace fppg::test
{

inline BooleanNode leaf(std::uint32_t part)
{
    BooleanNode node;
    node.part = part;
    return node;
}

inline BooleanNode combined(BooleanOp op, std::vector<BooleanNode> operands)
{
    BooleanNode node;
    node.op = op;
    node.operands = std::move(operands);
    return node;
}

inline BooleanNode of_two(BooleanOp op)
{
    return combined(op, {leaf(0), leaf(1)});
}

/// A tube of `sides` sides with covers, radius 1, height from -1 to 1.
inline TriangleSoup tube(int sides)
{
    TriangleSoup soup;
    const auto rim = [&](int i, double z)
    {
        const double a = 2 * std::numbers::pi * (i % sides) / sides;
        return Vec3{std::cos(a), std::sin(a), z};
    };
    for (int i = 0; i < sides; ++i)
    {
        add_quad(soup, rim(i, -1), rim(i + 1, -1), rim(i + 1, 1), rim(i, 1));
        add_facet(soup, rim(i + 1, -1), rim(i, -1), {0, 0, -1});
        add_facet(soup, rim(i, 1), rim(i + 1, 1), {0, 0, 1});
    }
    return soup;
}

/// Turns about x, then y, then z, degrees; then scales and moves.
inline Transform placed(const Vec3& angles, double scale, const Vec3& move)
{
    Transform out;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double a = angles[axis] * std::numbers::pi / 180;
        // Whole quarters are exact.
        const bool is_quarter = std::fmod(angles[axis], 90) == 0;
        const double c = is_quarter ? std::round(std::cos(a)) : std::cos(a);
        const double s = is_quarter ? std::round(std::sin(a)) : std::sin(a);
        Transform t;
        const auto i = static_cast<std::size_t>((axis + 1) % 3);
        const auto j = static_cast<std::size_t>((axis + 2) % 3);
        t.linear[i][static_cast<int>(i)] = c;
        t.linear[i][static_cast<int>(j)] = -s;
        t.linear[j][static_cast<int>(i)] = s;
        t.linear[j][static_cast<int>(j)] = c;
        out = t * out;
    }
    for (Vec3& row : out.linear) row = scale * row;
    out.offset = move;
    return out;
}

/// Meshes that stay where they are while parts refer to them.
struct PartList
{
    std::deque<SurfaceMesh> meshes;
    std::deque<MeshReport> reports;
    std::vector<BooleanPart> parts;

    void add(const TriangleSoup& soup, const std::string& name = "part")
    {
        reports.emplace_back();
        meshes.push_back(repair_mesh(soup, {}, 1, reports.back()));
        BooleanPart part;
        part.name = name;
        part.mesh = &meshes.back();
        parts.push_back(part);
    }
    BooleanMesh run(const BooleanNode& node, int threads = 1) const
    {
        return boolean_mesh(parts, node, {}, threads);
    }
    double volume(std::size_t i) const { return reports[i].volume; }
};

/// How parts lie to one another.
enum class Placing
{
    Random, ///< no two faces in one plane
    Aligned ///< sizes, shifts and turns on a coarse raster: faces, edges and corners coincide
};

inline TriangleSoup any_part(std::mt19937& random, Placing placing)
{
    const auto whole = [&](int low, int high)
    { return std::uniform_int_distribution<int>(low, high)(random); };
    const auto real = [&](double low, double high)
    { return std::uniform_real_distribution<double>(low, high)(random); };
    TriangleSoup soup;
    const int kind = whole(0, placing == Placing::Aligned ? 5 : 4);
    if (kind == 0) soup = sphere(whole(1, 3));
    if (kind == 1) soup = tube(whole(3, 24));
    if (kind == 2) soup = moved(gear(whole(3, 9), 0.7, 1, 1), placed({}, 1, {0, 0, -0.5}));
    if (kind == 3) soup = octahedron(1);
    if (kind >= 4) soup = box({-1, -1, -1}, {1, 1, 1});
    if (placing == Placing::Random)
        return moved(soup, placed({real(0, 360), real(0, 360), real(0, 360)}, real(0.5, 1.5),
                                  {real(-0.8, 0.8), real(-0.8, 0.8), real(-0.8, 0.8)}));
    return moved(soup, placed({90.0 * whole(0, 3), 90.0 * whole(0, 3), 90.0 * whole(0, 3)},
                              0.5 * whole(1, 2),
                              {0.5 * whole(-2, 2), 0.5 * whole(-2, 2), 0.5 * whole(-2, 2)}));
}

} // namespace fppg::test
