#pragma once

#include "fppg/scene.h"

#include "shapes/moments.h"

#include <optional>
#include <string>

namespace fppg
{

/// The body that a boundary mk draws, when a single closed shape draws it: a polyhedron or a mesh
/// file whose edges all meet (by the sum over its facets), a sphere, cylinder or ellipsoid (by
/// formula). Fills with the mk count as the inside of the shape. What later draws cut from it is
/// not taken off.
///
/// mk            absolute
/// turns_shells  shells of a mesh file that look inwards are turned; else as the file has them
/// why_not       filled with a sentence when nothing is returned
/// throws        IoError, GeometryError for mesh files
std::optional<ExactBody> exact_body(const Scene& scene, std::uint16_t mk, bool turns_shells,
                                    std::string& why_not);

} // namespace fppg
