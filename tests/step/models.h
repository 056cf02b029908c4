#pragma once

#include <cmath>
#include <numbers>

/// The STEP files of the tests, in millimetres, and what is known of them by formulas.
namespace fppg::test
{

inline constexpr double pi = std::numbers::pi;

inline constexpr double shaft_radius = 10;
inline constexpr double shaft_length = 80;
inline constexpr double torus_big = 40;
inline constexpr double torus_small = 12;
inline constexpr int gear_teeth = 12;
inline constexpr double gear_tip = 36;
inline constexpr double gear_root = 28;
inline constexpr double gear_bore = 11;
inline constexpr double gear_width = 20;
inline constexpr double block_x = 60;
inline constexpr double block_y = 40;
inline constexpr double block_z = 30;
inline constexpr double block_radius = 8;
inline constexpr double roof_x = 60;
inline constexpr double roof_y = 40;
inline constexpr double roof_z = 20;
inline constexpr double roof_bend = 8 * pi / 180;

/// What a part is by its formula: mm3, mm2, and of its edges.
struct KnownPart
{
    double volume = 0;
    double area = 0;
    int sharp_edges = 0;
    int smooth_edges = 0; ///< with seams, where a face meets itself
    double sharp_length = 0;
};

inline KnownPart known_cylinder()
{
    const double r = shaft_radius, l = shaft_length;
    return {pi * r * r * l, 2 * pi * r * (r + l), 2, 1, 4 * pi * r};
}

inline KnownPart known_torus()
{
    const double r = torus_small, R = torus_big;
    return {2 * pi * pi * R * r * r, 4 * pi * pi * R * r, 0, 2, 0};
}

inline KnownPart known_gear()
{
    const double section =
        pi * (gear_tip * gear_tip + gear_root * gear_root) / 2 - pi * gear_bore * gear_bore;
    const double outline = pi * (gear_tip + gear_root) + 2 * gear_teeth * (gear_tip - gear_root);
    const double bore = 2 * pi * gear_bore;
    return {section * gear_width, 2 * section + (outline + bore) * gear_width,
            // Per tooth four edges of the outline at both ends, and four along the width.
            4 * gear_teeth * 3 + 2, 1, 2 * (outline + bore) + 4 * gear_teeth * gear_width};
}

inline KnownPart known_block()
{
    const double r = block_radius;
    const double section = block_x * block_y - (4 - pi) * r * r;
    const double outline = 2 * (block_x + block_y) - 8 * r + 2 * pi * r;
    return {section * block_z, 2 * section + outline * block_z, 16, 8, 2 * outline};
}

inline KnownPart known_roof()
{
    const double rise = roof_x / 2 * std::tan(roof_bend / 2);
    const double section = roof_x * (roof_z + rise / 2);
    const double slope = std::hypot(roof_x / 2, rise);
    const double outline = roof_x + 2 * roof_z + 2 * slope;
    return {section * roof_y, 2 * section + outline * roof_y, 15, 0, 2 * outline + 5 * roof_y};
}

} // namespace fppg::test
