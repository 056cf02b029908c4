#pragma once

#include "fppg/scene.h"

namespace fppg
{

/// Makes Boolean differences of body-fitted solids that voids or fluids are drawn into later: the
/// cavity then has a fitted surface, with layers and normals, as it has by
/// `<boolean op="difference">`. Voids and fluids stay steps of their own, for all else that they
/// draw over. Solids of one mk with Placement::Inside and no `across` whose boxes overlap or touch
/// become one by a union, in the place of the last of them; each void takes from those before it.
/// Sheets lose what fluid is drawn through, as deep as the farthest shell of their `<layers vdp>`
/// and by more than half a dp, so that no wall counts there; a void only opens them
/// (lattice/wall_openings.h).
///
/// Left as they are: solids drawn part by part or as a depth of a file, surfaces with open edges,
/// draws with a clip or a pattern, fluid of inlets, and fluid that reaches less than half a dp into
/// a solid, as on the lattice; sheets of `<layers>`. What is wrong with a file is left for the
/// drawing to say.
void hollow_solids(Scene& scene);

} // namespace fppg
