#include "particles/upward_depths.h"

#include "core/parallel.h"
#include "nodes/run_at.h"
#include "particles/roofs.h"

#include <algorithm>

namespace fppg
{

UpwardDepths::UpwardDepths(const RunField& field, const std::vector<ParticleType>& type_of_mk,
                           const OffLatticeParticles& off_lattice, const UpAxis& up, int threads)
    : upward_(field, up, threads),
      meter_(upward_.field(), type_of_mk, false),
      top_(upward_.field().slabs.size()),
      hosts_(upward_.field(), meter_)
{
    parallel_for(
        top_.size(), threads, [&](std::size_t x) { top_[x] = meter_.depths_along_z(x); }, 16);
    raise_roofed_depths(
        upward_.field(), off_lattice, [&](const Vec3& p) { return upward_.turned(p); }, meter_,
        top_);
}

double UpwardDepths::of_node(const Node& node) const
{
    const Node at = upward_.turned(node);
    const Run* run = run_at(upward_.field(), at);
    if (run == nullptr) return 0;
    const auto x = static_cast<std::size_t>(at.x);
    const auto i = static_cast<std::size_t>(run - upward_.field().slabs[x].data());
    return static_cast<double>(top_[x][i] + (run->z_end - 1 - static_cast<std::uint32_t>(at.z))) *
           step();
}

double UpwardDepths::of_place(const Vec3& p) const
{
    const Host host = hosts_.find(upward_.turned(p));
    if (host.slab == Host::none) return 0;
    const double steps = top_[host.slab][host.run] + host.below;
    return std::max(steps + host.offset.z, 0.0) * step();
}

} // namespace fppg
