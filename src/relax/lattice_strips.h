#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include "meshes/point_grid.h"

#include <optional>
#include <vector>

namespace fppg
{

/// Where fluid stays on the lattice whatever stands beside it, as the solver goes on with it there:
/// at zones where it goes in and out (`<special><inout>`), at the ends of a period, and at the
/// buffers of `<vres>`; with all fluid that their particles reach, 2h + dp.
class LatticeStrips
{
public:
    LatticeStrips(const CaseDef& def, const RunField& field);

    /// cost  O(zones)
    bool has(const Vec3& p) const;
    /// Whether it is one beside a buffer of `<vres>`.
    bool has_beside_buffer(const Vec3& p) const;
    /// Whether it is one beside a zone where fluid goes in and out.
    bool has_beside_inlet(const Vec3& p) const;
    /// Whether a place is beside such a zone and not 0.7 dp before it, where the solver takes the
    /// particles of fluid out that do not come from the zone (v5.4, JSphInOut).
    bool is_behind_inlet(const Vec3& p) const;
    bool are_at_inlets() const { return !zones_.empty() || !points_.points().empty(); }
    /// Whether no particle may be put to a place beside such a zone. Between layers the lattice
    /// fills what is before it.
    bool keeps_out(const Vec3& p, bool is_between_layers) const
    {
        return is_between_layers ? has_beside_inlet(p) : is_behind_inlet(p);
    }

private:
    double reach_ = 0;        ///< metres
    double before_inlet_ = 0; ///< where fluid begins, metres
    bool is_2d_ = false;
    // All with their reach:
    Box3 inside_;                   ///< away from the ends of periods
    std::vector<Box3> zones_;       ///< of fluid that goes in and out
    std::vector<Vec3> zone_ways_;   ///< unit, in which it comes in; zero: not known
    PointGrid points_;              ///< the same where particles are the zone
    std::vector<Vec3> point_ways_;  ///< as above
    std::optional<ZoneBox> own_;    ///< away from the buffer of this zone of `<vres>`
    std::vector<ZoneBox> children_; ///< zones of `<vres>` in it
};

} // namespace fppg
