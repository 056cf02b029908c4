#pragma once

#include "compare/exact_statistics.h"
#include "compare/slabs.h"
#include "meshes/mesh_query.h"

#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace fppg
{

/// What is measured at the particles of one mk in one file.
struct MkMeasures
{
    std::uint64_t alone = 0; ///< without a neighbour in reach, not in `spacing`
    ExactStatistics spacing, shepard, distance;

    void add(const MkMeasures& other)
    {
        alone += other.alone;
        spacing.add(other.spacing);
        shepard.add(other.shepard);
        distance.add(other.distance);
    }
};

/// Spacing, Shepard sum and distance to the geometry, as CompareOptions describes them.
struct Measuring
{
    static constexpr double shepard_h_dp = 1.3;
    static constexpr double neighbour_reach_dp = 2.6; ///< two cells, and 2 h

    double dp = 0;
    bool is_2d = false;
    const MeshQuery* geometry = nullptr; ///< null: no distances

    /// Measures the particles of a column that belong to the slab itself; `of_mk` gives the
    /// MkMeasures to add to.
    template <typename OfMk>
    void measure_column(const CellGrid& grid, std::size_t column, const OfMk& of_mk) const
    {
        const double h = shepard_h_dp * dp;
        const double reach_squared = neighbour_reach_dp * neighbour_reach_dp * dp * dp;
        // Wendland's kernel: the integral of (1 - q / 2)^4 (2 q + 1) is 16 pi / 21 h^3 in space,
        // 4 pi / 7 h^2 in the plane.
        const double share =
            is_2d ? 7 / (4 * std::numbers::pi * shepard_h_dp * shepard_h_dp)
                  : 21 / (16 * std::numbers::pi * shepard_h_dp * shepard_h_dp * shepard_h_dp);
        const auto visit = [&](std::uint32_t i, const CellGrid::Stretch* stretches, std::size_t n)
        {
            const SlabParticle& p = grid.particles()[i];
            if (!p.is_core) return;
            double sum = 0;
            double nearest = reach_squared;
            for (std::size_t s = 0; s < n; ++s)
                for (std::uint32_t j = stretches[s].begin; j < stretches[s].end; ++j)
                {
                    const Vec3 way = grid.particles()[j].position - p.position;
                    const double squared = dot(way, way);
                    if (!(squared < reach_squared)) continue;
                    const double q = std::sqrt(squared) / h;
                    const double rest = 1 - q / 2;
                    sum += rest * rest * rest * rest * (2 * q + 1);
                    if (j != i) nearest = std::min(nearest, squared);
                }
            MkMeasures& of = of_mk(p.mk);
            of.shepard.add(share * sum, shepard_range);
            if (nearest < reach_squared)
                of.spacing.add(std::sqrt(nearest) / dp, spacing_range);
            else
                ++of.alone;
            if (geometry == nullptr) return;
            const double limit = distance_range.end * dp;
            const double distance = geometry->closest_point(p.position, limit).distance;
            if (distance <= limit) of.distance.add(distance / dp, distance_range);
        };
        grid.for_each_in_column(column, grid, 2, visit);
    }
};

/// The facets of mesh files. throws CompareError for one without a surface, and as read_mesh_file()
TriangleSoup read_geometry(const std::vector<std::string>& paths, int threads);

} // namespace fppg
