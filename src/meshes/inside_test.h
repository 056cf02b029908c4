#pragma once

#include "meshes/mesh_query.h"
#include "meshes/winding_tree.h"

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace fppg
{

/// How many times the facets that count wind around p, where two of three lines along the axes
/// agree; nothing where no two do. See InsideTest::winding().
std::optional<int> winding_by_lines(const MeshQuery& query, const Vec3& p,
                                    const std::function<bool(std::uint32_t)>& counts = {});

/// The inside test for single points (leak, Booleans, exclusion bands, cuts); lattice columns use
/// inside_spans(). Rays are Embree's, crossings are computed in double, and a ray that meets an
/// edge or a vertex counts as one moved by an infinitesimal amount, so that it is exact there too.
/// May be asked from several threads at once.
class InsideTest
{
public:
    /// soup    at least one facet; it may have holes
    /// throws  as MeshQuery does
    explicit InsideTest(TriangleSoup soup, int threads = 1) : query_(std::move(soup), threads) {}

    /// How many times the facets that face outwards wind around p: 0 outside, negative inside
    /// facets that face inwards. The sum of signed crossings before p on which two of three lines
    /// along the axes agree; a line whose crossings do not cancel out runs through a hole and does
    /// not count. Where no two agree, the winding number of WindingTree, rounded.
    int winding(const Vec3& p) const;
    bool is_inside(const Vec3& p) const { return winding(p) > 0; }

    const MeshQuery& query() const { return query_; }

private:
    MeshQuery query_;
    mutable std::once_flag needs_tree_;
    mutable std::unique_ptr<WindingTree> tree_; ///< made when it is needed first
};

} // namespace fppg
