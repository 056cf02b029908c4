#pragma once

#include "fppg/features.h"
#include "fppg/fit.h"
#include "fppg/surface_mesh.h"
#include "fppg/vec.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fppg
{

/// The exact surface behind the triangles of a round body, on which its particles are put
/// (meshes/round_surface.h).
struct RoundSurface;
/// A CAD model in its place in the case, and the exact surface behind a mesh that was made from
/// such (meshes/cad_surface.h).
struct CadSource;
class CadSurface;
/// How deep points are behind a surface (offset/wall_depth.h).
class WallDepth;

/// A shape of the case as triangles, in the coordinates of the case.
struct ShapeMesh
{
    TriangleSoup soup;     ///< counter-clockwise from outside; of a surface, as drawn
    bool is_solid = false; ///< the draw fills the inside, not only the surface
    std::shared_ptr<const RoundSurface> round{}; ///< null: the triangles are the shape
    std::shared_ptr<const CadSource> cad{};      ///< of CAD files, else null
};

/// What fitting and relaxing a body came to, for all of its shape: what the domain and later draws
/// cut off counts as if it were there. SI units; in 2D areas are lengths times dp.
struct FitMeasures
{
    /// Of its surface, and of a strip of half a dp beyond open rims, where particles stand on the
    /// rim.
    double area = 0;
    double second_sheet = 0; ///< area that is not in `area`: the side of a plate without particles
    double wall_particles = 0;
    double layer_particles = 0; ///< those of them that stand in layers behind the surface
    double volume = 0;          ///< of the shape; 0: it is open
    double sheet_volume = 0;    ///< of facets that bound no volume, as if dp thick
    double node_volume = 0;     ///< that the nodes inside stand for
    double wall_volume = 0;     ///< that the wall's particles stand for, as far as they are inside
    /// With Placement::Inside: from the surface down to the depth that its layers stand for.
    double shell_volume = 0;
    /// How much of the volume has particles, 0 to 1: all of a solid, of a surface what fills give
    /// it; 1 too where its walls leave no room for nodes.
    double filled = 0;
    /// How many of its wall's particles stayed where later draws touch it without cutting into its
    /// volume, over those before.
    double kept = 1;
};

/// One drawn object whose particles stand on its true surface.
struct FittedBody
{
    int line = 0;         ///< of the draw, in the definition
    std::string name;     ///< command, and file for a mesh
    std::uint16_t mk = 0; ///< absolute, as drawn
    /// Of a combination of parts, per facet the mk of the part that it belongs to; else empty.
    std::vector<std::uint16_t> facet_mk;
    bool is_solid = false;
    /// Of a closed surface that its draw does not fill: it has its layers inside.
    bool has_layers_inside = false;
    std::string continued_along; ///< axes along which it goes on over the period, such as "x"
    std::shared_ptr<const RoundSurface> round; ///< null: the triangles are the shape
    std::shared_ptr<const CadSurface> cad;     ///< the same of CAD models
    SurfaceMesh mesh;
    MeshReport report;
    Features features;
    double clearance_inside = 0;  ///< metres; lattice nodes nearer than this are left out
    double clearance_outside = 0; ///< the same on the other side
    /// How much of dp^3 (2D: dp^2) a particle of its wall stands for: in a filled body so much that
    /// they and the nodes make up its volume, in a hollow one 1.
    double share = 1;
    double layer_share =
        1; ///< the same of a particle of its layers; on the surface it is half that
    FitMeasures measures;
    /// Particles that it lacks because others are nearer than least_pair_dp to their places: on
    /// corners, along edges, on surfaces.
    std::array<std::size_t, 3> left_out{};

    /// All its particles are in it and stand for dp^3 each (Placement::Inside).
    bool is_inside = false;
    double spacing_dp = 1; ///< of the particles on its surface or, of a layer, in it
    /// Of a plate, beam or shell with Placement::Inside: the sheets through its thickness, which is
    /// in metres; 0: it is thicker.
    int sheets = 0;
    double thickness = 0;

    /// Of a layer of a wall: the index of the body whose surface it lies behind; else no_index.
    std::uint32_t owner = no_index;
    int layer = 0;    ///< 0, 1, ... from the surface on
    double depth = 0; ///< metres behind the surface; its mesh is so deep but for its facets' chords
    /// Of a sheet that got layers by FitSettings::sheet_depths_dp, of the wet side of a plate, or a
    /// closed surface that is thickened: the step of the scene; else no_index.
    std::uint32_t layered_step = no_index;
    bool is_thickened = false; ///< a shell that was thinner than two layers of mDBC
    bool is_wet_side = false;  ///< the side of a plate that fluid is on, and no other
    /// The surface that the depth is measured from; null where the body is no layer.
    std::shared_ptr<const WallDepth> wall;
    bool is_layer() const { return owner != no_index; }
    /// Whether its inside, as far as its layers reach, is no place for fluid.
    bool has_no_fluid_inside() const { return is_solid || has_layers_inside; }

    /// Settles the shares by the measures.
    ///
    /// dp  metres
    void settle_share(double dp)
    {
        share = 1 / measures.kept;
        layer_share = share;
        if (measures.filled <= 0 || measures.wall_particles <= 0) return;
        const double of_wall =
            std::max(0.0, measures.volume + measures.sheet_volume - measures.node_volume);
        // Half of what a particle on the surface stands for is before that.
        const double on_surface = measures.layer_particles > 0 ? 0.5 : 1;
        const double whole = measures.layer_particles +
                             on_surface * (measures.wall_particles - measures.layer_particles);
        const double of_filled = of_wall / (whole * dp * dp * dp);
        layer_share = (1 + measures.filled * (of_filled - 1)) / measures.kept;
        share = (1 + measures.filled * (on_surface * of_filled - 1)) / measures.kept;
    }
};

/// Particles of the fitted walls, one entry each in all arrays, in the order of bodies and of
/// fit_surface() within a body.
struct WallParticles
{
    std::vector<Vec3> positions;
    std::vector<FitKind> kinds;
    std::vector<std::uint32_t> bodies; ///< index into FittedWalls::bodies
    std::vector<std::uint32_t> facets; ///< of that body's mesh
    std::vector<std::uint16_t> mk;     ///< absolute; a redraw may have changed it
    std::vector<char> held;            ///< 1: relaxation leaves it where it is

    std::size_t size() const { return positions.size(); }
    /// Particle i of another set, behind the others.
    void append(const WallParticles& from, std::size_t i)
    {
        positions.push_back(from.positions[i]);
        kinds.push_back(from.kinds[i]);
        bodies.push_back(from.bodies[i]);
        facets.push_back(from.facets[i]);
        mk.push_back(from.mk[i]);
        held.push_back(from.held[i]);
    }
    /// All of another set, behind the others.
    void append(const WallParticles& from)
    {
        positions.insert(positions.end(), from.positions.begin(), from.positions.end());
        kinds.insert(kinds.end(), from.kinds.begin(), from.kinds.end());
        bodies.insert(bodies.end(), from.bodies.begin(), from.bodies.end());
        facets.insert(facets.end(), from.facets.begin(), from.facets.end());
        mk.insert(mk.end(), from.mk.begin(), from.mk.end());
        held.insert(held.end(), from.held.begin(), from.held.end());
    }
    /// Takes particles out; the others keep their order.
    ///
    /// is_out  one entry per particle
    void erase(const std::vector<char>& is_out)
    {
        const auto compact = [&](auto& values)
        {
            std::size_t count = 0;
            for (std::size_t i = 0; i < values.size(); ++i)
                if (!is_out[i]) values[count++] = values[i];
            values.resize(count);
        };
        compact(positions);
        compact(kinds);
        compact(bodies);
        compact(facets);
        compact(mk);
        compact(held);
    }
};

/// Particles off the lattice that belong to no wall, one entry each in all arrays: those near walls
/// or of `setfrdrawmode`, which stand in for lattice nodes, and those of point files. The nodes
/// are covered (Run::is_covered), so that a water column still counts them (of point files those
/// of fluid); where they were taken out of the field altogether, the column ends below them.
struct VolumeParticles
{
    std::vector<Vec3> positions;
    std::vector<std::uint16_t> mk; ///< absolute, bound or fluid
    /// Metres to the nearest wall, negative in a solid; distance_of_nodes where it is not measured.
    std::vector<float> distances;

    std::size_t size() const { return positions.size(); }
};

/// A particle in the middle of a gap that is closed (relax/gap_rows.h); one of the volume too.
struct GapParticle
{
    Vec3 place;
    /// Where it ends the gap: a particle of the first layer beside it, and the way from there to
    /// the face beyond the gap's end, metres; else zero.
    Vec3 wall;
    Vec3 to_mouth;
};

/// All fitted walls of a case.
struct FittedWalls
{
    std::vector<FittedBody> bodies;
    WallParticles particles;
    VolumeParticles volume;
    /// Where particles of a body were cut, by a later draw, a clip or the domain, and their bodies:
    /// no particle may be put there again.
    std::vector<Vec3> cut;
    std::vector<std::uint32_t> cut_bodies;
    /// The same inside a later draw whose layers took the place: nothing is missing there.
    std::vector<Vec3> replaced;
    std::vector<std::uint32_t> replaced_bodies;
    /// Particles of the second sheets of plates, which were taken out: none may be put on their
    /// side of the plate again.
    WallParticles second_sheets;

    std::vector<GapParticle> gaps;

    /// Mks with particles of `setfrdrawmode`, which stand in for nodes; rising.
    std::vector<std::uint16_t> off_lattice_mks;

    /// Nodes of the fluid of point files are covered.
    bool has_point_water = false;

    /// The body to which a body or a layer belongs.
    const FittedBody& owner_of(std::size_t body) const
    {
        const FittedBody& b = bodies[body];
        return b.is_layer() ? bodies[b.owner] : b;
    }
    FittedBody& owner_of(std::size_t body)
    {
        FittedBody& b = bodies[body];
        return b.is_layer() ? bodies[b.owner] : b;
    }

    /// Whether nodes may be covered.
    bool has_zones() const
    {
        return !bodies.empty() || !off_lattice_mks.empty() || has_point_water;
    }
};

} // namespace fppg
