#include "fppg/surface_mesh.h"

#include <fmt/format.h>

#include "core/text.h"
#include "fppg/error.h"
#include "meshes/close_cracks.h"
#include "meshes/drop_copies.h"
#include "meshes/drop_degenerate.h"
#include "meshes/edge_map.h"
#include "meshes/facet_pairs.h"
#include "meshes/inner_shells.h"
#include "meshes/inner_walls.h"
#include "meshes/judge_edges.h"
#include "meshes/measure_facets.h"
#include "meshes/mesh_facets.h"
#include "meshes/orient_shells.h"
#include "meshes/t_junctions.h"
#include "meshes/turn_outwards.h"
#include "meshes/warning_words.h"
#include "meshes/weld_corners.h"

namespace fppg
{

namespace
{

void check_input(const TriangleSoup& soup)
{
    if (soup.size() >= no_index / 3)
        throw GeometryError(fmt::format("a mesh of {} facets is too large, expected fewer than {}",
                                        soup.size(), no_index / 3));
    for (std::size_t i = 0; i < soup.vertices.size(); ++i)
        if (!is_finite(soup.vertices[i]))
            throw GeometryError(
                fmt::format("facet {} has a coordinate that is not finite", i / 3 + 1));
}

/// Splits facets at vertices inside their edges.
void split_at_junctions(double dp, SurfaceMesh& mesh, int threads, MeshReport& report)
{
    const std::vector<Junction> junctions = find_t_junctions(mesh, 0, widest_crack(dp), threads);
    if (junctions.empty()) return;
    report.first_junction = mesh.vertices[junctions.front().vertex];
    report.t_junctions = junctions.size();
    split_at(junctions, mesh);
    const std::size_t copies = report.duplicate_facets;
    build_edges(mesh, threads);
    drop_copies(mesh, threads, report);
    report.duplicate_facets = copies; // these are pieces of facets, not of the file
}

void drop_inner_shells(SurfaceMesh& mesh, int threads, std::vector<char>& is_turned,
                       MeshReport& report)
{
    std::vector<char> is_inner;
    report.inner_shell_facets = find_inner_shells(mesh, report.shells, threads, is_inner);
    if (report.inner_shell_facets == 0) return;
    erase_facets(is_inner, mesh);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < is_inner.size(); ++f)
        if (is_inner[f] == 0) is_turned[kept++] = is_turned[f];
    is_turned.resize(kept);
    build_edges(mesh, threads);
    orient_shells(mesh, report.shells);
}

void sum_up(const SurfaceMesh& mesh, const std::vector<char>& is_turned, MeshReport& report,
            Vec3& first_flipped)
{
    for (const Facet& facet : mesh.facets)
        for (const std::uint32_t v : facet) report.bounds.add(mesh.vertices[v]);
    const Vec3 middle = report.bounds.min + 0.5 * (report.bounds.max - report.bounds.min);
    for (std::size_t f = mesh.facets.size(); f-- > 0;)
    {
        report.volume += volume_times_six(mesh, f, middle) / 6;
        report.area += mesh.areas[f];
        if (is_turned[f] == 0) continue;
        ++report.flipped_facets;
        first_flipped = mesh.vertices[mesh.facets[f][0]];
    }
}

void warn_of_repairs(const Vec3& first_flipped, MeshReport& report)
{
    const auto warn = [&](bool is_so, const auto& text)
    {
        if (is_so) report.warnings.push_back(text());
    };
    warn(report.joined_corners > 0,
         [&]
         {
             return fmt::format(
                 "The facets do not meet: {} within {:.3g} m of another, joined with it.",
                 counted(report.joined_corners, "corner lies", "corners lie"),
                 report.joined_within);
         });
    warn(report.degenerate_facets > 0,
         [&]
         {
             return fmt::format("{} without area but for rounding, left out.",
                                counted(report.degenerate_facets, "facet is", "facets are"));
         });
    warn(report.duplicate_facets > 0,
         [&]
         {
             return fmt::format(
                 "{} of another, left out.",
                 counted(report.duplicate_facets, "facet is a copy", "facets are copies"));
         });
    warn(report.inner_wall_facets > 0,
         [&]
         {
             return fmt::format(
                 "{} between two bodies that touch, left out.",
                 counted(report.inner_wall_facets, "facet is a wall", "facets are walls"));
         });
    warn(report.partition_facets > 0,
         [&]
         {
             return fmt::format(
                 "{} inside the solid, between parts of it, left out.",
                 counted(report.partition_facets, "facet is a wall", "facets are walls"));
         });
    warn(report.inner_shell_facets > 0,
         [&]
         {
             return fmt::format(
                 "{} to closed parts inside others that face the same way, left out.",
                 counted(report.inner_shell_facets, "facet belongs", "facets belong"));
         });
    warn(report.t_junctions > 0,
         [&]
         {
             return fmt::format(
                 "{} inside an edge of another facet, the first {}; these facets are split there.",
                 counted(report.t_junctions, "vertex lies", "vertices lie"),
                 near(report.first_junction));
         });
    warn(report.flipped_facets > 0,
         [&]
         {
             return fmt::format("{} inwards, the first {}; turned.",
                                counted(report.flipped_facets, "facet looks", "facets look"),
                                near(first_flipped));
         });
}

/// Deeper than this a part crosses itself, dp.
constexpr double least_fold = 1e-3;

void warn_of_folds(const SurfaceMesh& mesh, double dp, int threads, MeshReport& report)
{
    const FacetPairs pairs = find_folded_facets(mesh, least_fold * dp, threads);
    if (pairs.count == 0) return;
    report.folds = pairs.count;
    report.first_fold = mesh.vertices[mesh.facets[pairs.first[0]][0]];
    report.warnings.push_back(fmt::format(
        "A part crosses itself: {} of its facets, the first {}; particles there may be wrong.",
        counted(pairs.count, "pair", "pairs"), near(report.first_fold)));
}

} // namespace

