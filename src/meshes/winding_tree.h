#pragma once

#include <cstdint>
#include <vector>

#include "fppg/mesh.h"

namespace fppg
{

/// The generalised winding number of a mesh: the solid angle of all facets over 4 pi. It is 1
/// inside a closed body, 0 outside, and goes over smoothly where the mesh has holes.
///
/// Facets far from the point (three radii of their group) count as one dipole.
/// Source: Barill et al., Fast Winding Numbers for Soups and Clouds, 2018, first order.
class WindingTree
{
public:
    /// soup  may be empty; it is not copied and must outlive the tree
    explicit WindingTree(const TriangleSoup& soup);
    double winding_number(const Vec3& point) const;

private:
    struct Group
    {
        Vec3 centre;      ///< of area
        Vec3 area_vector; ///< metres squared
        double radius = 0;
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
        std::uint32_t second = 0; ///< second child; the first one follows; 0: a leaf
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end, const std::vector<Vec3>& middles);

    const TriangleSoup& soup_;
    std::vector<std::uint32_t> order_;
    std::vector<Group> groups_;
};

} // namespace fppg
