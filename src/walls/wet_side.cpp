#include "walls/wet_side.h"

#include "fppg/surface_mesh.h"

#include "core/disjoint_set.h"
#include "meshes/mesh_query.h"
#include "walls/plate_thickness.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>

namespace fppg
{
namespace
{

constexpr double least_side = 0.2; ///< of the surface of a plate

/// The thin facets of a plate; of each the side that it belongs to, named by a facet.
class PlateSides
{
public:
    PlateSides(const SurfaceMesh& mesh, const std::vector<double>& thickness)
        : mesh_(mesh), sides_(mesh.facets.size())
    {
        for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        {
            if (!std::isfinite(thickness[f])) continue;
            thin_.push_back(f);
            for (std::size_t k = 0; k < 3; ++k)
            {
                soup_.vertices.push_back(mesh.vertices[mesh.facets[f][k]]);
                const std::uint32_t other = mesh.neighbours[f][k];
                if (other != no_index && std::isfinite(thickness[other])) sides_.join(f, other);
            }
        }
    }

    /// The one side that all fluid is on; nothing: it is on several.
    std::optional<std::uint32_t> side_of(const std::vector<Vec3>& fluid, int threads)
    {
        const MeshQuery query(soup_, threads);
        query.prepare_nearest();
        std::optional<std::uint32_t> side;
        for (const Vec3& p : fluid)
        {
            const std::uint32_t of_place = sides_.find(thin_[query.closest_point(p).facet]);
            if (side && *side != of_place) return std::nullopt;
            side = of_place;
        }
        return side;
    }

    TriangleSoup soup_of(std::uint32_t side)
    {
        TriangleSoup out;
        for (std::size_t i = 0; i < thin_.size(); ++i)
            if (sides_.find(thin_[i]) == side)
                for (std::size_t k = 0; k < 3; ++k)
                    out.vertices.push_back(soup_.vertices[3 * i + k]);
        return out;
    }

    double area_of(std::uint32_t side)
    {
        double area = 0;
        for (const std::uint32_t f : thin_)
            if (sides_.find(f) == side) area += mesh_.areas[f];
        return area;
    }

private:
    const SurfaceMesh& mesh_;
    DisjointSet sides_;
    std::vector<std::uint32_t> thin_;
    TriangleSoup soup_; ///< of these
};

} // namespace

std::optional<WetSide> wet_side(const ShapeMesh& shape, const LatticeGrid& grid,
                                const std::vector<Vec3>& fluid, int threads)
{
    if (fluid.empty() || shape.soup.size() == 0 || !may_be_plate(shape.soup, grid.dp))
        return std::nullopt;
    MeshReport report;
    const SurfaceMesh mesh =
        repair_mesh(shape.soup,
                    {.dp = grid.dp,
                     .is_exact = shape.round != nullptr || shape.cad != nullptr,
                     .is_solid = shape.is_solid},
                    threads, report);
    if (mesh.facets.empty() || !report.is_watertight) return std::nullopt;
    const PlateThickness thickness = plate_thickness(mesh, grid, threads);
    if (!thickness.is_plate) return std::nullopt;
    PlateSides sides(mesh, thickness.of_facets);
    const std::optional<std::uint32_t> side = sides.side_of(fluid, threads);
    if (!side || sides.area_of(*side) < least_side * thickness.area) return std::nullopt;
    WetSide out;
    out.sheet.soup = sides.soup_of(*side);
    out.thickness = thickness.least;
    out.of_mesh = report.warnings;
    return out;
}

std::vector<std::string> warnings_of(const WetSide& side, std::size_t rows, double dp)
{
    std::vector<std::string> out = side.of_mesh;
    out.push_back(fmt::format(
        "it is {:.3g} m thick, too thin for the rows of particles that fluid on one side of it "
        "feels: {} rows stand on that side and behind it, {:.3g} m deep.",
        side.thickness, rows, static_cast<double>(rows - 1) * dp));
    return out;
}

} // namespace fppg
