#pragma once

#include "fppg/mesh.h"

#include "core/lanes.h"
#include "core/raw_array.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Room for what float rounds away of coordinates between -1 and 1 and of sums of them.
inline constexpr double float_room = 1.0 / (1 << 20);
inline constexpr std::uint32_t is_leaf = 1u << 31;

/// Eight boxes in a unit cube and where they lead.
struct alignas(32) TreeNode
{
    std::array<Lanes, 3> low, high;
    std::array<std::uint32_t, lane_count> child{}; ///< a node, or a leaf with is_leaf
    std::uint32_t count = 0;
};

/// A facet lies between planes: on that of its face, and behind those that stand on its sides and
/// look outwards. Facets without an area are taken for a line: behind planes at both ends.
struct LeafPlanes
{
    Lanes x, y, z, at; ///< unit normal and dot(normal, point of the plane)
};
inline constexpr std::size_t planes_of_facet = 4; ///< the first is that of the face

struct alignas(32) TreeLeaf
{
    std::array<LeafPlanes, planes_of_facet> planes;
    std::array<std::uint32_t, lane_count> facet{};
    std::uint32_t count = 0;
};

/// The tree that NearTree searches.
struct FacetTree
{
    std::vector<TreeNode> nodes; ///< the first is the root
    RawArray<TreeLeaf> leaves;
};

/// Parameters as of NearTree.
FacetTree make_facet_tree(const TriangleSoup& soup, const Vec3& centre, double scale, int threads);

} // namespace fppg
