#include "meshes/facet_checks.h"

#include "fppg/error.h"

#include "core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{

namespace
{

/// So far from zero nothing that is simulated can be; the number is most likely damaged.
constexpr double huge_coordinate = 1e10;

/// What a pass over the facets finds; blocks are combined in order.
struct FacetCounts
{
    std::size_t not_finite = 0;
    std::size_t first_not_finite = SIZE_MAX;
    std::size_t far = 0;
    std::size_t first_far = SIZE_MAX;
    std::size_t without_area = 0;
    std::size_t first_without_area = SIZE_MAX;
    Box3 box; ///< of the corners that are neither far nor not finite

    void count_facet(std::size_t i, const Vec3* corners)
    {
        const auto note = [i](std::size_t& count, std::size_t& first)
        {
            ++count;
            first = std::min(first, i);
        };
        if (!is_finite(corners[0]) || !is_finite(corners[1]) || !is_finite(corners[2]))
            return note(not_finite, first_not_finite);
        double largest = 0;
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                largest = std::max(largest, std::abs(corners[k][axis]));
        if (largest > huge_coordinate) return note(far, first_far);
        for (int k = 0; k < 3; ++k) box.add(corners[k]);
        if (cross(corners[1] - corners[0], corners[2] - corners[0]) == Vec3{})
            note(without_area, first_without_area);
    }
    void add(const FacetCounts& other)
    {
        not_finite += other.not_finite;
        first_not_finite = std::min(first_not_finite, other.first_not_finite);
        far += other.far;
        first_far = std::min(first_far, other.first_far);
        without_area += other.without_area;
        first_without_area = std::min(first_without_area, other.first_without_area);
        if (!other.box.is_empty())
        {
            box.add(other.box.min);
            box.add(other.box.max);
        }
    }
};

FacetCounts count_facets(const TriangleSoup& soup, int threads)
{
    const std::size_t blocks = (soup.size() + facets_per_block - 1) / facets_per_block;
    std::vector<FacetCounts> counts(blocks);
    parallel_for(blocks, threads,
                 [&](std::size_t block)
                 {
                     const std::size_t begin = block * facets_per_block;
                     const std::size_t end = std::min(soup.size(), begin + facets_per_block);
                     FacetCounts local;
                     for (std::size_t i = begin; i < end; ++i)
                         local.count_facet(i, &soup.vertices[3 * i]);
                     counts[block] = local;
                 });
    FacetCounts total;
    for (const FacetCounts& part : counts) total.add(part);
    return total;
}

/// Leaves out facets with a coordinate that is not finite, or larger than `limit`.
void leave_out_beyond(double limit, TriangleSoup& soup)
{
    const auto is_good = [limit](const Vec3& p)
    { return std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit; };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < soup.size(); ++i)
    {
        const Vec3* const corners = &soup.vertices[3 * i];
        if (!std::all_of(corners, corners + 3, is_good)) continue;
        std::copy(corners, corners + 3, &soup.vertices[3 * kept]);
        ++kept;
    }
    soup.vertices.resize(3 * kept);
}

std::string facets_have(std::size_t count, std::size_t all)
{
    return fmt::format("{} of {} facets {}", count, all, count == 1 ? "has" : "have");
}

/// Float32 has 24 bits: far from the origin neighbouring numbers lie so far apart that the shape
/// is lost.
void warn_of_coarse_numbers(const Box3& box, std::vector<std::string>& warnings)
{
    constexpr double steps_of_a_shape = 1000;
    if (box.is_empty()) return;
    double largest = 0;
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
        extent = std::max(extent, box.max[axis] - box.min[axis]);
    }
    const double step = std::ldexp(1.0, std::ilogb(std::max(largest, 1e-30)) - 23);
    if (extent < steps_of_a_shape * step)
        warnings.push_back(fmt::format(
            "The mesh is {:.4g} wide and lies up to {:.4g} from the origin, where the numbers of "
            "the file are {:.4g} apart; its shape is coarse. Move it near the origin before it is "
            "written.",
            extent, largest, step));
}

} // namespace

void check_facets(MeshFile& mesh, const std::string& path, bool has_float32, int threads)
{
    const std::size_t all = mesh.soup.size();
    const FacetCounts counts = count_facets(mesh.soup, threads);
    if (counts.not_finite == all)
        throw GeometryError(fmt::format(
            "{}: each of its {} facets has a coordinate that is not finite", path, all));
    if (counts.not_finite > 0)
    {
        leave_out_beyond(std::numeric_limits<double>::max(), mesh.soup);
        mesh.warnings.push_back(fmt::format(
            "{} a coordinate that is not finite and {} left out; the first is facet {}.",
            facets_have(counts.not_finite, all), counts.not_finite == 1 ? "is" : "are",
            counts.first_not_finite + 1));
    }
    if (counts.far > 0)
    {
        // Quads and polygons name their triangles by index, so none of those may go.
        const bool is_left_out = counts.far + counts.not_finite < all && mesh.quads.empty() &&
                                 mesh.wide_polygons.empty();
        if (is_left_out) leave_out_beyond(huge_coordinate, mesh.soup);
        mesh.warnings.push_back(fmt::format(
            "{} a coordinate beyond {:.0e}, most likely a damaged number{}; the first is facet {}.",
            facets_have(counts.far, all), huge_coordinate,
            !is_left_out      ? ""
            : counts.far == 1 ? ", and is left out"
                              : ", and are left out",
            counts.first_far + 1));
    }
    if (counts.without_area > 0)
        mesh.warnings.push_back(fmt::format("{} no area; the first is facet {}.",
                                            facets_have(counts.without_area, all),
                                            counts.first_without_area + 1));
    if (has_float32) warn_of_coarse_numbers(counts.box, mesh.warnings);
}

} // namespace fppg
