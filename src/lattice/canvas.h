#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include "lattice/off_lattice_painter.h"
#include "lattice/wall_painter.h"

#include <atomic>
#include <cstdint>
#include <vector>

namespace fppg
{

/// What a draw paints with, handed to everything that paints for it.
struct Brush
{
    /// As the commands before the draw left it. The draw must outlive the brush.
    explicit Brush(const DrawOp& op);

    /// Under setmknextauto: the brush of the part that is this many mks further.
    Brush of_part(std::uint32_t steps) const;

    const SourceRef* source; ///< of the draw, for messages
    const DrawState* state;  ///< pattern, clips, constants, modes; its mk is not looked at
    MkValue mk;
    bool is_clipped = true;        ///< false: the clips of the state were applied already
    bool heeds_pattern = true;     ///< false: every node is painted, whatever the pattern
    bool empties_left_out = false; ///< nodes on '-' of the pattern become void without setmkback
    bool keeps_walls = false;      ///< walls stay where they are and take the mk
    bool spares_walls = false;     ///< it cuts some by its true shape: Canvas::cut_walls()
};

/// The nodes of a case while its commands run: each draw paints over what was there (rule O1).
class Canvas
{
public:
    /// def  must outlive the canvas
    Canvas(const CaseDef& def, int threads);

    const LatticeGrid& grid() const { return field_.grid; }
    const RunField& field() const { return field_; }
    int threads() const { return threads_; }

    /// throws  CaseError where the machine would start to swap or kill the process
    void paint(const Brush& brush, const SlabRegion& region);
    /// nodes  one entry per slab of the lattice; clips are not applied
    void paint(const Brush& brush, const std::vector<Spans>& nodes);

    /// Particles at their true places and their nodes, which patterns do not leave out.
    void paint_off_lattice(const Brush& brush, const std::vector<Vec3>& points);

    /// A body-fitted body on top of all that was drawn.
    void add_wall(FittedDraw&& draw) { walls_.add(std::move(draw)); }

    /// Before a shape is painted: what it cuts of body-fitted walls by its true shape. False: none.
    bool cut_walls(const SourceRef& draw, FittedStep& step)
    {
        return walls_.has_walls() && walls_.cut_by_shape(draw, step);
    }

    /// Whether no node carries an mk.
    bool is_empty() const;
    /// Forgets all that was drawn.
    void reset();
    /// The finished nodes and particles.
    RunField take();

private:
    /// Cuts what other zones of `<vres>` have out of the walls and their nodes.
    void cut_to_zone();
    void paint_slab(const Brush& brush, std::size_t x, const Spans& spans);
    void paint_slab(const Brush& brush, std::size_t x, const Spans& spans, const MkValue& mk);

    const CaseDef& def_;
    int threads_;
    RunField field_;
    WallPainter walls_;
    OffLatticePainter off_lattice_;
    std::atomic<std::uint64_t> runs_ = 0;
    std::uint64_t run_limit_;
};

} // namespace fppg
