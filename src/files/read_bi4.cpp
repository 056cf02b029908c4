#include "core/parallel.h"
#include "files/particle_readers.h"

#include <cstring>
#include <string_view>

namespace fppg
{

namespace
{

template <typename T>
void copy_positions(std::string_view data, std::vector<Vec3>& positions, int threads)
{
    const auto copy = [&](std::size_t i)
    {
        T p[3];
        std::memcpy(p, data.data() + i * sizeof p, sizeof p);
        positions[i] = {p[0], p[1], p[2]};
    };
    parallel_for(positions.size(), threads, copy, particles_per_chunk);
}

} // namespace

void copy_particles(const Bi4View& view, ParticleCloud& cloud, std::vector<std::uint32_t>& idp,
                    int threads)
{
    const std::size_t n = view.size();
    idp.resize(n);
    if (n > 0) std::memcpy(idp.data(), view.idp.data(), 4 * n);
    cloud.positions.resize(n);
    if (view.is_single())
        copy_positions<float>(view.pos, cloud.positions, threads);
    else
        copy_positions<double>(view.posd, cloud.positions, threads);
}

} // namespace fppg
