#include "meshes/close_pairs.h"

#include "core/morton.h"
#include "core/parallel.h"

#include <cmath>

namespace fppg
{

ClosePairs::ClosePairs(const std::vector<Vec3>& points, double reach, int threads) : reach_(reach)
{
    const std::size_t n = points.size();
    Box3 box;
    for (const Vec3& p : points) box.add(p);
    // Cells have names below 2^62, and one more on every side, which is empty.
    constexpr double most_cells = 4e18;
    double cell = reach * (1 + 1e-6);
    const auto cells_along = [&](int axis)
    { return std::floor((box.max[axis] - box.min[axis]) / cell) + 3; };
    while (n > 0 && !(cells_along(0) * cells_along(1) * cells_along(2) < most_cells)) cell *= 2;
    if (n == 0) return;
    row_of_[1] = static_cast<std::uint64_t>(cells_along(2));
    row_of_[0] = row_of_[1] * static_cast<std::uint64_t>(cells_along(1));
    RawArray<Keyed> keyed(n);
    parallel_for(
        n, threads,
        [&](std::size_t i)
        {
            const auto cell_at = [&](int axis)
            { return static_cast<std::uint64_t>((points[i][axis] - box.min[axis]) / cell) + 1; };
            keyed[i] = {cell_at(0) * row_of_[0] + cell_at(1) * row_of_[1] + cell_at(2),
                        static_cast<std::uint32_t>(i)};
        },
        4096);
    sort_by_key(keyed, n, row_of_[0] * static_cast<std::uint64_t>(cells_along(0)), threads);
    keys_.resize(n);
    points_.resize(n);
    parallel_for(
        n, threads,
        [&](std::size_t k)
        {
            keys_[k] = keyed[k].key;
            points_[k] = {points[keyed[k].index], keyed[k].index};
        },
        4096);
}

} // namespace fppg
