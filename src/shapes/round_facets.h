#pragma once

#include "fppg/mesh.h"
#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// How far a facet of a round shape may lie inside the true surface, in dp.
inline constexpr double chord_error_dp = 0.005;

/// Triangles whose corners are shared by index.
struct SharedFacets
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> facets;

    std::uint32_t add(const Vec3& p)
    {
        vertices.push_back(p);
        return static_cast<std::uint32_t>(vertices.size() - 1);
    }
    TriangleSoup soup() const;
};

/// throws  GeometryError that names the shape for a size that is not above 0
void check_size(const char* shape, double size);
/// throws  GeometryError where a shape would need more than 20 million facets
void check_facets(double count);

/// Two directions that make a right-handed system with the unit vector u: v, then w = u x v.
std::array<Vec3, 2> across(const Vec3& u);

/// Into how many parts a full turn at this radius is cut so that no chord lies deeper than
/// chord_error_dp; 24 and more, so that no edge between them is sharp.
///
/// radius, dp  metres
double sides_for_chord(double radius, double dp);

/// Into how many parts the edges of an icosahedron must be cut so that no facet of the sphere
/// around it lies deeper than chord_error_dp. The deepest facets lie in the middle of the faces,
/// where a triangle of circumradius edge / (sqrt(3) parts) stands at the face's distance from the
/// centre.
double parts_for_chord(double radius_dp);

/// Directions to the corners of a geodesic sphere; the icosahedron's edges are cut into `parts`.
SharedFacets geodesic_sphere(std::uint32_t parts);

} // namespace fppg
