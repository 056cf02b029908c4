#pragma once

#include "fppg/lattice.h"

#include "nodes/snap.h"

#include <algorithm>
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

} // namespace fppg
