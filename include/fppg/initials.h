#pragma once

#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace fppg
{

/// `<onlypos>`: the particles of a box. Limits belong to it, without tolerance (a particle at
/// 0.7000000000000001 is outside posmax 0.7, as in GenCase v5.4.354).
struct PositionFilter
{
    static constexpr double everywhere = std::numeric_limits<double>::infinity();
    Vec3 min{-everywhere, -everywhere, -everywhere};
    Vec3 max{everywhere, everywhere, everywhere};

    bool contains(const Vec3& p) const
    {
        return min.x <= p.x && p.x <= max.x && min.y <= p.y && p.y <= max.y && min.z <= p.z &&
               p.z <= max.z;
    }
    bool operator==(const PositionFilter&) const = default;
};

/// `<velocity>`: the same velocity everywhere, m/s.
struct UniformVelocity
{
    Vec3 velocity;
};

/// `<velocity>` with `<velocity2>` or `<velocity3>`: the speed is the polynomial of z through two
/// or three points, also beyond them. GenCase v5.0.229 knows it; v5.4 shows it in its template and
/// refuses it.
struct ProfileVelocity
{
    Vec3 direction;             ///< unit vector, or zero
    std::vector<double> speeds; ///< m/s, two or three
    std::vector<double> z;      ///< where they hold; all different
};

/// `<velwave>`: the horizontal velocity of a solitary wave, the same at every z:
///
///     u_x = sqrt(g / depth) H sech^2(sqrt(3 H / (4 depth^3)) (x - x0))
struct WaveVelocity
{
    double depth = 0;
    double height = 0; ///< H, `hmaxwave`
    double x0 = 0;
    bool is_negative = false; ///< towards -x
    double gravity = 0;       ///< |g|; filled by make_particles()
};

/// `<densityuniform>`, kg/m3
struct UniformDensity
{
    double rhop = 0;
};

/// `<densitygradient>`: linear along the line from pos1 to pos2, constant before and beyond.
struct GradientDensity
{
    Vec3 pos1;
    Vec3 pos2; ///< another point
    double rhop1 = 0;
    double rhop2 = 0;
};

/// `<densitydepth>`: rhop0 (1 + rhop0 |g| d / b)^(1 / gamma), d the depth below `surface` along
/// gravity, at least 0. What is empty is filled by make_particles(): the case's own constants, and
/// the highest of all fluid particles for the surface.
struct DepthDensity
{
    std::optional<Vec3> surface;
    std::optional<Vec3> gravity;
    std::optional<double> rhop0;
    std::optional<double> gamma;
    std::optional<double> b;
};

/// Values on the nodes of a box-shaped mesh, read between them by the linear rule along each axis;
/// a place outside has the value of the nearest one inside (found with GenCase v5.4.354).
struct MeshValues
{
    Vec3 origin;
    std::array<Vec3, 3> steps; ///< from node to node, at right angles; metres
    std::array<std::uint32_t, 3> n{1, 1, 1};
    std::vector<double> values; ///< n[0] * n[1] * n[2], the first axis fastest
};

/// `<velmesh>`, m/s. Numbers of the file are speeds along the direction of the element; vectors
/// count as they are, or where there is a direction with their part along it (GenCase v5.4.354).
struct MeshVelocity
{
    std::array<std::shared_ptr<const MeshValues>, 3> components; ///< x, y, z
};

/// `<densitymesh>`
struct MeshDensity
{
    std::shared_ptr<const MeshValues> densities; ///< kg/m3
};

/// `<move>`, `<rotateaxis>`. A rotation turns velocities too.
struct MoveParticles
{
    Transform map;
};

/// `<moverandom>`: particle k of its mk, in id order, moves along each axis of a width w above 0 by
/// (u - 0.5) w. The u are the numbers of a Mersenne Twister (MT19937) in their order, divided by
/// 2^32; the first 37 after seeding are left out. The generator begins anew for every element and
/// mk. Found with GenCase v5.4.354 and equal to it to the last bit; for the seed 0, with which
/// GenCase gives other places in every run, this program takes the seed 0 of the generator.
struct RandomMove
{
    Vec3 width; ///< metres; 0 across a flat case
    std::uint32_t seed = 0;
    /// As many a particle as widths are above 0; filled by make_particles().
    std::shared_ptr<const std::vector<std::uint32_t>> numbers;
};

using InitialVariant =
    std::variant<UniformVelocity, ProfileVelocity, WaveVelocity, UniformDensity, GradientDensity,
                 DepthDensity, MeshVelocity, MeshDensity, MoveParticles, RandomMove>;

/// A child of `<initials>`. They run in the order of the file, each on the particles as those
/// before it left them; later values replace earlier ones. Found by experiments with GenCase
/// v5.4.354: after a move, `onlypos` and depths are those of the new place; densities that no child
/// sets are those of the lattice.
struct InitialOp
{
    int line = 0;
    std::uint16_t mk = 0; ///< absolute
    PositionFilter only;  ///< everywhere for moves and rotations
    InitialVariant what;
};

} // namespace fppg
