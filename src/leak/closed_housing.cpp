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

ClosedHousing::ClosedHousing(const CaseSolids& solids, const std::vector<Vec3>& fluid, double dp,
                             const double* plane_y, int threads)
{
    Box3 box;
    std::vector<const Solid*> walls;
    for (const CaseShape& shape : solids.shapes)
    {
        if (shape.kind != MkKind::Bound) continue;
        walls.push_back(shape.solid.get());
        box.add(shape.solid->bounds().min);
        box.add(shape.solid->bounds().max);
    }
    if (walls.empty() || fluid.empty()) return;
    if (plane_y != nullptr) box.min.y = box.max.y = *plane_y;
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
        const bool is_flat = plane_y != nullptr && axis == 1;
        origin_[axis] = box.min[axis] - (is_flat ? 0 : static_cast<double>(margin) * spacing_);
    }
    state_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), 0);
    const std::int64_t slab = n_[1] * n_[2];
    parallel_for(
        static_cast<std::size_t>(n_[0]), threads,
        [&](std::size_t x)
        {
            for (std::int64_t i = 0; i < slab; ++i)
            {
                const std::int64_t row = i / n_[2];
                const Vec3 p = origin_ + Vec3{static_cast<double>(x), static_cast<double>(row),
                                              static_cast<double>(i % n_[2])} *
                                             spacing_;
                for (const Solid* wall : walls)
                    if (wall->is_nearer(p, blocked_within * spacing_))
                    {
                        state_[x * static_cast<std::size_t>(slab) + static_cast<std::size_t>(i)] =
                            near_surface;
                        break;
                    }
            }
        });
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
                std::uint8_t& state = state_[static_cast<std::size_t>(node + way * step[axis])];
                if (state != 0) continue;
                state = outside;
                open.push_back(node + way * step[axis]);
            }
    }
    is_closed_ =
        std::none_of(fluid.begin(), fluid.end(), [&](const Vec3& p) { return is_outside(p); });
}

bool ClosedHousing::is_outside(const Vec3& p) const
{
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
