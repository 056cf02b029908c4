#pragma once

#include "fppg/lattice.h"

#include "nodes/snap.h"
#include "nodes/spans.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace fppg
{

struct CavityOptions
{
    Node seed;
    Vec3 up{0, 0, 1}; ///< of length 1; in 2D with a part in the plane
    /// Openings up to this many nodes wide are closed; 0: none. A cube with one node more per side
    /// has to pass to get from one side to the other.
    int gap_nodes = 1;
};

/// A narrow place between the cavity and other empty nodes that a cube one node wider than
/// CavityOptions::gap_nodes cannot pass: where the nodes of the cavity touch those beyond it, about
/// the middle of the way. Places nearer than three nodes to one another are one.
struct CavityGap
{
    std::uint64_t nodes = 0; ///< of the cavity there: the cross-section of the gap
    Vec3 center;             ///< mean of these nodes, metres
    bool leads_outside = false;
};

/// The lowest way out of a cavity that is not closed.
struct CavityOpening
{
    double height = 0; ///< along `up`, in dp from lattice node (0, 0, 0)
    Vec3 place;        ///< where the way is highest, metres
};

/// The empty nodes around a seed that drawn nodes enclose.
struct Cavity
{
    std::vector<Spans> nodes; ///< one entry per slab of the lattice
    std::uint64_t node_count = 0;
    std::vector<CavityGap> gaps; ///< in the order of x, y, z of their first nodes
    /// Empty: closed. Else the nodes are those of the basin below the seed (where a drop from it
    /// comes to rest) that fills up before anything runs out: below the height of the opening;
    /// none where the drop runs out at once.
    std::optional<CavityOpening> opening;
};

/// Finds the cavity of a seed, bounded by all nodes that have a run (those in the zone of a fitted
/// wall too).
///
/// The cavity is what cubes of gap_nodes + 1 nodes a side, moved node by node from the seed,
/// reach and cover, and narrower places that lead nowhere else. Of narrow places that lead on to
/// other empty space, the gaps, it has the nodes that are fewer steps away from it than from there.
/// It is open when the cubes get out of the box around all drawn nodes.
///
/// threads  number of threads; the result does not depend on it
/// throws   GeometryError, without the place of the draw: the seed is outside everything drawn, on
///          a node that is not empty, or where the cube does not fit
/// cost     O(s log s) time and O(s) memory for s runs and columns of the box around all drawn
///          nodes, the time times gap_nodes + 1
Cavity find_cavity(const RunField& field, const CavityOptions& options, int threads);

} // namespace fppg
