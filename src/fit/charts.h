#pragma once

#include "fit/key_table.h"
#include "fit/work_mesh.h"

#include <span>

namespace fppg
{

/// Sides of facets that a work mesh to be cut into charts leaves whole, in dp.
inline constexpr double longest_chart_side = 48;

/// Cells from the first to the last along x, y and z.
using CellRange = std::array<std::int64_t, 6>;

/// A mesh cut into charts: connected facets between borders, of no more than about one size; parts
/// narrower than half a dp share charts of crumbs, so that a heap of them stays a few charts. How
/// it is cut depends on the mesh and dp alone, so charts that do not come near one another can be
/// filled in any order, on any number of threads, with the same result.
class Charts
{
public:
    Charts(const WorkMesh& mesh, double dp);

    std::size_t size() const { return first_facet_.size() - 1; }
    std::uint32_t of_facet(std::uint32_t facet) const { return chart_of_facet_[facet]; }
    std::span<const std::uint32_t> facets(std::uint32_t chart) const
    {
        return {facets_.data() + first_facet_[chart], facets_.data() + first_facet_[chart + 1]};
    }
    /// Whether a chart is made of parts narrower than half a dp that need not be connected.
    bool is_crumbs(std::uint32_t chart) const { return is_crumbs_[chart]; }
    /// Charts that come within 4 dp of this one, ascending; more may be listed.
    const std::vector<std::uint32_t>& near_charts(std::uint32_t chart) const
    {
        return near_charts_[chart];
    }
    /// Charts that come within 2 dp of a point, ascending; more may be listed.
    std::span<const std::uint32_t> near_point(const Vec3& point) const;
    /// Whether a chart comes within 2 dp of a point, or seems to.
    bool is_near(std::uint32_t chart, const Vec3& point) const;

    /// Charts of one wave are not near one another; the waves follow one another.
    const std::vector<std::vector<std::uint32_t>>& waves() const { return waves_; }

private:
    void cut(const WorkMesh& mesh, double dp);
    void mark_cells(const WorkMesh& mesh, double dp);
    /// Notes a chart in the cells of a range no farther than `slab` from the facet's plane.
    void mark_cells_of(std::uint32_t chart, const WorkFacet& facet, const CellRange& range,
                       double slab);
    void make_waves();
    std::uint64_t key_of(const Vec3& point) const;

    std::vector<std::uint32_t> chart_of_facet_;
    std::vector<std::uint32_t> facets_;
    std::vector<std::size_t> first_facet_;
    std::vector<char> is_crumbs_;
    std::vector<Box3> boxes_; ///< with the clearance
    double cell_ = 1;
    KeyTable cells_;
    std::vector<std::vector<std::uint32_t>> charts_of_cell_;
    std::vector<std::vector<std::uint32_t>> near_charts_;
    std::vector<std::vector<std::uint32_t>> waves_;
};

} // namespace fppg
