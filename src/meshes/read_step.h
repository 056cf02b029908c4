#pragma once

#include "fppg/mesh.h"

#include <string>
#include <vector>

namespace fppg
{

/// A solid or shell of a STEP file, in its place in the assembly. Lengths in millimetres.
struct StepPart
{
    std::string name; ///< of the instance or of the part; may be empty
    TriangleSoup soup;
    double volume = 0;            ///< of the exact solid, mm3; 0: it is a shell
    double area = 0;              ///< of the exact faces, mm2
    std::size_t sharp_edges = 0;  ///< CAD edges that bend by more than a degree
    std::size_t smooth_edges = 0; ///< tangent ones
};

/// Whether a file is STEP by its ending: .step, .stp.
bool is_step_file(const std::string& path);

/// Reads the parts of a STEP file as facets.
///
/// deflection_mm  the farthest of a facet from its surface
/// angle_rad      between neighbouring facets of a smooth face, about
/// throws         IoError where the plugin that reads STEP is missing (names the places looked at),
///                or the file cannot be opened; GeometryError where it is no STEP file or has no
///                part
std::vector<StepPart> read_step(const std::string& path, double deflection_mm, double angle_rad);

} // namespace fppg
