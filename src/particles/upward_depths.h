#pragma once

#include "fppg/particles.h"

#include "nodes/upward_field.h"
#include "particles/depths.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Depths of water at rest under gravity along any axis, also under roofs (roofs.h), for fluid that
/// is to be balanced. GenCase counts steps along the positive way of the axis, up to the first
/// wall.
class UpwardDepths
{
public:
    UpwardDepths(const RunField& field, const std::vector<ParticleType>& type_of_mk,
                 const OffLatticeParticles& off_lattice, const UpAxis& up, int threads);

    /// Metres, of a node of water.
    double of_node(const Node& node) const;
    /// Of a place beside nodes of fluid; 0 where none is near.
    double of_place(const Vec3& p) const;
    /// Between nodes along the axis, metres.
    double step() const { return upward_.field().grid.step(2); }

private:
    UpwardField upward_;
    DepthMeter meter_;
    std::vector<std::vector<std::uint32_t>> top_; ///< per run, steps from its highest node
    HostFinder hosts_;
};

} // namespace fppg
