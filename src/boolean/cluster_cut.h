#pragma once

#include "boolean/arrangement.h"
#include "boolean/contacts.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace fppg
{

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Facets that are cut up in one plane: one facet, or all that overlap.
struct Cluster
{
    std::vector<std::uint32_t> facets;
    std::vector<std::uint32_t> lines;  ///< pieces that are no side of a member
    std::vector<std::uint32_t> points; ///< vertices inside members
    int axis_u = 0;                    ///< coordinates that stand for the plane
    int axis_v = 1;
};

struct CutUp
{
    std::vector<ArrangedFacet> facets;
    std::vector<Pair> joined; ///< vertices that fall into one place of the plane
    std::uint64_t lost = 0;   ///< lines and outlines that the pieces do not keep
};

/// Cuts the facets of a cluster into triangles along lines.
///
/// outlines  per facet its sides in pieces, from vertex to vertex, in order
/// lines     all pieces of lines, those of the outlines too, the smaller vertex first
CutUp cut_up_cluster(const MeshSet& set, const Cluster& cluster,
                     const std::vector<std::vector<Pair>>& outlines, std::vector<Pair> lines);

} // namespace fppg
