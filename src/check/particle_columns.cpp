#include "check/particle_columns.h"

#include "core/parallel.h"

namespace fppg
{

ParticleColumns::ParticleColumns(const std::vector<Vec3>& positions,
                                 const std::vector<std::uint32_t>& chosen, double width,
                                 int threads)
    : width_(width)
{
    Box3 box;
    for (const std::uint32_t i : chosen) box.add(positions[i]);
    if (chosen.empty()) return;
    least_ = box.min;
    const double most = 4.0 * static_cast<double>(chosen.size()) + 1024;
    const auto steps = [&](int axis)
    { return std::floor((box.max[axis] - box.min[axis]) / width_) + 1; };
    while (steps(0) * steps(1) > most) width_ *= 1.5;
    n_[0] = static_cast<std::int64_t>(steps(0));
    n_[1] = static_cast<std::int64_t>(steps(1));

    const auto column_of = [&](const Vec3& p)
    { return static_cast<std::size_t>(column(p.x, 0) * n_[1] + column(p.y, 1)); };
    const auto columns = static_cast<std::size_t>(n_[0] * n_[1]);
    begins_.assign(columns + 1, 0);
    for (const std::uint32_t i : chosen) ++begins_[column_of(positions[i]) + 1];
    for (std::size_t c = 0; c < columns; ++c) begins_[c + 1] += begins_[c];
    indices_.resize(chosen.size());
    std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
    for (const std::uint32_t i : chosen) indices_[next[column_of(positions[i])]++] = i;
    points_.resize(chosen.size());
    parallel_for(
        columns, threads,
        [&](std::size_t c)
        {
            std::sort(indices_.begin() + begins_[c], indices_.begin() + begins_[c + 1],
                      [&](std::uint32_t a, std::uint32_t b) {
                          return positions[a].z != positions[b].z ? positions[a].z < positions[b].z
                                                                  : a < b;
                      });
            for (std::size_t k = begins_[c]; k < begins_[c + 1]; ++k)
                points_[k] = positions[indices_[k]];
        },
        256);
}

} // namespace fppg
