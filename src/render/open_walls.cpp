#include "render/open_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace fppg
{
namespace
{

constexpr double wall_depth_dp = 4.5;
/// A side that the camera sees at less than this (sine of the angle) hides nothing.
constexpr double least_slope = 0.1;
constexpr std::uint8_t fixed = 0;
/// A part whose outline is a smaller share of that of all that is not fixed stands in the fluid, as
/// a car in water, and is no wall around it.
constexpr double least_outline = 0.25;

/// Per mk whether its fixed particles are walls around the rest.
std::vector<char> walls_of(const ParticleCloud& cloud, const std::vector<std::uint32_t>& chosen,
                           const Vec3& right, const Vec3& up)
{
    std::map<std::uint16_t, Box3> outlines;
    Box3 rest;
    for (const std::uint32_t i : chosen)
    {
        const Vec3& p = cloud.positions[i];
        Box3& box = cloud.type[i] == fixed ? outlines[cloud.mk[i]] : rest;
        box.add({dot(p, right), dot(p, up), 0});
    }
    const auto area = [&](const Box3& box)
    { return (box.max.x - box.min.x + cloud.dp) * (box.max.y - box.min.y + cloud.dp); };
    std::vector<char> out(65536, 0);
    for (const auto& [mk, box] : outlines)
        out[mk] = !rest.is_empty() && area(box) >= least_outline * area(rest) ? 1 : 0;
    return out;
}

/// Of cells of the picture, the depth of the farthest particle that is not fixed.
class HiddenDepths
{
public:
    HiddenDepths(const ParticleCloud& cloud, const std::vector<std::uint32_t>& chosen,
                 const Vec3& towards, const Vec3& right, const Vec3& up)
        : cloud_(cloud), towards_(towards), right_(right), up_(up)
    {
        for (const std::uint32_t i : chosen)
        {
            const Vec3& p = cloud.positions[i];
            box_.add({dot(p, right), dot(p, up), 0});
        }
        const Vec3 size = box_.max - box_.min;
        cell_ = std::max({1.2 * cloud.dp, size.x / 2000, size.y / 2000, 1e-300});
        columns_ = static_cast<std::size_t>(size.x / cell_) + 1;
        depths_.assign(columns_ * (static_cast<std::size_t>(size.y / cell_) + 1),
                       std::numeric_limits<double>::infinity());
        for (const std::uint32_t i : chosen)
            if (cloud.type[i] != fixed)
            {
                double& depth = depths_[cell_of(i)];
                depth = std::min(depth, dot(cloud.positions[i], towards_));
            }
    }

    bool hides(std::uint32_t i) const
    {
        return dot(cloud_.positions[i], towards_) > depths_[cell_of(i)];
    }

    /// The part of the cells with such particles that walls hide.
    double hidden_share(const std::vector<std::uint32_t>& chosen,
                        const std::vector<char>& is_wall) const
    {
        std::vector<char> is_hidden(depths_.size(), 0);
        for (const std::uint32_t i : chosen)
            if (cloud_.type[i] == fixed && is_wall[cloud_.mk[i]] != 0 && hides(i))
                is_hidden[cell_of(i)] = 1;
        std::size_t all = 0;
        std::size_t hidden = 0;
        for (std::size_t c = 0; c < depths_.size(); ++c)
        {
            all += static_cast<std::size_t>(std::isfinite(depths_[c]));
            hidden += static_cast<std::size_t>(is_hidden[c] != 0);
        }
        return all == 0 ? 0 : static_cast<double>(hidden) / static_cast<double>(all);
    }

private:
    std::size_t cell_of(std::uint32_t i) const
    {
        const Vec3& p = cloud_.positions[i];
        const auto place = [&](double v) { return static_cast<std::size_t>(v / cell_); };
        return place(dot(p, up_) - box_.min.y) * columns_ + place(dot(p, right_) - box_.min.x);
    }

    const ParticleCloud& cloud_;
    Vec3 towards_;
    Vec3 right_;
    Vec3 up_;
    Box3 box_;
    double cell_ = 1;
    std::size_t columns_ = 1;
    std::vector<double> depths_;
};

} // namespace

void open_walls(const ParticleCloud& cloud, const Vec3& towards, const Vec3& right, const Vec3& up,
                std::vector<std::uint32_t>& chosen)
{
    if (cloud.type.empty() || chosen.empty()) return;
    const std::vector<char> is_wall_mk = walls_of(cloud, chosen, right, up);
    const auto is_wall = [&](std::uint32_t i)
    { return cloud.type[i] == fixed && is_wall_mk[cloud.mk[i]] != 0; };
    Box3 walls;
    for (const std::uint32_t i : chosen)
        if (is_wall(i)) walls.add(cloud.positions[i]);
    if (walls.is_empty()) return;

    const HiddenDepths depths(cloud, chosen, towards, right, up);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (std::abs(towards[axis]) < least_slope || walls.max[axis] == walls.min[axis]) continue;
        const auto is_at_side = [&](std::uint32_t i)
        {
            const double at = cloud.positions[i][axis];
            const double inwards = towards[axis] > 0 ? walls.max[axis] - at : at - walls.min[axis];
            return is_wall(i) && inwards < wall_depth_dp * cloud.dp;
        };
        if (std::any_of(chosen.begin(), chosen.end(),
                        [&](std::uint32_t i) { return is_at_side(i) && depths.hides(i); }))
            std::erase_if(chosen, is_at_side);
    }
    if (depths.hidden_share(chosen, is_wall_mk) > 0.5)
        std::erase_if(chosen, [&](std::uint32_t i) { return is_wall(i) && depths.hides(i); });
}

} // namespace fppg
