#pragma once

#include "fppg/surface_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace fppg
{

/// The square of a vector's length.
inline double squared(const Vec3& v)
{
    return dot(v, v);
}

/// Several meshes with one numbering of vertices, sides and facets.
struct MeshSet
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 2>> sides;       ///< two vertices
    std::vector<std::array<std::uint32_t, 3>> facets;      ///< three vertices
    std::vector<std::array<std::uint32_t, 3>> facet_sides; ///< side s from corner s to s + 1
    std::vector<std::uint32_t> part;                       ///< per facet
    std::vector<std::uint32_t> first_facet;                ///< per mesh, and one past the end

    std::array<Vec3, 3> corners(std::uint32_t f) const
    {
        return {vertices[facets[f][0]], vertices[facets[f][1]], vertices[facets[f][2]]};
    }
};

/// Vertices of different meshes within `merge_distance` become one.
MeshSet join_meshes(const std::vector<const SurfaceMesh*>& meshes, double merge_distance);

/// A place where two facets of different meshes meet.
struct Contact
{
    enum class Kind : std::uint8_t
    {
        Vertex,    ///< first: the vertex
        Sides,     ///< first and second: the two sides, the smaller first
        SideFacet, ///< first: the side, second: the facet that it passes through
    };
    Kind kind = Kind::Vertex;
    std::uint32_t first = no_index;
    std::uint32_t second = no_index;
    Vec3 position;
    std::array<std::uint32_t, 2> on_sides{no_index, no_index}; ///< inside them
    std::uint32_t in_facet = no_index;                         ///< inside it
};

/// Two facets of different meshes and where they meet.
struct FacetContacts
{
    std::uint32_t f = 0;
    std::uint32_t g = 0;
    bool is_coplanar = false;      ///< they share an area
    std::vector<Contact> contacts; ///< of a line in order along it
};

/// All pairs of facets of different meshes that meet, by f, then g.
std::vector<FacetContacts> find_contacts(const MeshSet& set, double merge_distance, int threads);

} // namespace fppg
