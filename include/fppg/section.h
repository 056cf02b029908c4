#pragma once

#include "fppg/fit.h"
#include "fppg/surface_mesh.h"
#include "fppg/vec.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

struct SectionOptions
{
    double y = 0;                  ///< of the plane, metres
    double dp = 0;                 ///< metres, above 0
    double feature_angle_deg = 30; ///< turns by more are corners, degrees, [0, 180)
};

/// Particles on the lines in which a surface meets a plane y = constant, one entry each in all
/// arrays; corners first, then the others, both chain by chain.
struct SectionParticles
{
    std::vector<Vec3> positions;       ///< y is exactly that of the plane
    std::vector<FitKind> kinds;        ///< Corner or Surface
    std::vector<Vec3> normals;         ///< unit, in the plane, to the side where facets look
    std::vector<std::uint32_t> facets; ///< a facet of the mesh that the particle lies on

    double area = 0;   ///< within the closed chains, metres squared; holes count negative
    double length = 0; ///< of all chains, metres
    std::size_t closed_chains = 0;
    std::size_t open_chains = 0;
};

/// The section of a surface with a plane, as particles: the wall of a 2D case.
///
/// Facets are cut exactly: a corner on the plane counts as above it, so that the pieces of facets
/// join without gaps; in a shell that touches the plane from above only, such corners count as
/// below, so that it is cut along the touch. A shell that lies in the plane as a whole has no
/// section.
///
/// A corner is where the chain, and the surface too, turns by more than the feature angle (with
/// 0.01 degrees to spare), and every end of an open chain; a finely cut circle has none. A corner
/// that is nearer than 0.6 dp (least_pair_dp) along its chain to the one before is left out.
/// Between corners, and around chains without any, particles stand evenly, at no more than dp and
/// as near dp as the length allows, but none between corners 1 to 1.2 dp apart: every point of the
/// section has one within 0.6 dp along it.
///
/// mesh     as repair_mesh() made it
/// returns  chains in the order of their first facets, those shorter than 1e-6 dp left out;
///          none where the plane misses the mesh
/// throws   GeometryError for a dp that is not positive or so small that more than 2^32 - 2
///          particles are needed, and for an angle out of range
/// cost     O(facets + particles log particles)
SectionParticles section_particles(const SurfaceMesh& mesh, const SectionOptions& options);

} // namespace fppg
