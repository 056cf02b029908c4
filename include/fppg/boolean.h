#pragma once

#include "fppg/combination.h"
#include "fppg/lattice.h"
#include "fppg/surface_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// A part to be combined.
struct BooleanPart
{
    std::string name; ///< for messages
    const SurfaceMesh* mesh = nullptr;
    /// Without an inside the part is a surface: in a union it stays where it is outside the others,
    /// in an intersection where it is inside them, and nothing is cut from what it is taken from.
    /// Without the flag such a part is an error.
    bool may_be_sheet = false;
    bool is_surface = false; ///< without an inside, though the mesh may be closed
    /// Above 0, what has no inside of the other parts counts as inside this one where it gets
    /// deeper than this below the surface, metres, and as outside where it runs along that. Else it
    /// is cut wherever it is inside or on the surface.
    double least_depth = 0;
};

struct BooleanOptions
{
    /// What is nearer than this touches, metres; 0: 2e-7 of the largest coordinate, three roundings
    /// of a file in float32, but no more than 0.15 dp.
    double merge_distance = 0;
    double dp = 0; ///< metres; 0: unknown
};

/// The surface of a combination of parts.
struct BooleanMesh
{
    SurfaceMesh mesh; ///< facets by part, then facet of the part; outward
    MeshReport report;
    std::vector<std::uint32_t> parts;  ///< per facet, the part that it comes from
    std::vector<std::uint32_t> facets; ///< per facet, the facet of that part's mesh
    /// Per facet, the part whose solid lies behind it: its own, or where a part is taken away the
    /// first one that it is taken from.
    std::vector<std::uint32_t> owners;
    /// Edges where surfaces of different parts meet at an angle of more than half a degree, or
    /// more than two facets meet; ascending.
    std::vector<std::uint32_t> seams;
    std::uint64_t crossing_pairs = 0; ///< pairs of facets of different parts that meet in a line
    std::uint64_t coplanar_pairs = 0; ///< pairs that overlap in one plane
    std::uint64_t patches = 0;        ///< connected surfaces that were kept or left out as a whole
    std::vector<std::string> warnings;
};

/// The surface of a combination of parts, cut exactly where they cross.
///
/// Facets are cut along the lines where those of different parts meet; each connected surface
/// between such lines is inside or outside every other part as a whole, and stays where the
/// combination differs between its two sides. What stays faces out of the result: of what is taken
/// away, the surface is turned.
/// - Surfaces of several parts in the same place count once: faces that look the same way belong
///   to the first of their parts, and stay if the combination differs across all of them; faces
///   that look at each other vanish in a union and stay in a difference.
/// - Parts that touch along a plane, within merge_distance, are one body in a union: nothing is
///   left between them.
/// - What crosses itself within one part stays as it is, as it does without a combination.
/// - The inside of a part with faults is that of inside_by_vote(): by the winding number.
///
/// parts    meshes as repair_mesh() made them; facets look outwards
/// threads  number of threads; the result does not depend on it
/// throws   GeometryError that names a part which bounds no volume and may not be a sheet, or an
///          operand that is missing. A result without any facet is no error
/// source   the union of the FPPG paper, "Multi-geometry Boolean operations", on surfaces; patches
///          and their winding numbers after Zhou et al., Mesh Arrangements for Solid Geometry, 2016
/// cost     O(n log n) and that of arranging the facets that meet
BooleanMesh boolean_mesh(const std::vector<BooleanPart>& parts, const BooleanNode& node,
                         const BooleanOptions& options, int threads);

/// The nodes inside a part or on it: those of inside_spans() for a mesh without fault, else those
/// of inside_by_vote(). None for a part without an inside.
///
/// mesh  as repair_mesh() made it
SpanSet solid_nodes(const SurfaceMesh& mesh, const LatticeGrid& grid, int threads);

} // namespace fppg
