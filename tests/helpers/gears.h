#pragma once

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "fppg/mesh.h"
#include "meshes/stl_files.h"

namespace fppg::test
{

/// A spur gear about z with involute flanks, in metres.
struct GearShape
{
    double module_m = 0.002;
    int teeth = 20;
    double width = 0.01;
    double backlash = 0;   ///< play between the flanks of two such gears, along the pitch circle
    double turned_deg = 0; ///< the first tooth from x
    int steps = 6;         ///< chords of a flank

    double pitch_radius() const { return module_m * teeth / 2; }
};

constexpr double pressure_angle = 20 * std::numbers::pi / 180;

/// Points (radius, angle) counter-clockwise; the angle only grows.
inline std::vector<std::pair<double, double>> gear_outline(const GearShape& g)
{
    const double pitch = g.pitch_radius(), tip = pitch + g.module_m;
    const double root = pitch - 1.25 * g.module_m, base = pitch * std::cos(pressure_angle);
    const auto involute = [&](double radius)
    {
        const double ratio = std::acos(std::min(1.0, base / radius));
        return std::tan(ratio) - ratio;
    };
    const double half_tooth =
        std::numbers::pi / (2 * g.teeth) + involute(pitch) - g.backlash / (4 * pitch);
    const double start = std::max(base, root);
    const double half_root = half_tooth - involute(start);
    std::vector<std::pair<double, double>> flank{
        {root, half_root + 0.2 * (std::numbers::pi / g.teeth - half_root)}};
    for (int i = 0; i <= g.steps; ++i)
    {
        const double r = start + (tip - start) * i / g.steps;
        flank.emplace_back(r, half_tooth - involute(r));
    }
    std::vector<std::pair<double, double>> out;
    for (int tooth = 0; tooth < g.teeth; ++tooth)
    {
        const double axis =
            2 * std::numbers::pi * tooth / g.teeth + g.turned_deg * std::numbers::pi / 180;
        for (const auto& [r, a] : flank) out.emplace_back(r, axis - a);
        for (auto it = flank.rbegin(); it != flank.rend(); ++it)
            out.emplace_back(it->first, axis + it->second);
    }
    return out;
}

/// A closed wheel about z between -width / 2 and width / 2 from `at`.
///
/// outline  points (radius, angle) counter-clockwise
inline TriangleSoup wheel_mesh(const std::vector<std::pair<double, double>>& outline, double width,
                               const Vec3& at = {})
{
    TriangleSoup soup;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        soup.vertices.insert(soup.vertices.end(), {at + a, at + b, at + c});
    };
    const double h = width / 2;
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
        const auto place = [&](std::size_t k, double z) -> Vec3
        {
            const auto& [r, a] = outline[k % outline.size()];
            return {r * std::cos(a), r * std::sin(a), z};
        };
        const Vec3 a = place(i, -h), b = place(i + 1, -h), c = place(i + 1, h), d = place(i, h);
        add(a, b, c);
        add(a, c, d);
        add({0, 0, h}, d, c);
        add({0, 0, -h}, b, a);
    }
    return soup;
}

/// A wheel with teeth of straight flanks about z; 0.4 of a pitch is tooth at half their height.
inline TriangleSoup toothed_wheel(int teeth, double tip, double root, double width)
{
    std::vector<std::pair<double, double>> outline;
    for (int tooth = 0; tooth < teeth; ++tooth)
        for (const auto& [share, radius] :
             {std::pair{0.0, root}, {0.15, tip}, {0.4, tip}, {0.55, root}})
            outline.emplace_back(radius, 2 * std::numbers::pi * (tooth + share) / teeth);
    return wheel_mesh(outline, width);
}

/// Closed, without a bore; its middle is at `at`.
inline TriangleSoup gear_mesh(const GearShape& g, const Vec3& at = {})
{
    return wheel_mesh(gear_outline(g), g.width, at);
}

/// Writes a soup, its lengths times `scale`, as binary STL.
inline void write_stl(const std::string& path, const TriangleSoup& soup, double scale = 1,
                      const std::string& title = "part")
{
    std::vector<Corners> facets(soup.size());
    for (std::size_t i = 0; i < soup.vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            facets[i / 3][3 * (i % 3) + static_cast<std::size_t>(axis)] =
                static_cast<float>(soup.vertices[i][axis] * scale);
    std::ofstream(path, std::ios::binary)
        << binary_stl(facets, static_cast<std::uint32_t>(facets.size()), title);
}

} // namespace fppg::test
