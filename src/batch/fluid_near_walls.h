#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/mesh.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// Places of up to about 5,000 nodes of fluid, evenly through the lattice.
///
/// first_bound  mks below it are fluid
std::vector<Vec3> sample_fluid(const RunField& field, std::uint16_t first_bound);

/// How far places are from a surface, metres; beyond `most` it may be more than that.
std::vector<double> distances_to(TriangleSoup surface, const std::vector<Vec3>& places, double most,
                                 int threads);

/// The share of distances up to one, 0 to 1.
double share_within(const std::vector<double>& distances, double most);

/// The facets that do not face along an axis, where rows of the lattice do not fit.
TriangleSoup slanted_facets(const TriangleSoup& surface);

/// What walls do to fluid.
struct FluidHold
{
    bool holds = true;  ///< at rest; where they do not, that is found out, and it stays
    double slanted = 0; ///< share of the fluid near walls that is near slanted_facets(), 0 to 1
};

/// What balancing fluid costs (balance.h): particles times iterations times the root of neighbours,
/// as these are summed up by eights (2D: 0.33 us, 3D at coefh 1 and 1.2: 0.6 and 0.72). Beside
/// walls along the axes it has settled after 30 iterations (dam break, tank); beside curved ones it
/// takes usual_iterations().
///
/// particles  that move
double steps_to_balance(const CaseDef& def, double particles, const FluidHold& walls);

} // namespace fppg
