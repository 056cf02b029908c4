#pragma once

#include "fppg/element.h"
#include "fppg/lattice.h"
#include "fppg/vec.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// A box of `<vres>`: along the axes, or turned or moved by a `<transform>`. In 2D y of all three
/// edges is 0.
struct ZoneBox
{
    Vec3 corner;               ///< the lowest one before a turn
    std::array<Vec3, 3> edges; ///< from the corner
    bool is_plain = true;      ///< along the axes and without a transform

    Vec3 far_corner() const { return corner + edges[0] + edges[1] + edges[2]; }
};

/// One region of a resolution; zone 0 is the whole domain. The boxes are those of the particles at
/// their limits, as read from GenCase v5.4.354's `<execution><vres>`, which shows them half a dp
/// further out (those of the zone) or in (those of the zone around it).
struct VresZone
{
    int line = 0;    ///< of the element
    int parent = -1; ///< -1: this is zone 0
    double dp = 0;
    Vec3 pointref;       ///< the lattice of a plain box goes through it
    ZoneBox inner;       ///< what the definition gives, rounded outwards to the zone's lattice
    ZoneBox buffer;      ///< inner and its buffer: the particles of the zone
    ZoneBox full;        ///< buffer and 2 h of fixed particles around it, made by the solver
    ZoneBox outer_begin; ///< where the buffer of the zone around begins
    ZoneBox outer_end;   ///< where it ends; particles of the zone around further in are not made
    ZoneBox outer_fixed; ///< and its fixed particles
    double buffer_h = 2; ///< width of the buffer of this zone in its h
    std::optional<int> tracked_mkbound;
    /// Text of posmin x, y, z, posmax x, y, z of `<simulationdomain>`; empty without the element.
    std::vector<std::string> simulation_domain;
    bool uses_parent_domain = false;
    std::vector<Element> extra; ///< children of `<extra>`, copied
};

/// `<vres>`: the zones by their number, parents before their children; empty without the block.
struct VresDef
{
    std::vector<VresZone> zones;
    bool is_2d = false;
    double y_2d = 0;
    bool is_active() const { return !zones.empty(); }
};

/// The axis-aligned limits of a box.
Box3 limits_of(const ZoneBox& box);

/// A box whose faces stand `by` metres further out, in 2D but for those across y; negative: further
/// in.
ZoneBox resized(ZoneBox box, double by, bool is_2d);

/// Whether a place is in a box, its faces included; in 2D whatever its y.
bool is_within(const ZoneBox& box, const Vec3& p, bool is_2d);

/// Whether the solver takes a place in zone `zone` for one in a buffer: that of the zone, or one
/// round a zone in it (v5.4, JSphBufferZone::InZoneBox; its boxes stand half a dp off these).
bool is_in_buffer(const VresDef& vres, std::size_t zone, const Vec3& p);

/// Takes the particles out of a field that zone `zone` has not: those outside its own box where
/// that is turned, and those inside the zones in it, more than a dp beyond where the buffer ends.
/// Those of walls are gone before (lattice/zone_clip.h).
///
/// cost  O(runs + columns of the boxes); where a box is turned, its nodes
void clip_to_zone(const VresDef& vres, std::size_t zone, RunField& field);

} // namespace fppg
