#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "fppg/mesh.h"

namespace fppg
{

/// Where two surfaces are nearest to each other.
struct SurfaceGap
{
    double distance = std::numeric_limits<double>::infinity(); ///< metres; 0 where they cross
    Vec3 on_first;                                             ///< in the places of the first one
    Vec3 on_second;                                            ///< likewise
    bool crosses = false; ///< a side of a facet of one passes through a facet of the other
};

/// The facets of a surface in a tree of boxes, for the distance to another surface that moves.
class GapTree
{
public:
    /// soup  at least one facet, all coordinates finite
    explicit GapTree(TriangleSoup soup);

    const TriangleSoup& soup() const { return soup_; }
    const Box3& bounds() const { return nodes_.front().box; }

    /// The least distance between this surface and another, exact to rounding.
    ///
    /// place   of the other one: a rotation and a move
    /// within  metres; where nothing is nearer, the distance is infinite
    /// cost    that of a few hundred pairs of facets, more where many are equally near
    SurfaceGap gap_to(const GapTree& other, const Transform& place,
                      double within = std::numeric_limits<double>::infinity()) const;

private:
    struct Node
    {
        Box3 box;
        std::uint32_t begin = 0; ///< of a leaf: into order_
        std::uint32_t end = 0;
        std::uint32_t left = 0; ///< 0: a leaf; the right one follows the left one's subtree
        std::uint32_t right = 0;
    };
    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    friend class GapSearch;

    TriangleSoup soup_;
    std::vector<Vec3> middles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace fppg
