#pragma once

#include "fppg/surface_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// Particles of walls are no nearer than this to one another, dp: where corners, edges and surfaces
/// want more, corners come first, then edges, then surfaces.
inline constexpr double least_pair_dp = 0.6;

struct FeatureOptions
{
    double angle_deg =
        30;        ///< edges whose facets' normals differ by more are features, degrees, [0, 180)
    double dp = 0; ///< particle distance, metres; used by place_feature_particles() only
    /// A vertex where a chain of feature edges turns by more than this is a corner, degrees.
    /// Chains that turn less at every vertex count as one line.
    double corner_angle_deg = 45;
    /// Edges of CAD models whose exact faces bend by more are features, degrees: where a designer
    /// joined faces smoothly they are tangent.
    double cad_angle_deg = 1;
};

/// A chain of feature edges.
struct FeatureLine
{
    /// In order. A closed line does not repeat its first; a line that leaves and returns to the
    /// same singular vertex names it at both ends and is not closed.
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t>
        edges; ///< edge i from vertices[i] to vertices[i + 1], or to the first
    bool is_closed = false;
    double length = 0; ///< metres
};

/// Sharp and open edges of a mesh, in the sense of the FPPG paper, "Feature definition".
struct Features
{
    std::vector<std::uint32_t> edges;    ///< indices into SurfaceMesh::edges, ascending
    std::vector<char> is_feature_edge;   ///< per edge
    std::vector<std::uint32_t> singular; ///< vertices where one or more than two feature edges end,
                                         ///< or a chain turns sharply; ascending
    std::vector<FeatureLine> lines;      ///< between singular vertices, then closed loops
};

/// Feature edges by dihedral angle, open and non-manifold edges; singular vertices; lines by a
/// depth-first walk from the singular vertices, then the closed loops. Same result for the same
/// mesh, whatever the threads. Both angles are compared with 0.01 degrees to spare, so that edges
/// that a designer made alike (a rim of twelve sides at 30 degrees) are judged alike.
///
/// always  edges that are features whatever their angle, such as the seams of a BooleanMesh
/// bends   per edge the angle between the exact faces on both sides, radians, which counts in the
///         place of the dihedral angle; below 0: not known. Empty: of no edge
/// throws  GeometryError for an angle out of range
/// cost    O(edges)
/// source  FPPG paper, "Feature extraction and feature line particles"
Features find_features(const SurfaceMesh& mesh, const FeatureOptions& options,
                       const std::vector<std::uint32_t>& always = {},
                       std::span<const float> bends = {});

/// A particle on a corner or on a feature line.
struct FeatureParticle
{
    Vec3 position;
    bool is_corner = false;
    std::uint32_t line = no_index;   ///< of an edge particle
    std::uint32_t vertex = no_index; ///< of a corner particle
    std::uint32_t edge = no_index;   ///< mesh edge that an edge particle lies on
};

/// Corners, and places along lines, that have no particle because another one is too near.
struct FeaturesLeftOut
{
    std::size_t corners = 0;
    std::size_t edges = 0;
};

/// Particles on the corners and evenly along the lines, at no more than dp and as near dp as a
/// line's length allows; a line of 1 to 1.2 dp has none between its ends.
///
/// Where corners lie closer than dp, or lines are shorter or run closer than dp, they are thinned:
/// - corners with more lines first, then by vertex: one is kept if no kept one is nearer than
///   0.6 dp (least_pair_dp), so every corner that is 0.6 dp from all others has its particle;
/// - longer lines first, then by index: a line of length L is cut into ceil(L / dp) equal parts; a
///   particle nearer than 0.6 dp to an earlier one is left out;
/// - then every line is walked, and each stretch that is farther than 0.6 dp from all particles is
///   filled evenly.
/// So every point of every line has a particle within 0.6 dp (but for rounding), within 0.5 dp
/// where corners and lines keep dp from one another, and no two particles are nearer than 0.6 dp.
///
/// left_out  may be null; how many were left out, less those that the last step put elsewhere
/// returns   corners by vertex, then the particles of each line in order along it; those of a
///           thinned line only where others do not cover it. Positions lie on the edge to rounding
/// throws    GeometryError for a dp that is not positive, or so small that more than 2^32 - 2
///           particles are needed
/// cost      O(particles + edges of lines) time
std::vector<FeatureParticle> place_feature_particles(const SurfaceMesh& mesh,
                                                     const Features& features,
                                                     const FeatureOptions& options,
                                                     FeaturesLeftOut* left_out = nullptr);

} // namespace fppg
