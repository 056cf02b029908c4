#include "fppg/compare.h"

#include "files/particle_source.h"
#include "files/thinned_cloud.h"

#include <utility>

namespace fppg
{

std::array<ParticleCloud, 2> clouds_for_picture(const Comparison& comparison, std::size_t most)
{
    const ParticleSource a(comparison.files[0].path);
    const ParticleSource b(comparison.files[1].path);
    // Cubes of the same size in both, so that the pictures can be compared.
    for (std::uint64_t step = 1;; ++step)
    {
        auto of_a = one_of_every_cube(a, comparison.files[0].bounds.min, comparison.dp, step, most);
        if (!of_a) continue;
        auto of_b = one_of_every_cube(b, comparison.files[1].bounds.min, comparison.dp, step, most);
        if (of_b) return {std::move(*of_a), std::move(*of_b)};
    }
}

} // namespace fppg
