#pragma once

#include "fppg/mesh.h"
#include "fppg/mesh_reading.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fppg
{

/// Lists of point numbers, one list a cell.
struct CellLists
{
    std::vector<std::uint64_t> ends; ///< cell i is indices[ends[i - 1]] to before indices[ends[i]]
    std::vector<std::uint64_t> indices; ///< into IndexedMesh::points; not checked yet

    std::size_t size() const { return ends.size(); }
    std::span<const std::uint64_t> operator[](std::size_t i) const
    {
        const std::size_t begin = i == 0 ? 0 : ends[i - 1];
        return {indices.data() + begin, indices.data() + ends[i]};
    }
    void add(std::span<const std::uint64_t> cell)
    {
        indices.insert(indices.end(), cell.begin(), cell.end());
        ends.push_back(indices.size());
    }
};

/// A mesh as PLY and VTK files hold it: points, and cells that name them.
struct IndexedMesh
{
    std::vector<Vec3> points;
    bool has_float32 = false; ///< the file holds its coordinates as float32
    CellLists vertices;       ///< every point named is a shape of its own
    CellLists lines;          ///< polylines
    CellLists polygons;
    CellLists strips; ///< triangle strips
    std::vector<std::string> warnings;
};

/// Turns cells into shapes as GenCase v5.4.354 draws them (found with `shapeout`, whose polygons
/// are those drawn):
/// - four corners are the triangles (0, 1, 2), (0, 2, 3), whatever their shape
/// - five and more corners are cut by ears of least perimeter, on the coordinates of the file,
///   before any transform. The same triangles as GenCase's for polygons in one plane; two polygons
///   of six and five corners that are not in one plane were cut otherwise there. Where corners
///   coincide an ear has three places that no other corner shares, and cutting ends where there is
///   none: all that GenCase draws but 3 of 4 triangles of 80 polygons in one line, which rounding
///   decides, 98 of 167 triangles of 80 others (19 are not its)
/// - a strip's triangle i is (i, i + 1, i + 2), every second one turned round; strips count as
///   triangles
/// - polygons of five and more corners are taken only where triangles, quads and other polygons are
///   all selected: GenCase draws nothing for `otherpolys` alone or with one of the others. A
///   warning says so where it leaves something out
/// Cells of too few points and those with a coordinate that is not finite are left out with a
/// warning.
///
/// throws  GeometryError if a cell names a point that is not there, or if the file has no shape at
///         all
MeshFile build_mesh(IndexedMesh mesh, const ShapeSelection& selection, const std::string& path,
                    int threads);

/// Cuts a polygon into triangles: among the ears, that is the corners where the polygon is convex
/// and whose triangle with their neighbours holds no other corner, the one with the least perimeter
/// goes first, the first of equal ones.
///
/// corners  three or more
/// returns  triangles (before, corner, after) of indices into `corners`
std::vector<std::array<std::size_t, 3>> cut_into_ears(std::span<const Vec3> corners);

} // namespace fppg
