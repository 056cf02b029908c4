#include "balance/lattice_fall.h"

#include "balance/pressure_sums.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fppg
{
namespace
{

constexpr double step_dp = 2;    ///< of the table
constexpr double off_row = 0.02; ///< steps

/// From a node to those within 2h, itself first.
std::vector<Vec3> offsets_of(const FluidAtRest& rest, const LatticeGrid& grid)
{
    const double reach = 2 * rest.h;
    std::vector<Vec3> out{{}};
    std::array<int, 3> n{};
    for (int axis = 0; axis < 3; ++axis)
        n[static_cast<std::size_t>(axis)] =
            rest.is_2d && axis == 1 ? 0 : static_cast<int>(reach / grid.step(axis));
    for (int x = -n[0]; x <= n[0]; ++x)
        for (int y = -n[1]; y <= n[1]; ++y)
            for (int z = -n[2]; z <= n[2]; ++z)
            {
                const Vec3 r{x * grid.step(0), y * grid.step(1), z * grid.step(2)};
                if (norm(r) > 0 && norm(r) < reach) out.push_back(r);
            }
    return out;
}

} // namespace

std::vector<Vec3> lattice_falls(const FluidAtRest& rest, const std::vector<Vec3>& offsets,
                                double mass, std::span<const double> depths)
{
    PressureField field;
    field.resize(offsets.size());
    std::vector<std::uint32_t> near(offsets.size());
    std::iota(near.begin(), near.end(), 0);
    PointGroup node; // alone
    node.count = 1;
    node.near = near;
    const double unit = rest.is_2d ? rest.dp * rest.dp : rest.dp * rest.dp * rest.dp;
    const PairShape shape{static_cast<float>(rest.h / rest.dp), rest.is_cubic};
    std::vector<Vec3> out;
    for (const double depth : depths)
    {
        double own_density = rest.rhop0;
        for (std::size_t k = offsets.size(); k-- > 0;)
        {
            const double pressure = rest.pressure(depth - rest.height(offsets[k]));
            own_density = rest.density(pressure);
            const double volume = pressure > 0 ? mass / own_density / unit : 0;
            const Vec3 at = offsets[k] / rest.dp;
            field.packed[k] = PackedPoint{static_cast<float>(at.x), static_cast<float>(at.y),
                                          static_cast<float>(at.z), static_cast<float>(volume)};
            field.pressures[k] = static_cast<float>(pressure);
        }
        const PressureSums sums = pressure_sums(field, node, shape);
        out.push_back(rest.gravity - rest.slope_scale() / own_density * sums.of(0));
    }
    return out;
}

LatticeFall::LatticeFall(const FluidAtRest& rest, const LatticeGrid& grid, double mass,
                         double deepest)
    : first_(2 * rest.h + rest.dp), step_(step_dp * rest.dp), axis_(vertical_axis(rest))
{
    if (axis_)
    {
        first_ = 0.5 * rest.dp;
        step_ = grid.step(*axis_);
        first_row_ = grid.origin[*axis_];
    }
    const auto entries = static_cast<std::size_t>(std::max(0.0, (deepest - first_) / step_)) + 2;
    std::vector<double> depths;
    for (std::size_t e = 0; e < entries; ++e)
        depths.push_back(first_ + static_cast<double>(e) * step_);
    table_ = lattice_falls(rest, offsets_of(rest, grid), mass, depths);
}

bool LatticeFall::is_on_row(const Vec3& place) const
{
    if (table_.empty()) return false;
    if (!axis_) return true;
    const double row = (place[*axis_] - first_row_) / step_;
    return std::abs(row - std::round(row)) < off_row;
}

Vec3 LatticeFall::at(double depth) const
{
    if (table_.empty()) return {};
    const double place =
        std::clamp((depth - first_) / step_, 0.0, static_cast<double>(table_.size() - 1));
    const auto low = std::min(static_cast<std::size_t>(place), table_.size() - 2);
    const double share = place - static_cast<double>(low);
    return (1 - share) * table_[low] + share * table_[low + 1];
}

} // namespace fppg