SurfaceMesh repair_mesh(const TriangleSoup& soup, const MeshIntakeOptions& options, int threads,
                        MeshReport& report)
{
    report = {};
    report.facets_read = soup.size();
    check_input(soup);
    SurfaceMesh mesh;
    weld_equal(soup, mesh);
    if (options.weld_distance > 0) weld_near(options.weld_distance, {}, mesh);
    drop_degenerate(mesh, report);
    if (mesh.facets.empty())
        throw GeometryError(
            fmt::format("no facet is left of {}: all lack area", report.facets_read));
    build_edges(mesh, threads);
    if (options.weld_distance == 0)
    {
        join_rounded_corners(options.dp, mesh, threads, report);
        close_cracks(options.dp, mesh, threads, report);
    }
    drop_copies(mesh, threads, report);
    if (mesh.facets.empty()) throw GeometryError("no facet is left: all are walls between bodies");
    drop_loose_slivers(options.dp, mesh, threads, report);
    split_at_junctions(options.dp, mesh, threads, report);
    if (options.weld_distance == 0 && options.dp > 0)
        close_open_ends(options.dp, mesh, threads, report);
    if (options.is_solid) report.partition_facets = drop_partitions(mesh, threads);
    Vec3 first_flipped;
    std::vector<char> is_turned = orient_shells(mesh, report.shells);
    turn_outwards(mesh, report.shells, threads, is_turned);
    if (options.is_solid) drop_inner_shells(mesh, threads, is_turned, report);
    if (options.dp > 0)
        measure_facets(mesh, threads,
                       (options.is_exact ? high_where_exact : high_for_particles) * options.dp);
    else
        measure_facets(mesh, threads);
    sum_up(mesh, is_turned, report, first_flipped);
    warn_of_repairs(first_flipped, report);
    judge_edges(mesh, report);
    if (options.warns_of_folds) warn_of_folds(mesh, options.dp, threads, report);
    if (options.count_self_intersections)
    {
        const FacetPairs pairs = find_crossing_facets(mesh, threads);
        report.self_intersections = pairs.count;
        if (pairs.count > 0)
            report.warnings.push_back(
                fmt::format("{} of facets cross each other, the first {}.",
                            counted(pairs.count, "pair", "pairs"),
                            near(mesh.vertices[mesh.facets[pairs.first[0]][0]])));
    }
    return mesh;
}

} // namespace fppg
