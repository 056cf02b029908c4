#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/vec.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// The lattice of a case: node (i, j, k) stands at origin + (i, j, k) * dp. It is cubic but where
/// only fluid stands on it between walls that are no whole number of dp apart (LatticeMove): then
/// its steps along the axes are somewhat longer or shorter than dp.
/// Rules L1 to L5, found by experiment with GenCase v5.4.354 (origin at pointmin, or moved down to
/// a whole multiple of dp from pointref; the node at pointmax is not part of it).
struct LatticeGrid
{
    Vec3 origin;
    double dp = 0;
    std::array<std::uint32_t, 3> n{0, 0, 0}; ///< nodes along x, y, z; at least 1 each
    bool is_2d = false;                      ///< one layer in y, at origin.y
    /// Axes along which the solver repeats the case (fppg/periodic.h): particles off the lattice
    /// may be half a step beyond the first and the last nodes.
    std::array<bool, 3> is_periodic{};
    Vec3 stretch{1, 1, 1}; ///< steps along the axes over dp

    double step(int axis) const { return dp * stretch[axis]; } ///< metres
    double least_step() const { return dp * std::min({stretch.x, stretch.y, stretch.z}); }
    /// Where a node is, or a place between nodes.
    Vec3 place(double x, double y, double z) const
    {
        return {origin.x + x * step(0), origin.y + y * step(1), origin.z + z * step(2)};
    }
    Vec3 place(const Vec3& node) const { return place(node.x, node.y, node.z); }
    /// Where a place is, in steps from the first node.
    Vec3 steps_to(const Vec3& p) const
    {
        return {(p.x - origin.x) / step(0), (p.y - origin.y) / step(1), (p.z - origin.z) / step(2)};
    }
};

/// Nodes [z_begin, z_end) of the column at row `y` of one slab (= one x).
struct Span
{
    std::uint32_t y = 0;
    std::uint32_t z_begin = 0;
    std::uint32_t z_end = 0;
    bool operator==(const Span&) const = default;
};

/// A set of nodes: slabs[i] holds the spans at x = x_begin + i, sorted by (y, z_begin), disjoint
/// and not touching one another in a column.
struct SpanSet
{
    std::uint32_t x_begin = 0;
    std::vector<std::vector<Span>> slabs;
};

/// Nodes [z_begin, z_end) of the column (slab, y) that carry `mk`.
struct Run
{
    std::uint32_t y = 0;
    std::uint32_t z_begin = 0;
    std::uint32_t z_end = 0;
    std::uint16_t mk = 0; ///< absolute mk, from 1; void nodes have no run
    /// Particles off the lattice stand in for the nodes: those of a body-fitted wall in its zone,
    /// or of setfrdrawmode. For filters and fills they are nodes of the mk, but no particles.
    bool is_covered = false;
    bool operator==(const Run&) const = default;
};

/// The state of the lattice: which mk every node carries. slabs[x] holds the runs of that x, sorted
/// by (y, z_begin), disjoint; neighbours in a column that touch differ in mk or in is_covered.
/// Memory grows with the surface of the drawn regions and with grid.n[0], never with the number of
/// nodes.
struct RunField
{
    LatticeGrid grid;
    std::vector<std::vector<Run>> slabs; ///< size grid.n[0]
    /// Particles off the lattice; without any, no run is covered.
    FittedWalls walls;
};

struct CaseDef;
struct Scene;

/// A mesh file that a draw uses.
struct MeshFileUse
{
    std::string name; ///< as the definition writes it
    std::string path; ///< where it was found
    int line = 0;     ///< of the first draw that uses it
};

/// What `cellsout` or `pointsmkout` asks for, as the nodes were then.
struct NodeFile
{
    std::string name;      ///< behind the case name: "_name_MkCells.vtk", "_name_mk10.vtk"
    bool is_cells = false; ///< else points
    RunField cells;        ///< of all mks
    std::optional<std::uint16_t> mk; ///< the only one to write
    std::vector<Vec3> points;        ///< by z, then y, then x
};

/// What a `<fill>` of `<fppg>` found and did.
struct CavityFilled
{
    int line = 0; ///< of the definition
    std::uint64_t cavity_nodes = 0;
    std::uint64_t nodes = 0;       ///< filled
    double litres_per_node = 0;    ///< in 2D a metre of width
    std::optional<double> open_at; ///< metres, the lowest way out; none where it is closed
    double level = 0;              ///< metres, along its up
    std::vector<std::string> log;  ///< the same in words, with its gaps
};

/// What the lattice stage says besides the nodes.
struct LatticeReport
{
    std::vector<std::string> warnings; ///< whole sentences that name file, line and element
    std::vector<std::string> log;      ///< lines about files of points
    std::vector<CavityFilled> fills;   ///< in the order of the commands
    bool keeps_floods = false;         ///< `flooded` is wanted
    /// What fills would reach in boxes a node larger on each side, in the order of the commands;
    /// nothing of those in polyhedra.
    std::vector<SpanSet> flooded;
    std::uint64_t triangles = 0;         ///< drawn
    std::uint64_t triangles_ignored = 0; ///< of them, no bigger than one node
    std::vector<MeshFileUse> mesh_files; ///< in order of use, each once
    std::vector<NodeFile> node_files;    ///< in the order of the commands; of one name the last
};

/// Called before every draw with the number of draws done and of all.
using LatticeProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Executes the draws of a scene in order, each over what was there (rule O1): body-fitted shapes
/// by their true surfaces, all others on the nodes of the lattice.
///
/// threads   number of threads; the result does not depend on it
/// progress  may be empty; an exception thrown in it stops the work
/// throws    IoError, GeometryError for mesh files; CaseError for what is not supported yet
/// cost      time and memory O(surface of what is drawn), never O(nodes of the domain)
RunField draw_scene(const Scene& scene, int threads, const LatticeProgress& progress,
                    LatticeReport& report);

/// The same with every shape on the nodes of the lattice.
RunField draw_on_lattice(const Scene& scene, int threads, const LatticeProgress& progress,
                         LatticeReport& report);

/// The nodes of a field, none of them covered; touching runs of one mk are one. Without the walls.
RunField plain_nodes(const RunField& field, int threads);

/// Puts the particles of `<points>` files into field.walls.volume, in the order of the files.
///
/// field   with all that was drawn; its nodes stay, empty ones where fluid comes get its mk and
///         are covered, so that water columns count it
/// throws  IoError, GeometryError for the files; GeometryError that names the point and its line
///         for one outside the domain (between its first and last nodes; in 2D off its plane)
/// warns   of points nearer than dp/2 to a drawn node that is a particle, or equal to another one
void add_point_files(const Scene& scene, RunField& field, LatticeReport& report);

struct ShapePolygons;
enum class ShapeFormat : std::uint8_t;

/// One shape file that `shapeout` asks for.
struct ShapeFile
{
    std::string name; ///< behind the case name: "_name_Actual.vtk", "_name_Dp.vtp"
    ShapeFormat format{};
    bool has_normals = false; ///< the lines of savenormal stand in front of the shapes
    std::vector<ShapePolygons> shapes;
};

/// The shapes of a case as polygons, for every `shapeout`: as drawn (Actual) and with corners on
/// the lattice (Dp). Spheres and cylinders have as many sides as setdpctes says (24), points give
/// nothing.
///
/// throws IoError, GeometryError for mesh files
std::vector<ShapeFile> collect_shape_files(const Scene& scene);

} // namespace fppg
