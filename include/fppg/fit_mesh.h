#pragma once

#include "fppg/fit.h"
#include "fppg/mesh.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace fppg
{

struct FitMeshOptions
{
    double dp = 0;                 ///< in the unit of the mesh, above 0
    double feature_angle_deg = 30; ///< edges sharper than this get particles, [0, 180)
    bool is_relaxed = true;        ///< spread to even spacing
    int threads = 1;
    /// Told how many iterations of the relaxation are done; what it throws is passed on.
    std::function<void(int iteration)> on_progress{};
};

/// Particles on the true surface of a mesh: corners, edges, then the rest; one entry each in all
/// arrays.
struct FittedMesh
{
    std::vector<Vec3> positions;
    std::vector<FitKind> kinds;
    std::vector<std::array<float, 3>> normals; ///< of the facet that a particle lies on, outwards
    double area = 0;
    double volume = 0;                 ///< signed; 0 where the mesh is open
    std::vector<std::string> warnings; ///< of the mesh, whole sentences
};

/// Puts particles on a mesh, as body-fitted walls of a case do, for those who have no case: the
/// mesh is repaired, its features are found, and its particles are fitted and relaxed.
///
/// soup    any unit; at least one facet
/// throws  GeometryError as repair_mesh(), and for a dp or an angle out of range; what on_progress
///         throws
/// cost    that of repair_mesh(), fit_surface() and relax_surface()
FittedMesh fit_mesh(const TriangleSoup& soup, const FitMeshOptions& options);

} // namespace fppg
