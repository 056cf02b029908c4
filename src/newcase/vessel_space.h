#pragma once

#include "fppg/lattice.h"
#include "newcase/plan.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// The room of a vessel that holds fluid, on a lattice of about a million nodes: its largest cavity
/// or basin, less the parts in it. Volumes are right to a few per cent.
class VesselSpace
{
public:
    VesselSpace(const CasePlan& plan, std::size_t vessel);

    bool is_empty() const { return nodes_.empty(); }
    /// Nothing runs out, however much is filled in.
    bool is_closed() const { return is_closed_; }
    double capacity() const { return volume_below(rim_); } ///< m3, up to the rim
    double rim() const { return rim_; }                    ///< z; of a closed one its highest place
    double bottom() const { return bottom_; }
    Vec3 rim_place() const { return rim_place_; } ///< where it runs out
    double spacing() const { return grid_.dp; }
    double volume_below(double z) const;
    double level_of(double volume) const; ///< z
    /// A place in it, as far from all surfaces as can be, those of floats too, below a level where
    /// there is one.
    Vec3 seed(double level) const;

private:
    std::size_t count() const;
    Vec3 place(std::size_t node) const;
    void mark_part(const NewPart& part, int threads, std::vector<std::uint8_t>& marks);
    void mark_surface(const TriangleSoup& soup, std::vector<std::uint8_t>& marks) const;
    void find_spills();
    void find_largest();
    Vec3 spill_place(std::size_t node) const;
    template <typename Visit>
    void for_each_beside(std::size_t node, const Visit& visit) const;

    LatticeGrid grid_;
    std::vector<std::uint8_t> state_;     ///< bit 0: in a solid, bit 1: a surface passes
    std::vector<std::uint8_t> of_floats_; ///< the same of parts that float, which are in the room
    /// For each node that is free the lowest height over which a way leads out, in nodes.
    std::vector<std::uint16_t> spill_;
    std::vector<std::uint32_t> way_out_;   ///< the next node on that way; its own where it ends
    std::vector<std::uint32_t> nodes_;     ///< of the room
    std::vector<std::uint32_t> at_height_; ///< nodes of the room and its rim, by their z
    bool is_closed_ = false;
    double rim_ = 0;
    double bottom_ = 0;
    Vec3 rim_place_;
};

} // namespace fppg
