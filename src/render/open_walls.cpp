#include "render/open_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

constexpr double wall_depth_dp = 4.5;
/// A side that the camera sees at less than this (sine of the angle) hides nothing.
constexpr double least_slope = 0.1;
constexpr std::uint8_t fixed = 0;
constexpr std::uint8_t fluid = 3;
/// A wall reaches along so much of all that is not fixed, on two axes at least; other parts stand
/// in the fluid, as a car in water.
constexpr double least_reach = 0.75;

/// Unit vectors of the picture.
struct PictureAxes
{
    Vec3 towards; ///< the camera
    Vec3 right;
    Vec3 up;
};

bool is_part(const ParticleCloud& cloud, std::uint32_t i, const std::vector<char>& is_wall)
{
    return cloud.type[i] != fluid && (cloud.type[i] != fixed || is_wall[cloud.mk[i]] == 0);
}

/// Per mk whether its fixed particles are walls around the rest.
std::vector<char> walls_of(const ParticleCloud& cloud, const std::vector<std::uint32_t>& chosen)
{
    std::map<std::uint16_t, Box3> fixed_boxes;
    Box3 rest;
    for (const std::uint32_t i : chosen)
        (cloud.type[i] == fixed ? fixed_boxes[cloud.mk[i]] : rest).add(cloud.positions[i]);
    std::vector<char> out(65536, 0);
    if (rest.is_empty()) return out;
    for (const auto& [mk, box] : fixed_boxes)
    {
        int axes = 0;
        for (int axis = 0; axis < 3; ++axis)
            axes += box.max[axis] - box.min[axis] >= least_reach * (rest.max[axis] - rest.min[axis])
                        ? 1
                        : 0;
        out[mk] = axes >= 2 ? 1 : 0;
    }
    return out;
}

/// Cuts fluid that hides all parts, down to the middle of these, as seen along the ground. Returns
/// whether it did.
bool open_fluid(const ParticleCloud& cloud, const PictureAxes& axes,
                const std::vector<char>& is_wall, std::vector<std::uint32_t>& chosen)
{
    Box3 parts;
    for (const std::uint32_t i : chosen)
        if (is_part(cloud, i, is_wall)) parts.add(cloud.positions[i]);
    if (parts.is_empty()) return false;
    const double cell = 1.2 * cloud.dp;
    const auto cell_of = [&](std::uint32_t i)
    {
        const Vec3 p = cloud.positions[i] - parts.min;
        return std::pair(std::floor(dot(p, axes.right) / cell), std::floor(dot(p, axes.up) / cell));
    };
    std::map<std::pair<double, double>, double> part_depths; // of cells with parts, the nearest
    for (const std::uint32_t i : chosen)
    {
        if (!is_part(cloud, i, is_wall)) continue;
        const double depth = dot(cloud.positions[i], axes.towards);
        const auto [at, is_new] = part_depths.try_emplace(cell_of(i), depth);
        at->second = std::max(at->second, depth);
    }
    std::set<std::pair<double, double>> hidden;
    for (const std::uint32_t i : chosen)
    {
        if (cloud.type[i] != fluid) continue;
        const auto at = part_depths.find(cell_of(i));
        if (at != part_depths.end() && dot(cloud.positions[i], axes.towards) > at->second)
            hidden.insert(at->first);
    }
    if (static_cast<double>(hidden.size()) < 0.95 * static_cast<double>(part_depths.size()))
        return false;
    Vec3 way{axes.towards.x, axes.towards.y, 0};
    if (norm(way) < least_slope) way = axes.towards;
    const double middle = dot(0.5 * (parts.min + parts.max), way);
    std::erase_if(chosen, [&](std::uint32_t i)
                  { return cloud.type[i] == fluid && dot(cloud.positions[i], way) > middle; });
    return true;
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
    const std::vector<char> is_wall_mk = walls_of(cloud, chosen);
    const auto is_wall = [&](std::uint32_t i)
    { return cloud.type[i] == fixed && is_wall_mk[cloud.mk[i]] != 0; };
    Box3 walls;
    for (const std::uint32_t i : chosen)
        if (is_wall(i)) walls.add(cloud.positions[i]);
    if (walls.is_empty())
    {
        open_fluid(cloud, {towards, right, up}, is_wall_mk, chosen);
        return;
    }

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
    const bool stays_hidden = depths.hidden_share(chosen, is_wall_mk) > 0.5;
    if (open_fluid(cloud, {towards, right, up}, is_wall_mk, chosen) || stays_hidden)
        std::erase_if(chosen, [&](std::uint32_t i) { return is_wall(i) && depths.hides(i); });
}

} // namespace fppg
