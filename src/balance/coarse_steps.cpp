#include "balance/coarse_steps.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{
namespace
{

/// So much of the mean step of a cell is added, once and by momentum. Waves of the shortest length
/// that cells resolve, 8 dp, stay stable up to about 15.
constexpr double gain = 4;
constexpr double against_force = 0.5;

} // namespace

Vec3 momentum_of(const Vec3& v, const Vec3& force, double momentum)
{
    return momentum * (dot(v, force) < 0 ? against_force : 1.0) * v;
}

CoarseSteps::CoarseSteps(std::span<const Vec3> positions,
                         const std::function<bool(std::size_t)>& takes, double cell)
    : cell_(cell)
{
    Box3 box;
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (takes(i)) box.add(positions[i]);
    if (box.is_empty()) return;
    origin_ = box.min;
    for (int axis = 0; axis < 3; ++axis)
        n_[static_cast<std::size_t>(axis)] =
            static_cast<std::size_t>(std::lround((box.max[axis] - box.min[axis]) / cell)) + 1;
    std::vector<std::uint32_t> cells(positions.size());
    first_.assign(n_[0] * n_[1] * n_[2] + 1, 0);
    const auto cell_of = [&](const Vec3& p)
    {
        std::array<std::size_t, 3> at{};
        for (int axis = 0; axis < 3; ++axis)
            at[static_cast<std::size_t>(axis)] =
                static_cast<std::size_t>(std::lround((p[axis] - origin_[axis]) / cell_));
        return index(at[0], at[1], at[2]);
    };
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (takes(i)) ++first_[cell_of(positions[i]) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    members_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (takes(i)) members_[next[cell_of(positions[i])]++] = static_cast<std::uint32_t>(i);
    velocities_.resize(first_.size() - 1);
}

void CoarseSteps::add(const std::function<Vec3(std::size_t)>& step, double momentum, int threads)
{
    parallel_for(
        velocities_.size(), threads,
        [&](std::size_t c)
        {
            const std::uint32_t count = first_[c + 1] - first_[c];
            if (count == 0) return;
            Vec3 mean;
            for (std::uint32_t m = first_[c]; m < first_[c + 1]; ++m)
                mean = mean + step(members_[m]);
            mean = mean / count;
            Vec3& v = velocities_[c];
            v = momentum_of(v, mean, momentum) + gain * mean;
        },
        64);
}

Vec3 CoarseSteps::at(const Vec3& p) const
{
    if (velocities_.empty()) return {};
    std::array<std::array<std::size_t, 2>, 3> at{};
    std::array<std::array<double, 2>, 3> share{};
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        const auto last = static_cast<double>(n_[a] - 1);
        const double place = std::clamp((p[axis] - origin_[axis]) / cell_, 0.0, last);
        const double low = std::min(std::floor(place), std::max(0.0, last - 1));
        at[a] = {static_cast<std::size_t>(low),
                 std::min(static_cast<std::size_t>(low) + 1, n_[a] - 1)};
        share[a] = {1 - (place - low), place - low};
    }
    Vec3 sum;
    double weights = 0;
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
        const std::array<std::size_t, 3> of{corner & 1U, corner >> 1U & 1U, corner >> 2U};
        const std::size_t c = index(at[0][of[0]], at[1][of[1]], at[2][of[2]]);
        if (first_[c + 1] == first_[c]) continue;
        const double weight = share[0][of[0]] * share[1][of[1]] * share[2][of[2]];
        sum = sum + weight * velocities_[c];
        weights += weight;
    }
    return weights > 0 ? sum / weights : Vec3{};
}

} // namespace fppg
