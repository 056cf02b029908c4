#include "normals/wet_setup.h"

#include "particles/motion_path.h"

#include <algorithm>
#include <cstdint>

namespace fppg
{
namespace
{

constexpr int looks = 1000; ///< at a motion
constexpr double end_without_time_max = 10;

bool turns_over(const Transform& place)
{
    return place.linear[0].x < 0 || place.linear[1].y < 0 || place.linear[2].z < 0;
}

/// Which mks a motion turns by more than a right angle up to TimeMax, or by a file, of which that
/// is not known: the sides of these that look to fluid change.
std::vector<char> mks_that_turn_over(const CaseDef& def)
{
    std::vector<char> out(65536, 0);
    const double step = time_max(def.execution, end_without_time_max) / looks;
    for_each_moving(def.motion,
                    [&](const Element& object, const MotionChain& chain)
                    {
                        const double mkbound = number_or(object, "ref", -1);
                        if (!(mkbound >= 0) || mkbound + def.mk_bound_first >= 65536) return;
                        const std::vector<Transform> places = places_over(chain, step, looks);
                        if (places.empty() || std::any_of(places.begin(), places.end(), turns_over))
                            out[static_cast<std::size_t>(mkbound) + def.mk_bound_first] = 1;
                    });
    return out;
}

} // namespace

WetSurface::Setup wet_setup(const CaseDef& def, const CaseParticles& particles, double reach)
{
    WetSurface::Setup out;
    out.first_bound = def.mk_bound_first;
    out.gravity = def.constants.gravity;
    out.reach = reach;
    out.is_moving.assign(65536, 0);
    out.floats.assign(65536, 0);
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type == ParticleType::Moving) out.is_moving[block.mk] = 1;
        if (block.type == ParticleType::Floating) out.floats[block.mk] = 1;
    }
    out.turns_over = mks_that_turn_over(def);
    return out;
}

} // namespace fppg
