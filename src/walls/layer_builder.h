#pragma once

#include "fppg/case_def.h"

#include "lattice/fitted_draw.h"
#include "meshes/point_grid.h"
#include "offset/offset_surface.h"
#include "walls/merged_sheet.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace fppg
{

/// Side of the cells that offset surfaces are cut from, dp.
inline constexpr double offset_cell_dp = 0.5;
/// The same where a wall turns by less than this many radians a dp: plates and boxes of more than
/// 60 dp, balls of more than 40. There it takes half the time for the same layers; the layers of a
/// vehicle that turns by 0.07 were less even by it (spread 0.054 instead of 0.046).
inline constexpr double coarse_cell_dp = 0.7;
inline constexpr double few_turns = 0.05;
/// Which of the two the layers of a wall take, 3D.
double layer_cell_dp(const SurfaceMesh& wall, double dp);

/// Which layers a wall gets.
struct LayerPlan
{
    std::vector<double> depths_dp; ///< ascending; 0 is the surface itself, which has no layer
    double spacing_dp = 1;         ///< of the particles in a layer
    /// Where the middle of a part is less deep than this, one sheet on it serves both sides, dp; 0:
    /// nowhere.
    double middle_dp = 0;
    std::vector<SheetGap> gaps{};    ///< where one on it is between layers of both sides
    double cell_dp = offset_cell_dp; ///< of the grid that the surfaces of layers are cut from
    int parts = 0;                   ///< MergedSheetOptions::parts
    double off_edges_dp = 0.45;      ///< the sheet keeps so far from sharp edges, dp
    std::size_t number = 0; ///< of all particles, for which the sheet makes up; 0: not given
};

/// Layers of two sides that would be nearer than this merge, dp.
inline constexpr double merge_dp = 0.6;
/// Layers of two sides that are farther apart have a sheet between them, dp.
inline constexpr double least_gap_dp = 1.2;

/// Builds the layers of one draw on one side of its surface.
class LayerBuilder
{
public:
    /// settings, grid and out must outlive the object
    LayerBuilder(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
        : settings_(settings), grid_(grid), threads_(threads), out_(out)
    {
    }

    /// Of a sheet: where the fluid nearest to it is not; behind, where there is no fluid.
    LayerSide side_without_fluid() const;

    /// Adds the layers of a plan with their particles to the draw.
    void build(WallSide side, bool is_closed, const LayerPlan& plan);

    /// Adds a layer in the middle of thin parts, which serves both sides. build() and lay_again()
    /// do so but for plans with a number.
    void merge_sides();

    /// Takes the particles of all layers out and lays them with another spacing.
    ///
    /// is_trial  only the number of particles is right
    void lay_again(double spacing_dp, bool is_trial);

    /// The sheet in the middle makes up for this number of all particles; 0: it has one per dp^2.
    void set_number(std::size_t number) { plan_.number = number; }

    /// The depth of a body, in 2D of its section; null where it has none. Not that of round faces
    /// beyond sharp edges but for sharp_angle_deg.
    std::shared_ptr<const WallDepth> wall_of(WallSide side, bool is_closed, double sharp_angle_deg,
                                             double deepest_dp) const;

    /// The surface at a depth behind the wall, metres; the wall that it was made from may be
    /// another in `wall` then.
    OffsetSurface surface_at(double depth, double cell_dp, WallSide side, bool is_closed,
                             std::shared_ptr<const WallDepth>& wall);

private:
    void name_owners(const WallDepth& wall, FittedBody& body) const;
    bool meets_other_side(const FittedBody& body, const Vec3& p) const;
    MergedSheetOptions sheet_options() const;
    void look_for_thin_parts(const WallDepth& wall);
    void add_shared(std::size_t number, const std::vector<std::size_t>& numbers,
                    const std::vector<double>& depths, const SurfaceParticles& sheet);
    void drop_crowded(const std::vector<char>& is_out, SurfaceParticles& particles,
                      std::vector<char>& goes);
    void add_particles(FittedBody& layer, std::uint32_t index);

    const FitSettings& settings_;
    const LatticeGrid& grid_;
    int threads_;
    FittedDraw& out_;
    LayerPlan plan_;
    bool is_trial_ = false;
    std::shared_ptr<const WallDepth> wall_;
    std::shared_ptr<const WallDepth> rounded_; ///< made where a mitre fails
    Features sharp_;
    ThinParts thin_;
    std::unique_ptr<PointGrid> near_middle_;
};

} // namespace fppg
