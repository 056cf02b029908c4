#pragma once

#include "fppg/fitted_walls.h"
#include "fppg/lattice.h"

#include "fit/wall_section.h"
#include "meshes/mesh_facets.h"
#include "meshes/mesh_query.h"
#include "meshes/pseudo_normals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace fppg
{

/// The walls of all bodies as one: their facets, or in 2D the lines where they meet the plane. The
/// bodies must outlive it.
class AllWalls
{
public:
    struct Closest
    {
        Vec3 point;
        double distance = 0; ///< metres
        std::size_t body = 0;
        bool is_outside = false; ///< on the side where the facets look
        Vec3 normal;             ///< of the facet
        std::uint16_t mk = 0;    ///< of the facet, absolute
    };

    AllWalls(const std::vector<FittedBody>& bodies, const LatticeGrid& grid, int threads)
        : is_2d_(grid.is_2d)
    {
        TriangleSoup soup;
        for (const FittedBody& body : bodies)
        {
            first_.push_back(normals_.size());
            sides_.emplace_back();
            if (body.is_layer()) continue;
            WallSection section;
            if (grid.is_2d) section = wall_section(body.mesh, grid.origin.y);
            const TriangleSoup of_body = grid.is_2d ? section.soup : soup_of(body.mesh);
            soup.vertices.insert(soup.vertices.end(), of_body.vertices.begin(),
                                 of_body.vertices.end());
            const std::vector<Vec3>& normals = grid.is_2d ? section.normals : body.mesh.normals;
            sides_.back().normals.emplace(body.mesh);
            sides_.back().facets = std::move(section.facets);
            for (const Vec3& v : body.mesh.vertices) size_ = std::max(size_, largest_coordinate(v));
            normals_.insert(normals_.end(), normals.begin(), normals.end());
            is_of_solid_.resize(normals_.size(), body.has_no_fluid_inside() ? 1 : 0);
            // Lines in the plane of a 2D case are not its facets.
            if (grid.is_2d || body.facet_mk.empty())
                mks_.resize(normals_.size(), body.mk);
            else
                mks_.insert(mks_.end(), body.facet_mk.begin(), body.facet_mk.end());
        }
        if (!soup.vertices.empty()) query_.emplace(std::move(soup), threads);
    }

    bool is_empty() const { return !query_; }
    /// within  metres; how far to look. Where no wall is so near, the distance is infinite, and the
    ///         rest does not count
    Closest closest(const Vec3& p, double within = std::numeric_limits<double>::infinity()) const
    {
        const ClosestPoint near = query_->closest_point(p, within);
        if (near.distance == std::numeric_limits<double>::infinity())
            return {near.point, near.distance, 0, false, {}, 0};
        const auto after = std::upper_bound(first_.begin(), first_.end(), near.facet);
        const auto body = static_cast<std::size_t>(after - first_.begin()) - 1;
        const Sides& sides = sides_[body];
        auto facet = static_cast<std::uint32_t>(near.facet - first_[body]);
        if (is_2d_) facet = sides.facets[facet];
        FacetPlace place;
        return {near.point,
                near.distance,
                body,
                sides.normals->side_of(p, facet, near.point, 1e-12 * size_, place) > 0,
                normals_[near.facet],
                mks_[near.facet]};
    }
    Vec3 closest_point(const Vec3& p, double within) const
    {
        return query_->closest_point(p, within).point;
    }

    const TriangleSoup& soup() const { return query_->soup(); }
    /// Whether a place is in a body that has no fluid inside, also beside its edges; in 2D never.
    bool is_in_solid(const Vec3& p) const
    {
        int votes = 0;
        for (int axis = 0; axis < 3 && !is_2d_; ++axis)
            if (query_->line_sums(p, axis, [&](std::uint32_t f) { return is_of_solid_[f] != 0; })
                    .before > 0)
                ++votes;
        return votes >= 2;
    }

private:
    struct Sides
    {
        std::optional<PseudoNormals> normals; ///< of a body that is no layer
        std::vector<std::uint32_t> facets;    ///< of its lines in 2D
    };
    bool is_2d_ = false;
    double size_ = 0;                ///< metres, the largest coordinate: by it rounding is measured
    std::vector<Sides> sides_;       ///< of each body
    std::vector<char> is_of_solid_;  ///< facets
    std::vector<std::uint16_t> mks_; ///< facets
    std::vector<std::size_t> first_; ///< facet or line of each body
    std::vector<Vec3> normals_;      ///< of all facets or lines
    std::optional<MeshQuery> query_;
};

} // namespace fppg
