#pragma once

#include "fppg/draw_ops.h"
#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include "lattice/wall_openings.h"
#include "nodes/spans.h"

#include <string>
#include <vector>

namespace fppg
{

/// Nodes that one part of a combination has.
struct NodeShare
{
    std::uint16_t mk = 0;     ///< absolute
    std::vector<Spans> nodes; ///< one entry per slab of the lattice
};

/// What one fitted draw adds to the field.
struct FittedDraw
{
    FittedBody body;
    std::vector<FittedBody> layers; ///< behind its surface; `owner` is 0
    WallParticles
        particles; ///< of this body and its layers; `bodies` 0 is the body, 1 the first layer
    std::vector<Vec3> cut; ///< places of particles that were left out
    std::vector<std::uint32_t> cut_bodies;
    WallParticles second_sheet; ///< taken out of a thin plate, or where layers of two sides meet
    std::vector<Spans> volume;  ///< one entry per slab of the lattice
    std::vector<Spans> hollow;  ///< likewise; nodes inside that the draw leaves empty, or nothing
    std::vector<Spans> zone;    ///< likewise; every particle has a node of it at its cell's corners
    /// Nodes of `volume` and `zone` with another mk than the body's.
    std::vector<NodeShare> shares;
    /// Voids that its surface is cut by already: they leave its particles and its zone.
    std::vector<const SourceRef*> hollowed_by;
    std::vector<std::string> warnings;
};

/// What body-fitting made of one step of a scene.
struct FittedStep
{
    bool is_fitted = false;        ///< false: the shape stays on the lattice
    std::vector<FittedDraw> draws; ///< in order; none for a draw that paints nothing
    /// Of a void or the fluid of an inlet: the holes that it makes in sheets.
    std::vector<WallOpening> openings;
    /// The true shape of fluid or a void, closed; empty: unknown. Outside of it walls and their
    /// nodes stay, though the nodes of the lattice reach farther.
    TriangleSoup extent;
    bool is_void = false; ///< the extent's: solids that it touches from outside keep their surface
    /// Whole sentences that name the draw.
    std::vector<std::string> warnings;
};

} // namespace fppg
