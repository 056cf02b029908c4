#include "files/thinned_cloud.h"

#include <cstdint>
#include <unordered_set>
#include <utility>

namespace fppg
{

namespace
{

/// After this many particles the pages of the file are given back.
constexpr std::size_t particles_held = std::size_t{1} << 20;

struct MkCube
{
    std::uint64_t cube = 0;
    std::uint16_t mk = 0;
    bool operator==(const MkCube&) const = default;
};

struct MkCubeHash
{
    std::size_t operator()(const MkCube& key) const
    {
        // Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4).
        return static_cast<std::size_t>((key.cube ^ std::uint64_t{key.mk} << 47U) *
                                        0x9E3779B97F4A7C15U);
    }
};

} // namespace

std::optional<ParticleCloud> one_of_every_cube(const ParticleSource& source, const Vec3& from,
                                               double dp, std::uint64_t step, std::size_t most)
{
    if (step == 1 && source.size() > most) return std::nullopt;
    ParticleCloud cloud;
    cloud.file = source.path();
    cloud.colours = source.facts().colours;
    cloud.dp = dp * static_cast<double>(step);
    std::unordered_set<MkCube, MkCubeHash> taken;
    for (std::size_t i = 0; i < source.size(); ++i)
    {
        if (i % particles_held == particles_held - 1) source.release();
        const Vec3 p = source.position(i);
        const std::uint16_t mk = source.mk(i);
        if (step > 1)
        {
            const Vec3 cell = (p - from) / cloud.dp;
            const std::uint64_t cube = static_cast<std::uint64_t>(cell.x) << 42U |
                                       static_cast<std::uint64_t>(cell.y) << 21U |
                                       static_cast<std::uint64_t>(cell.z);
            if (!taken.insert({cube, mk}).second) continue;
        }
        if (cloud.positions.size() >= most) return std::nullopt;
        cloud.positions.push_back(p);
        cloud.mk.push_back(mk);
        if (source.has_types()) cloud.type.push_back(source.type(i));
    }
    return cloud;
}

ParticleCloud thinned_cloud(const ParticleSource& source, const Vec3& from, double dp,
                            std::size_t most)
{
    // Beyond this step a cube holds the case, so that only the number of mks is left.
    constexpr std::uint64_t last_step = 1U << 20U;
    for (std::uint64_t step = 1; step < last_step; step += 1 + step / 64)
        if (auto cloud = one_of_every_cube(source, from, dp, step, most)) return std::move(*cloud);
    return *one_of_every_cube(source, from, dp, last_step, SIZE_MAX);
}

} // namespace fppg
