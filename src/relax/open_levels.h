#pragma once

#include "fppg/lattice.h"
#include "fppg/relax_volume.h"
#include "fppg/vec.h"

#include "core/disjoint_set.h"
#include "nodes/snap.h"
#include "nodes/upward_field.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace fppg
{

/// The free surfaces of fluid on nodes: of all fluid that is joined the highest one.
class OpenLevels
{
public:
    /// No fluid has a free surface.
    OpenLevels() = default;
    /// A column ends at a free surface where no wall is above its highest node within 2.2 dp.
    ///
    /// bound_first  absolute mk of the first boundary
    OpenLevels(const RunField& field, const UpAxis& up, std::uint16_t bound_first,
               const ClosestWallPoint& closest, int threads);

    /// Whether a node is above the free surface of the fluid on another.
    bool is_above(const Node& node, const Node& of_fluid) const;

private:
    static constexpr std::int64_t no_level = -1;

    bool is_fluid(const Run& run) const { return !run.is_covered && run.mk < bound_first_; }
    void join_columns(DisjointSets<std::size_t>& sets, std::size_t x, std::size_t to_x,
                      std::uint32_t to_y) const;
    bool is_open(std::size_t x, std::size_t i, const ClosestWallPoint& closest) const;

    std::optional<UpwardField> upward_; ///< nothing: it has no free surface
    std::uint16_t bound_first_ = 0;
    std::vector<std::size_t> first_;   ///< per slab the number of its first run
    std::vector<std::int64_t> levels_; ///< per run the highest node below the free surface
};

} // namespace fppg
