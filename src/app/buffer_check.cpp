#include "app/buffer_check.h"

#include "fppg/vres.h"

#include "app/thousands.h"
#include "particles/initials.h"
#include "particles/run_positions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdint>
#include <set>

namespace fppg
{

std::optional<std::string> check_buffers(const CaseDef& def, const CaseParticles& particles)
{
    if (!def.vres.is_active()) return std::nullopt;
    const bool is_modified = def.solver.boundary == 2;
    const std::vector<std::array<float, 3>>& normals = particles.bound_normals;
    std::uint64_t count = 0;
    std::set<std::uint16_t> mks;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type != ParticleType::Fixed && block.type != ParticleType::Moving) continue;
        const Transform map = motion_of(block);
        std::uint64_t id = block.begin;
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k, ++id)
            {
                const bool has_normal =
                    is_modified && !normals.empty() && normals[id] != std::array<float, 3>{};
                if (has_normal ||
                    !is_in_buffer(def.vres, def.zone, map(place_in_run(particles, block, run, k))))
                    continue;
                ++count;
                mks.insert(block.mk_type);
            }
    }
    if (count == 0) return std::nullopt;
    return fmt::format(
        "{}: {} particles of mkbound {} are in buffers of <vres>{}, where DualSPHysics v5.4 stops "
        "the run: {}.",
        def.file, thousands(count), fmt::join(mks, ", "), is_modified ? " without a normal" : "",
        is_modified ? "let <bodyfitted> have these mks, or give them <normals>"
                    : "with dynamic boundaries (Boundary=1) no wall may cross a buffer, with "
                      "modified ones (2) those with normals may");
}

} // namespace fppg
