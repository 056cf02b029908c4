#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include "nodes/spans.h"

#include <compare>
#include <vector>

namespace fppg
{

/// The nodes up to 0.75 dp around a cylinder and in it, one entry per slab: GenCase v5.4.354
/// empties them before it draws one with its inside off the lattice, so that earlier particles at
/// them go, also behind its faces in solid mode (points on all 4900 nodes around five cylinders:
/// those that go are these nodes, but for half of those exactly at 0.75 dp). It does so for no
/// other shape.
std::vector<Spans> emptied_by_cylinder(const CylinderOp& op, const std::vector<ClipPlane>& clips,
                                       const LatticeGrid& grid, int threads);

/// The particles that `setfrdrawmode auto="true"` puts off the lattice, while a field is drawn.
///
/// Rules found by experiment with GenCase v5.4.354, lattice -0.5 + 0.1 i:
/// - a particle claims its nearest node and all nodes nearer than 0.75 dp: they take its mk, so
///   fills and redraws see them, and give no particles of their own. A fill of void nodes around
///   a point at (0.13, 0.1, 0.1) leaves out x = 0.1 and 0.2, around one at (0.15, 0.15, 0.15) only
///   (0.2, 0.2, 0.2)
/// - nothing is removed while drawing. At the end, from the highest mk down, a particle stays when
///   each of its nodes carries its mk or has been emptied, then the nodes of all particles of this
///   mk that carry it are emptied (400 cases of 2 to 25 points of three mk, none different). So of
///   two that share a node the earlier one goes when its mk is the higher one, and both stay when
///   it is the lower one (mk 11 then 10, fluid 1 then 0, bound then fluid; all the other way
///   round). A node painted over with another mk and back again, or redrawn 0 -> 1 -> 0, leaves it;
///   a redraw with another mk turns its nodes into lattice particles. A nearest node that is 0.75
///   dp away or farther may also carry another mk of which particles are drawn off the lattice,
///   but no lower one of which one has this node (40 orders of two particles and a node; 142 of 150
///   cases of six particles, five mk and six nodes painted over)
/// - an emptied node counts for hswl as that of the lowest mk of the particles around it that stay
/// - of those that stay, one is removed when a later one is nearer than 0.75 dp. A removed one
///   still removes others: of seven points 0.06 apart at dp 0.1 the last stays
/// - void points only empty their nodes
/// - patterns leave out neither particles nor their nodes
/// - particles count from the first node of the lattice to 0.75 dp beyond the last (1.475 yes,
///   1.47500000001 no with the last at 1.4), where one of their nodes lies in the lattice: none of
///   two coordinates of 0.51 dp has one from 1.45 on (800 random points at edges, none different);
///   in 2D within 0.1 dp of the plane, into which they are moved
class OffLatticePainter
{
public:
    OffLatticePainter(RunField& field, int threads) : field_(&field), threads_(threads) {}

    /// Keeps the points that lie in the domain and within the clips.
    ///
    /// mk       absolute; 0: void
    /// returns  their nodes, one entry per slab, to be painted with mk
    std::vector<Spans> draw(const std::vector<Vec3>& points, const std::vector<ClipPlane>& clips,
                            std::uint16_t mk);

    /// Forgets everything.
    void reset();

    /// Puts the particles that stay into the field; their nodes are covered.
    void finish();

private:
    struct CoveredNode
    {
        std::uint32_t x = 0;
        std::uint32_t y = 0;
        std::uint32_t z = 0;
        std::uint16_t mk = 0;

        auto operator<=>(const CoveredNode&) const = default;
    };

    void sort_claims();
    /// Whether a particle of this mk has this node.
    bool is_covered_by_another(const CoveredNode& claim) const;
    /// Index of the first claim of a node that has one, which stands for the node.
    std::size_t claim_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
    /// One entry per particle; is_emptied gets one per claim, for the nodes that are not the
    /// lattice's.
    std::vector<char> staying_particles(std::vector<char>& is_emptied) const;

    RunField* field_;
    int threads_;
    std::vector<Vec3> positions_;
    std::vector<std::uint16_t> mk_;
    std::vector<CoveredNode> covered_; ///< sorted by finish()
};

} // namespace fppg
