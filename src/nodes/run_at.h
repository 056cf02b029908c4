#pragma once

#include "fppg/lattice.h"

#include "nodes/snap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

namespace fppg
{

/// The run that a node is in; null: nothing is there.
inline const Run* run_at(const RunField& field, const Node& n)
{
    if (!is_inside(n, field.grid)) return nullptr;
    const std::vector<Run>& slab = field.slabs[static_cast<std::size_t>(n.x)];
    const auto after =
        std::upper_bound(slab.begin(), slab.end(), std::pair(n.y, n.z),
                         [](const std::pair<std::int64_t, std::int64_t>& at, const Run& r)
                         { return at < std::pair<std::int64_t, std::int64_t>(r.y, r.z_begin); });
    if (after == slab.begin()) return nullptr;
    const Run& r = *std::prev(after);
    return r.y == n.y && n.z < r.z_end ? &r : nullptr;
}

/// Whether fluid stands on the node nearest to a place.
///
/// first_bound  absolute mk of the first boundary
inline bool has_fluid_near(const RunField& field, const Vec3& p, std::uint16_t first_bound)
{
    const Vec3 at = field.grid.steps_to(p);
    const auto nearest = [](double c)
    { return static_cast<std::int64_t>(std::clamp(std::round(c), -1.0, 1e10)); };
    const Run* run =
        run_at(field, {nearest(at.x), field.grid.is_2d ? 0 : nearest(at.y), nearest(at.z)});
    return run != nullptr && !run->is_covered && run->mk < first_bound;
}

} // namespace fppg
