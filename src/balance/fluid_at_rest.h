#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/relax_volume.h"

#include "core/parallel.h"
#include "core/raw_array.h"
#include "relax/cell_rows.h"
#include "relax/kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace fppg
{

/// What a particle near a wall is to balance_fluid().
enum class RestRole : std::uint8_t
{
    Moving, ///< near fitted walls
    Along,  ///< moves too, farther from them
    Held,   ///< fluid that stays
    Bound,
};

/// Fluid beside fitted walls and what its forces reach, one entry each in all arrays, along a
/// Morton curve. SI units.
struct FluidAtRest
{
    // Of the case:
    double dp = 0;
    double h = 0;
    double rhop0 = 0;
    double gamma = 0;
    double b = 0;
    double fullness = 1; ///< CaseDef::fluid_fullness
    Vec3 gravity;        ///< without what drives fluid through a channel
    bool is_2d = false;
    bool is_cubic = false; ///< kernel; else that of Wendland
    Vec3 origin;           ///< of GroupList's coordinates

    RawArray<std::uint64_t> ids;
    RawArray<RestRole> roles;
    RawArray<Vec3> positions;
    RawArray<double> levels; ///< height at which the pressure is 0, of fluid
    RawArray<double> masses;
    RawArray<double> pressures;
    RawArray<double> densities;
    RawArray<Vec3> ghosts; ///< from a boundary particle to its ghost node; zero: none

    std::size_t size() const { return positions.size(); }
    /// New values are not written.
    void resize(std::size_t n)
    {
        ids.resize(n);
        roles.resize(n);
        positions.resize(n);
        levels.resize(n);
        masses.resize(n);
        pressures.resize(n);
        densities.resize(n);
        ghosts.resize(n);
    }
    bool moves(std::size_t i) const
    {
        return roles[i] == RestRole::Moving || roles[i] == RestRole::Along;
    }
    double height(const Vec3& p) const { return -dot(p, gravity) / norm(gravity); }
    /// The pressure at a depth below the level; 0 above. Its sums over particles that are heavier
    /// by `fullness` come out larger by as much, so it is lower.
    double pressure(double depth) const { return std::max(0.0, pressure_per_depth() * depth); }
    double pressure_per_depth() const { return rhop0 * norm(gravity) / fullness; }
    double density(double pressure) const { return rhop0 * std::pow(1 + pressure / b, 1 / gamma); }
    double pressure_of_density(double density) const
    {
        return b * (std::pow(density / rhop0, gamma) - 1);
    }
    /// The factor of the kernel, W = alpha times the shape that pressure_sums.h sums up.
    double alpha() const
    {
        if (is_cubic) return is_2d ? cubic_spline_alpha_2d(h) : cubic_spline_alpha_3d(h);
        return is_2d ? wendland_alpha_2d(h) : wendland_alpha_3d(h);
    }
    /// From sums of the kernel's slope in dp and dp^3 (2D: dp^2) to those in metres.
    double slope_scale() const { return alpha() / (h * h) * dp * (is_2d ? dp * dp : dp * dp * dp); }
    /// Places as GroupList takes them: in dp from the origin, as many as `out` has.
    ///
    /// place  Vec3(std::size_t)
    template <typename Place>
    void set_in_dp(const Place& place, int threads, PointArrays& out) const
    {
        parallel_for(
            out.size(), threads,
            [&](std::size_t i)
            {
                const Vec3 at = (place(i) - origin) / dp;
                out.x[i] = static_cast<float>(at.x);
                out.y[i] = static_cast<float>(at.y);
                out.z[i] = static_cast<float>(at.z);
            },
            1024);
    }
};

/// Fluid no farther apart is one body of it, in dp: neighbours on the lattice, over an edge too.
inline constexpr double joined_dp = 1.5;

/// The axis that gravity is along.
std::optional<int> vertical_axis(const FluidAtRest& rest);

/// Reach of the neighbour lists in dp without their skin.
inline double rest_reach_dp(const FluidAtRest& rest)
{
    return 2 * rest.h / rest.dp;
}

/// The bands of RestReach, by the `<fluidband>` of a case.
std::vector<double> balanced_bands(const CaseDef& def);

/// Whether no fluid of the case is to stay on its lattice by `<fluidband packing="cubic">`.
bool packs(const CaseDef& def, const CaseParticles& particles);

/// How far gather_fluid() looks.
struct RestReach
{
    /// Fluid of an absolute mk this near to a fitted wall may move, in dp; 0: it stays. 65536.
    std::vector<double> band_dp;
    ClosestWallPoint closest;
    int threads = 1;
};

/// Gathers fluid that is near fitted walls, in cases with up to most_balanced_whole of it what is
/// joined to that, and fluid and boundary particles that its forces reach.
/// Nothing where no fluid is near a fitted wall.
FluidAtRest gather_fluid(const CaseDef& def, const RunField& field, const CaseConstants& constants,
                         const CaseParticles& particles, const RestReach& reach);

/// Holds fluid within 2h of a free face that is not level, and of places where one depth of fluid
/// meets another without a wall between them, as under a gate or where a dam breaks over a wet bed:
/// it starts to move there. The number of those held, of fluid near walls.
std::size_t hold_free_faces(FluidAtRest& rest, int threads);

/// Holds some fluid, and all within 2h of it. The number of those held, of fluid near walls.
///
/// is_meant  one a particle, not 0: it is held
std::size_t hold_around(FluidAtRest& rest, const std::vector<char>& is_meant, int threads);

} // namespace fppg
