#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// How much of a body is laid out.
enum class BodyExtent : std::uint8_t
{
    NearDomain, ///< what can come into the domain
    Whole,      ///< all of it, for its mass
};

/// How much of its area cut_to_domain() leaves of a body: 1 where it stays whole.
///
/// mesh      of the body
/// is_round  it is laid on an exact surface (FittedBody::round)
double share_laid(const SurfaceMesh& mesh, bool is_round, const FitSettings& settings,
                  const LatticeGrid& grid, int threads);

/// Cuts off what a body has far beyond the domain: its particles would be taken out again.
///
/// Only where more of its surface lies beyond the domain and a margin of 12 dp than within, and at
/// least 20,000 dp^2. A solid gets facets where it is cut, an open surface ends there. The measures
/// of the body are then those of what is left. In 2D the width of the body does not count as
/// beyond. A body of which nothing is within the margin is left out, however small it is. Bodies
/// with Placement::Inside stay whole. Round bodies are cut only where eight times as much lies
/// beyond as within, and at least 5,000,000 dp^2.
///
/// body     mesh and report are made, features are not yet; without a facet where nothing of it is
///          within the margin
/// returns  the edges along which it was cut, ascending; none where it is left whole
std::vector<std::uint32_t> cut_to_domain(FittedBody& body, const FitSettings& settings,
                                         const LatticeGrid& grid, int threads);

} // namespace fppg
