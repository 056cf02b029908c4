#pragma once

#include "fppg/lattice.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

struct ExclusionBandOptions
{
    /// Lattice nodes nearer to the surface than this are left out, in dp, 0.5 to 1.0. Empty: chosen
    /// for each side so that nodes and what is inside of the wall's particles make up its volume.
    std::optional<double> clearance_dp;
    std::uint64_t wall_particles = 0; ///< on this surface, one dp^2 each
    /// How much of what they stand for is inside, the mean, where every facet has the body on one
    /// side: less than one half where edges are convex (fit/inside_angles.h).
    double share_inside = 0.5;
    /// The nodes of `volume` will be drawn: they stop fills themselves, and may stay from 0.4 dp on
    /// where the volume asks for them.
    bool is_solid = false;
    /// No particle stands on the surface, but half a dp behind it: nodes from 0.1 dp before it on
    /// may stay.
    bool is_before_layers = false;
};

/// The lattice nodes around a fitted wall.
struct ExclusionBand
{
    SpanSet volume; ///< nodes inside the body, outside the zone
    SpanSet zone;   ///< nodes that carry no particle: too near to the surface, on either side
    /// The clearances that came out, in dp: every node of `volume` is at least that far, and so is
    /// every node outside body and zone.
    double clearance_inside_dp = 0;
    double clearance_outside_dp = 0;
    bool has_inside = false; ///< the mesh bounds a volume
    /// Of the body, metres cubed (2D: area of the section times dp); what several parts share
    /// counts once, holes are closed. 0 without an inside.
    double body_volume = 0;
    double area = 0;         ///< of all facets, metres squared (2D: length of the section times dp)
    double sheet_area = 0;   ///< of facets that bound no volume, likewise
    std::uint64_t nodes = 0; ///< that `volume` would have if the lattice held all of the body
    /// How much of the wall's particles lies in the body: the given share_inside where every facet
    /// has the body on one side, more where parts run through one another, less where sheets stand
    /// out of it.
    double wall_share_inside = 0.5;
    /// (nodes of `volume` + wall_particles * wall_share_inside) dp^3 / body_volume - 1, over all of
    /// the body, be it in the lattice or not; 0 without an inside
    double volume_error = 0;
    /// Nodes whose inside a winding number told because columns disagreed.
    std::uint64_t disputed_nodes = 0;
    std::uint64_t sheet_facets = 0;    ///< facets that bound no volume: sheets, fins, open shells
    std::vector<std::string> warnings; ///< whole sentences; of meshes without fault there are none
};

/// The nodes inside a mesh and those too near to its surface.
///
/// A zone holds every node within 0.5 dp of the surface, so that of two neighbouring nodes on
/// different sides at least one is in it and no 6-connected fill passes through. Beyond that, nodes
/// nearer than the clearance are left out. With an automatic clearance, the nodes of each side are
/// left out in the order of their distance (ties spread evenly over space) up to 1.0 dp, until
///   inside:  nodes + wall_particles * share = volume / dp^3, and
///   outside: nodes inside or in the zone = volume / dp^3 + wall_particles * (1 - share)
/// or the limits 0.5 and 1.0 dp are reached. (No node is ever kept nearer than 0.5 dp: a plane wall
/// whose nearest nodes inside stand at t < 0.5 dp lacks t dp of thickness, so the volume error of
/// a body whose walls all lie so is down to -t dp area / volume.) The share is that given, but for
/// parts that run through one another and sheets that stand out (wall_share_inside). A mesh without
/// an inside has the clearance 0.5 on both sides.
///
/// Distances are exact to 1e-9 dp. A node at 0.5 dp belongs to the zone, unless it is inside and
/// the volume asks for it: then its neighbour across the surface, which is no farther from it, is
/// in the zone still, so that no two nodes that stay are neighbours across a surface.
///
/// Facets bound a volume where their shell is closed up to holes of less than a tenth of its area,
/// or the shells that are not are closed by one another. The inside of a body without fault is that
/// of inside_spans(), of others that of inside_by_vote().
///
/// In a 2D lattice, all of this is about the section of the mesh with the plane y = grid.origin.y:
/// distances are those in the plane, a wall particle stands for dp of its length.
///
/// mesh     as repair_mesh() made it, with its report
/// grid     a mesh may reach out of it: the clearances are those of the whole body, the nodes those
///          in the lattice
/// threads  number of threads; the result does not depend on it
/// throws   GeometryError when the zone needs more memory than there is, the mesh spans more than
///          2^31 dp, or a given clearance is not between 0.5 and 1
/// cost     about 0.3 microseconds per node within 1 dp and 0.1 per facet smaller than dp; 30 bytes
///          per node at its peak
ExclusionBand exclusion_band(const SurfaceMesh& mesh, const MeshReport& report,
                             const LatticeGrid& grid, const ExclusionBandOptions& options,
                             int threads);

} // namespace fppg
