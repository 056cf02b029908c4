#pragma once

#include "fppg/mesh.h"
#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// No facet, no vertex, no edge.
inline constexpr std::uint32_t no_index = 0xFFFFFFFF;

/// A mesh with welded vertices, with connectivity for traversal.
///
/// Facet f has the corners facets[f], counter-clockwise from outside; its side s runs from corner s
/// to corner (s + 1) % 3, belongs to edge facet_edges[f][s] and leads to facet neighbours[f][s]
/// (no_index where the edge is open or has more than two facets).
struct SurfaceMesh
{
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> facets;
    std::vector<std::array<std::uint32_t, 3>> neighbours;
    std::vector<std::array<std::uint32_t, 3>> facet_edges;
    /// Per edge its two vertices, the smaller index first; edges sorted by vertices.
    std::vector<std::array<std::uint32_t, 2>> edges;
    /// Per edge its facets: one (the second no_index) where it is open; of edges with more than two
    /// facets the first two, and is_manifold[e] is 0.
    std::vector<std::array<std::uint32_t, 2>> edge_facets;
    std::vector<char> is_manifold;
    /// Per facet its outward unit normal, and its area (metres squared). A facet so thin that the
    /// rounding of its corners to float32 may turn it has the normal of its neighbour across its
    /// longest side.
    std::vector<Vec3> normals;
    std::vector<double> areas;
    /// Per facet the shell that it belongs to, numbered by their first facets.
    std::vector<std::uint32_t> shells;
};

/// What the intake found and mended. Counts of edges are those of the mesh after mending.
struct MeshReport
{
    std::size_t facets_read = 0;
    std::size_t joined_corners = 0;     ///< moved onto another corner, as facets did not meet
    double joined_within = 0;           ///< metres; the largest distance for that
    std::size_t duplicate_facets = 0;   ///< dropped: same three corners as an earlier one
    std::size_t inner_wall_facets = 0;  ///< dropped: coincident opposite facets between two bodies
    std::size_t inner_shell_facets = 0; ///< dropped: of closed shells inside others of a solid
    std::size_t partition_facets = 0;   ///< dropped: walls of one facet inside a solid
    std::size_t degenerate_facets = 0;  ///< dropped: no area after welding
    std::size_t flipped_facets = 0; ///< turned to agree with their neighbours or to look outwards
    std::size_t open_edges = 0;
    std::size_t non_manifold_edges = 0;
    std::size_t clashing_edges = 0; ///< two facets that run the same way: a one-sided surface
    std::size_t t_junctions = 0; ///< vertices found inside an open edge; its facet is split there
    Vec3 first_junction;         ///< the first of these vertices
    std::size_t self_intersections =
        0;                  ///< facet pairs without a common vertex that cross; counted on request
    std::size_t folds = 0;  ///< pairs of them in one shell; with warns_of_folds
    Vec3 first_fold;        ///< a corner of the first of these pairs
    std::size_t shells = 0; ///< parts connected through edges with two facets
    bool is_watertight = false; ///< every edge has as many facets that run one way as the other
    double volume = 0;          ///< signed sum, metres cubed
    double area = 0;
    Box3 bounds;
    std::vector<std::string> warnings; ///< whole sentences with counts and one place each
};

struct MeshIntakeOptions
{
    /// Metres. 0: corners with equal coordinates only, unless the facets do not meet at all.
    double weld_distance = 0;
    /// Metres: the particle distance that the mesh is used at. Cracks up to 0.15 dp wide are
    /// closed. 0: unknown; none is closed.
    double dp = 0;
    /// The corners are as exact as doubles are, not as float32: of round shapes and CAD files.
    bool is_exact = false;
    /// The mesh bounds a solid: what has the inside on both of its faces is dropped, walls of one
    /// facet that part it and closed shells inside others.
    bool is_solid = false;
    bool count_self_intersections = false;
    /// A part that crosses itself, deeper than a thousandth of `dp`, is told: which of its sides is
    /// the inside is anybody's guess there.
    bool warns_of_folds = false;
};

/// Welds, cleans and orients the facets of a file.
///
/// Vertices keep the order in which the file names them first, facets their order in the file;
/// vertices of dropped facets stay. Of facets with the same corners one stays, and none of two that
/// are a wall between two touching bodies (each face goes on in facets that lie behind it); slivers
/// within the rounding of float32 that stand on an edge are dropped.
/// Without a weld distance, a mesh with a quarter of its edges open is welded within 1e-6, 1e-5 or
/// 1e-4 of its longest extent, but not more than 0.15 dp: the first of them that leaves a tenth of
/// these edges open at most, and nine tenths of the facets.
/// A vertex inside an open edge (a T-junction) splits the facet of that edge, so that no false hole
/// is left. Without a weld distance, ends of open edges that lie within a crack's width of one
/// another or of an open edge are then joined with it, the narrowest cracks first, where that
/// leaves fewer edges open and none with more facets than before. Facets are turned to agree across
/// edges within a shell, the fewer to the more. A closed shell whose volume is negative and that no
/// other shell holds is turned as a whole, together with the shells that it holds, so that normals
/// look outwards and cavities stay cavities; a shell with small holes counts as closed where its
/// facets' areas, as vectors, sum to less than a tenth of its area.
///
/// soup     at least one facet, coordinates finite and below 1e90 in size
/// threads  number of threads; the result does not depend on it
/// throws   GeometryError when no facet is left, or a coordinate is not finite
/// cost     O(n log n)
/// source   edge-face map of the FPPG paper, "Feature extraction and feature line particles"
SurfaceMesh repair_mesh(const TriangleSoup& soup, const MeshIntakeOptions& options, int threads,
                        MeshReport& report);

/// The facets with their corners written out, in the same order.
TriangleSoup soup_of(const SurfaceMesh& mesh);

} // namespace fppg
