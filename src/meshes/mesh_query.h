#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "fppg/mesh.h"
#include "meshes/near_tree.h"

namespace fppg
{

/// Where a line along an axis passes through a facet.
struct Crossing
{
    double position = 0;     ///< coordinate along the axis
    int step = 0;            ///< +1 entering (the facet faces against the axis), -1 leaving
    std::uint32_t facet = 0; ///< index in the soup
};

/// The steps of all crossings of a line, summed.
struct LineSums
{
    int before = 0; ///< of those before a point
    int behind = 0; ///< of the others
};

/// Answers geometric questions about one mesh. Embree's tree of boxes, made in float with room for
/// its rounding, yields the candidates; every answer is computed from them in double and depends
/// neither on the tree nor on the number of threads. Queries may run from several threads at once.
class MeshQuery
{
public:
    /// soup     at least one facet, all coordinates finite
    /// threads  number of threads that build the tree
    /// throws   GeometryError for an empty soup or one with a coordinate that is not finite; Error
    ///          if Embree fails (names its error code)
    explicit MeshQuery(TriangleSoup soup, int threads = 1);
    ~MeshQuery();
    MeshQuery(MeshQuery&&) noexcept;
    MeshQuery& operator=(MeshQuery&&) noexcept;

    /// Makes the tree that closest_point() searches, on all threads. Else its first call does, and
    /// from a parallel loop on that thread alone, while the others wait.
    void prepare_nearest() const;

    /// The nearest point of all facets. A point on an edge has the same bits whichever of the
    /// facets at that edge it is computed from.
    ///
    /// within  metres; how far to look, which saves half of the search or more. Where no point of
    ///         the mesh is so near, the facet is the largest number, point and distance are
    ///         infinite
    ClosestPoint closest_point(const Vec3& point,
                               double within = std::numeric_limits<double>::infinity()) const;

    /// All crossings of the half line from `origin` towards larger coordinates along `axis` (0, 1
    /// or 2), sorted by position, then facet. Edges and vertices count as in inside_spans(): for
    /// axis 2 as if the line stood an infinitesimal amount further in x, then y; for the others
    /// in the axes that follow cyclically. Facets parallel to the line are not crossed.
    std::vector<Crossing> crossings(const Vec3& origin, int axis) const;

    /// The steps of the line through `point` along `axis`, by the rules of crossings(); faster.
    ///
    /// counts  whether a facet counts; empty: all do
    LineSums line_sums(const Vec3& point, int axis,
                       const std::function<bool(std::uint32_t)>& counts = {}) const;

    const TriangleSoup& soup() const;

private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

} // namespace fppg
