#pragma once

#include "fppg/vec.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fppg
{

/// The exact faces behind the facets of a CAD file (meshes/cad_facets.h).
struct CadFacets;

/// Triangles as a file gives them: every facet with its own three corners, nothing welded.
/// Facet i has the vertices 3 i, 3 i + 1, 3 i + 2, counter-clockwise seen from outside.
struct TriangleSoup
{
    std::vector<Vec3> vertices; ///< size 3 * facets; float32 of the file promoted to double

    std::size_t size() const { return vertices.size() / 3; }
};

/// A polygon of five or more corners of a mesh file, which is drawn as the triangles of its ears.
struct WidePolygon
{
    std::uint32_t first = 0;   ///< its first facet; it has two less than corners, in a row
    std::vector<Vec3> corners; ///< five or more
};

/// A mesh file read, with what a reader noticed on the way.
struct MeshFile
{
    TriangleSoup soup; ///< every surface; polygons and strips are cut into triangles
    std::vector<std::string> warnings; ///< whole sentences; the caller adds the file name

    /// Facets that are the first half (0, 1, 2) of a quad whose second half (0, 2, 3) is the facet
    /// after it; ascending.
    std::vector<std::uint32_t> quads;
    std::vector<WidePolygon> wide_polygons; ///< by ascending first facet
    std::vector<Vec3> points;               ///< single points, in the order of the file
    std::vector<std::vector<Vec3>> lines;   ///< polylines of two or more points

    /// Of STEP files, whose facets only stand for it; else null. Its facets are those of the soup.
    std::shared_ptr<const CadFacets> cad;
};

} // namespace fppg
