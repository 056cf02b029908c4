#pragma once

#include "fppg/surface_mesh.h"

#include "core/row_lists.h"
#include "offset/depth_memo.h"
#include "offset/offset_surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fppg
{

/// A crease is looked for this far to both sides of an edge, dp.
inline constexpr double beside_edge = 0.08;
/// The same where the surface was cut off.
inline constexpr double longest_pull = 1.5;

/// An offset surface whose vertices are put onto its creases.
struct CreaseMesh
{
    /// depths  of the wall
    CreaseMesh(const WallDepth& wall, const DepthMemo& depths, const OffsetOptions& options,
               int threads, SurfaceMesh& mesh);

    Vec3 normal_of(std::uint32_t facet) const;
    Vec3 middle_of(std::uint32_t facet) const;
    /// The edges of a vertex.
    std::span<const std::uint32_t> edges_of(std::uint32_t v) const { return edges_.row(v); }
    std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const
    {
        return mesh.edges[e][0] == v ? mesh.edges[e][1] : mesh.edges[e][0];
    }

    const WallDepth& wall;
    const DepthMemo& depths;
    const OffsetOptions& options;
    int threads;
    SurfaceMesh& mesh;
    double turn; ///< cosine of the angle by which faces turn at a crease

private:
    RowLists<std::uint32_t> edges_;
};

/// Where two vertices on a crease lie across the edge of two others, the crease runs between them:
/// that edge is turned. Only facets change; the mesh is to be connected anew.
///
/// is_placed  per vertex: it is on a crease
/// returns    whether any was turned
bool turn_onto_creases(const CreaseMesh& on, const std::vector<char>& is_placed);

/// Where a corner of creases sticks out into a cell none of whose edges it meets, they end short of
/// it: the vertex nearest to it is pulled there.
///
/// returns  whether any was pulled
bool pull_cut_corners(const CreaseMesh& on, const std::vector<char>& is_placed);

} // namespace fppg
