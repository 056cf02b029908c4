#pragma once

#include "fppg/lattice.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <optional>

namespace fppg
{

struct WallZoneOptions
{
    /// Lattice nodes nearer to the surface than this are left out, in dp, 0.5 to 1.0. Empty: chosen
    /// for each side so that nodes and half of the wall's particles make up its volume.
    std::optional<double> clearance_dp;
    std::uint64_t wall_particles = 0; ///< on this surface, one dp^2 each
};

/// The lattice nodes around a fitted wall.
struct WallZone
{
    SpanSet volume; ///< nodes inside the body, outside the zone
    SpanSet zone;   ///< nodes that carry no particle: too near to the surface, on either side
    /// The clearances that came out, in dp: every node of `volume` is at least that far, and so is
    /// every node outside body and zone.
    double clearance_inside_dp = 0;
    double clearance_outside_dp = 0;
    bool has_inside = false; ///< the mesh bounds a volume
    /// (nodes of `volume` + wall_particles / 2) dp^3 / volume - 1; 0 without an inside
    double volume_error = 0;
    /// Facets whose inside was told by a vote or a winding number because columns disagreed.
    std::uint64_t disputed_nodes = 0;
};

/// The nodes inside a mesh and those too near to its surface.
///
/// A zone holds every node within 0.5 dp of the surface, so that of two neighbouring nodes on
/// different sides at least one is in it and no 6-connected fill passes through. Beyond that, nodes
/// nearer than the clearance are left out. With an automatic clearance, the nodes of each side are
/// left out in the order of their distance (ties spread evenly over space) up to 1.0 dp, until
///   inside:  nodes + wall_particles / 2 = volume / dp^3, and
///   outside: nodes inside or in the zone = volume / dp^3 + wall_particles / 2
/// or the limits 0.5 and 1.0 dp are reached. A mesh without an inside has the clearance 0.5 on both
/// sides.
///
/// mesh     as take_in_mesh() made it, with its report
/// threads  number of threads; the result does not depend on it
/// throws   GeometryError when the zone needs more memory than there is
WallZone wall_zone(const SurfaceMesh& mesh, const MeshReport& report, const LatticeGrid& grid,
                   const WallZoneOptions& options, int threads);

} // namespace fppg
