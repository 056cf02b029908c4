#pragma once

#include "fppg/rgb.h"
#include "fppg/scene.h"

#include <cstdint>
#include <map>

namespace fppg
{

/// Colours that CAD models give, by absolute mk of boundaries: of the parts drawn with a mk that of
/// the largest area. Other mks are not in it.
std::map<std::uint16_t, Rgb> colours_of_parts(const Scene& scene);

} // namespace fppg
