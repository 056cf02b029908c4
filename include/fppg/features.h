#pragma once

#include "fppg/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

struct FeatureOptions
{
    double angle_deg =
        30;        ///< edges whose facets' normals differ by more are features, degrees, [0, 180)
    double dp = 0; ///< particle distance, metres
    /// A vertex where a chain of feature edges turns by more than this is a corner, degrees.
    double corner_angle_deg = 45;
};

/// A chain of feature edges.
struct FeatureLine
{
    std::vector<std::uint32_t> vertices; ///< in order; a closed line does not repeat its first
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
/// mesh, whatever the threads.
Features find_features(const SurfaceMesh& mesh, const FeatureOptions& options);

/// A particle on a corner or on a feature line.
struct FeatureParticle
{
    Vec3 position;
    bool is_corner = false;
    std::uint32_t line = no_index;   ///< of an edge particle
    std::uint32_t vertex = no_index; ///< of a corner particle
    std::uint32_t edge = no_index;   ///< mesh edge that an edge particle lies on
};

/// Particles on all corners and evenly along all lines, at no more than dp and as near dp as a
/// line's length allows. Where corners lie closer than dp, or lines are shorter or run closer than
/// dp, they are thinned so that every point of a line longer than dp keeps a particle within 0.5 dp
/// and particles keep 0.3 dp between them where that is possible.
std::vector<FeatureParticle> place_feature_particles(const SurfaceMesh& mesh,
                                                     const Features& features,
                                                     const FeatureOptions& options);

} // namespace fppg
