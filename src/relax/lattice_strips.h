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

private:
    double reach_ = 0; ///< metres
    bool is_2d_ = false;
    // All with their reach:
    Box3 inside_;                   ///< away from the ends of periods
    std::vector<Box3> zones_;       ///< of fluid that goes in and out
    PointGrid points_;              ///< the same where particles are the zone
    std::optional<ZoneBox> own_;    ///< away from the buffer of this zone of `<vres>`
    std::vector<ZoneBox> children_; ///< zones of `<vres>` in it
};

} // namespace fppg
