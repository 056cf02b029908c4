#include "leak/closed_housing.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

constexpr double most_nodes = 1 << 24;
constexpr std::int64_t margin = 3;      // nodes around all shapes
constexpr double blocked_within = 0.87; // half the diagonal of a cell, spacings
constexpr std::uint8_t near_surface = 1;
constexpr std::uint8_t outside = 2;

} // namespace

bool ClosedHousing::Wall::is_near(const Vec3& p, double distance) const
{
    return shape->solid->is_nearer(motion == nullptr ? p : motion->backward(p), distance);
}

ClosedHousing::ClosedHousing(const CaseSolids& solids, const MotionOfMk& motions, double dp,
                             const double* plane_y, int threads)
{
    Box3 box;
    std::vector<Wall> walls;
    for (const CaseShape& shape : solids.shapes)
    {
        if (shape.kind != MkKind::Bound) continue;
        const auto motion = motions.find(shape.mk);
        walls.push_back({&shape, motion == motions.end() ? nullptr : &motion->second});
        for (const Vec3& p : shape.solid->bounds().corners())
            box.add(walls.back().motion == nullptr ? p : walls.back().motion->forward(p));
    }
    if (walls.empty()) return;
    set_lattice(box, dp, plane_y);
    state_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), 0);
    const std::int64_t slab = n_[1] * n_[2];
    parallel_for(
        static_cast<std::size_t>(n_[0]), threads,
        [&](std::size_t x)
        {
            const std::int64_t first = static_cast<std::int64_t>(x) * slab;
            for (std::int64_t node = first; node < first + slab; ++node)
                if (std::any_of(walls.begin(), walls.end(),
                                [&](const Wall& wall)
                                { return wall.is_near(place(node), blocked_within * spacing_); }))
                    state_[static_cast<std::size_t>(node)] = near_surface;
        });
    flood(walls);
}

void ClosedHousing::set_lattice(const Box3& box, double dp, const double* plane_y)
{
    const Vec3 size = box.max - box.min;
    spacing_ = dp;
    const auto nodes_along = [&](int axis)
    {
        if (plane_y != nullptr && axis == 1) return std::int64_t{1};
        return static_cast<std::int64_t>(std::ceil(size[axis] / spacing_)) + 1 + 2 * margin;
    };
    const auto node_count = [&]
    {
        double all = 1;
        for (int axis = 0; axis < 3; ++axis) all *= static_cast<double>(nodes_along(axis));
        return all;
    };
    while (node_count() > most_nodes) spacing_ *= 1.25;
    for (int axis = 0; axis < 3; ++axis)
    {
        n_[static_cast<std::size_t>(axis)] = nodes_along(axis);
        origin_[axis] = plane_y != nullptr && axis == 1
                            ? *plane_y
                            : box.min[axis] - static_cast<double>(margin) * spacing_;
    }
}

Vec3 ClosedHousing::place(std::int64_t node) const
{
    const std::int64_t x = node / (n_[1] * n_[2]);
    const std::int64_t y = node / n_[2] % n_[1];
    const std::int64_t z = node % n_[2];
    return origin_ +
           Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} * spacing_;
}

void ClosedHousing::flood(const std::vector<Wall>& walls)
{
    const auto reach = [&](std::int64_t node)
    {
        for (const Wall& wall : walls)
            if (!mks_.contains(wall.shape->mk) &&
                wall.is_near(place(node), blocked_within * spacing_))
                mks_.insert(wall.shape->mk);
    };
    const std::int64_t slab = n_[1] * n_[2];
    // The first node is in the margin, away from every surface.
    std::vector<std::int64_t> open{0};
    state_[0] = outside;
    while (!open.empty())
    {
        const std::int64_t node = open.back();
        open.pop_back();
        const std::array<std::int64_t, 3> at{node / slab, node % slab / n_[2], node % n_[2]};
        const std::array<std::int64_t, 3> step{slab, n_[2], 1};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const std::int64_t way : {-1, 1})
            {
                if (at[axis] + way < 0 || at[axis] + way >= n_[axis]) continue;
                const std::int64_t next = node + way * step[axis];
                std::uint8_t& state = state_[static_cast<std::size_t>(next)];
                if (state == near_surface) reach(next);
                if (state != 0) continue;
                state = outside;
                open.push_back(next);
            }
    }
}

bool ClosedHousing::is_outside(const Vec3& p) const
{
    if (state_.empty()) return true;
    std::int64_t node = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const std::int64_t n = n_[static_cast<std::size_t>(axis)];
        const double at = std::round((p[axis] - origin_[axis]) / spacing_);
        if (n > 1 && !(at >= 0 && at < static_cast<double>(n))) return true;
        node = node * n + (n > 1 ? static_cast<std::int64_t>(at) : 0);
    }
    return state_[static_cast<std::size_t>(node)] == outside;
}

} // namespace fppg
