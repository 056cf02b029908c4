#pragma once

#include "fppg/lattice.h"
#include "fppg/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Where fluid can go from where it stands, over nodes that no wall has. Looks at the box of what
/// is drawn only, so that a large domain costs nothing.
class FluidWay
{
public:
    /// first_bound  mks below it are fluid
    /// gravity      only its largest component counts; zero: nothing rises, and all that an open
    ///              side of the lattice can be reached from runs out
    FluidWay(const RunField& field, std::uint16_t first_bound, const Vec3& gravity);

    /// As if the particles of one mk were the only wall; lengths only.
    static FluidWay around(const RunField& field, std::uint16_t first_bound, std::uint16_t mk);

    /// What fluid does to come to a place (to the free cell nearest to it, within about a cell).
    struct Way
    {
        double length = 0;     ///< dp; infinite where fluid cannot come
        double rise = 0;       ///< dp above the highest fluid, on the way that needs the least
        bool is_free = false;  ///< some cell there has no wall
        bool runs_out = false; ///< from there it would leave the lattice, down or sideways
    };
    /// Without fluid all lengths and rises are 0.
    Way to(const Vec3& p) const;

private:
    using Cells = std::vector<std::size_t>;

    template <typename IsBound>
    FluidWay(const RunField& field, std::uint16_t first_bound, const IsBound& is_bound);

    std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return static_cast<std::size_t>((x * n_[1] + y) * n_[2] + z);
    }
    std::array<std::int64_t, 3> place(std::size_t cell) const;
    /// Cells from the lowest up; all are 0 without gravity.
    std::uint16_t height(std::size_t cell) const;
    /// Calls visit(cell, how many cells higher it is) for the cells that have a side in common with
    /// one.
    template <typename Visit>
    void for_each_beside(std::size_t cell, const Visit& visit) const;

    void mark(std::int64_t x, const Run& run, std::uint16_t steps);
    void measure_lengths();
    void measure_heights();
    void find_what_runs_out(const LatticeGrid& grid);

    LatticeGrid grid_;
    std::uint32_t side_ = 1;              ///< nodes along the side of a cell
    std::array<std::int64_t, 3> first_{}; ///< node of the first cell
    std::array<std::int64_t, 3> n_{};
    int up_axis_ = -1; ///< -1: no gravity
    bool is_up_negative_ = false;
    std::vector<std::uint16_t> steps_;   ///< from fluid, in cells
    std::vector<std::uint16_t> heights_; ///< that fluid has to reach on its way
    std::vector<char> runs_out_;
    std::uint16_t top_ = 0; ///< height of the highest fluid
    bool has_fluid_ = false;
};

} // namespace fppg
