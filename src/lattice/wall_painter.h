#pragma once

#include "lattice/fitted_draw.h"
#include "lattice/wall_openings.h"
#include "meshes/inside_test.h"
#include "meshes/point_grid.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace fppg
{

/// The walls of a field while it is drawn: what a later draw paints over is cut out of them.
///
/// Draws on the lattice cut the particles whose node (the nearest one of the wall's zone at the
/// corners of their cell) they paint. A later fitted body cuts by its true shape: everything inside
/// it when it is solid, and everything nearer than 0.5 dp to its surface (0.1 dp where its own
/// particles stand half a dp behind that). In the end no particles
/// of two bodies are nearer than least_pair_dp to one another.
class WallPainter
{
public:
    WallPainter(RunField& field, int threads) : field_(&field), threads_(threads) {}

    bool has_walls() const { return !field_->walls.bodies.empty(); }

    /// A fitted body on top of all that was drawn; paints its nodes too.
    void add(FittedDraw&& draw);

    /// Before the spans of slab x are painted with `mk` (0: void). A redraw gives walls another mk
    /// and leaves them where they are if `keeps_walls`. Calls for different slabs may run at the
    /// same time. Returns the spans that must be painted with `mk` as covered.
    ///
    /// spares  what cut_by_shape() found is left
    Spans paint_over(std::size_t x, const Spans& spans, std::uint16_t mk, bool keeps_walls,
                     bool spares);

    /// Before a shape is painted: its holes in the sheets that were drawn so far, through all their
    /// layers. Sheets, where it makes such, and the bodies that it hollows are cut by its true
    /// shape, not by its nodes. Walls outside of an extent stay, as FittedStep::extent says:
    /// GenCase rounds radii to nodes, so that a tube of 7.5 dp is drawn a step farther out than
    /// fluid of 6.5 in it, where the true tube is within half a step of its nodes.
    ///
    /// returns  whether anything may be left that its nodes would cut
    bool cut_by_shape(const SourceRef& draw, FittedStep& step);
    /// Of spans to be painted, those without the nodes of what is left.
    Spans without_spared(std::size_t x, const Spans& spans) const;

    /// Cuts the particles at some places.
    ///
    /// is_cut  bool(const Vec3&)
    void cut_where(const std::function<bool(const Vec3&)>& is_cut);

    /// Forgets everything.
    void reset();

    /// Takes the cut particles out; those that are left within 2 dp of one are held.
    void finish();

private:
    struct Anchor
    {
        std::uint32_t y = 0;
        std::uint32_t z = 0;
        std::uint32_t particle = 0;
    };

    /// A closed body that its draw did not fill, and the nodes in it.
    struct Hollow
    {
        std::uint32_t body = 0;
        std::vector<Spans> nodes; ///< one entry per slab of the lattice
    };

    /// A wall in layers; nodes behind its surface and before a layer that stays are not painted.
    struct LayeredWall
    {
        Box3 box;
        const WallDepth* wall = nullptr;
        std::vector<double> depths; ///< metres, ascending
    };

    void set_extent(TriangleSoup&& extent, bool is_void);
    bool is_in_extent(const Vec3& p) const;
    void note_layered_wall(const FittedBody& layer);
    bool is_before_layer(const Vec3& p) const;
    bool is_spared(std::uint32_t particle) const;
    double filled_share(const Hollow& hollow) const;
    void hand_over_shares();
    /// Where walls of several draws are near one another, the shallower layer stays, then corners,
    /// edges, and the later draw: the others within least_pair_dp are cut.
    void cut_crowded();
    void note_missing();
    void cut_by(const FittedDraw& draw);
    /// What is left of a sheet beside the part that was taken out would flow into its place.
    void hold_near(const std::vector<Vec3>& places,
                   const std::function<bool(std::size_t c, std::size_t i)>& holds);
    void hold_beside(const std::vector<Vec3>& places, const std::vector<std::uint32_t>& bodies);
    void hold_beside_second_sheets();
    void anchor(std::size_t first_particle, const std::vector<Spans>& zone);

    RunField* field_;
    int threads_;
    std::vector<Hollow> hollows_;
    std::vector<std::vector<Anchor>> anchors_; ///< per slab, sorted by (y, z, particle)
    std::vector<char> is_cut_;                 ///< per particle of field.walls
    std::vector<WallOpening> openings_;
    std::vector<std::vector<const SourceRef*>> hollowed_by_; ///< per body
    std::vector<char> is_spared_;                            ///< per body
    std::vector<std::uint16_t> spared_mks_;    ///< absolute, of the bodies that the draw hollows
    std::unique_ptr<const InsideTest> extent_; ///< of the draw; null: unknown
    std::vector<char> is_flush_;               ///< per particle: the draw, a void, touches its body
    PointGrid flush_{1, 0};                    ///< these
    std::vector<char> is_of_wall_;             ///< per absolute mk
    std::vector<LayeredWall> layered_walls_;
};

} // namespace fppg
