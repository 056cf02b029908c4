#pragma once

#include "fppg/scene.h"

#include <optional>
#include <string>

namespace fppg
{

/// What is said of a mesh file whose size does not go with that of the domain: 100 times as large,
/// or as small and below 4 dp, as a file in other units is. Nothing of all others.
///
/// bounds  of the mesh as it is drawn, metres
/// factor  how much larger or smaller it is
std::optional<std::string> wrong_units(const CaseDef& def, const std::string& file,
                                       const Box3& bounds, double factor = 100);

/// Refuses what would take long to lay, or end with another message, before anything is laid: a
/// body-fitted mesh file 100 times as large as the domain, a file of wrong size in a case with
/// `<fppg><fill>` (files in other units), and a body-fitted shape whose surface needs more
/// particles than the file format or the memory holds. Clipped draws pass. What is drawn on the
/// lattice only gets a warning, later.
///
/// throws  GeometryError with the place of the draw; as MeshLibrary::read()
void expect_metres(const Scene& scene, int threads);

/// What may be behind a draw that failed: "; " and the words of wrong_units() for the first mesh
/// file 10 times as large as the domain, or nothing.
std::string suspected_units(const Scene& scene, int threads);

} // namespace fppg
