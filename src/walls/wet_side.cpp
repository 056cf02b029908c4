#include "walls/wet_side.h"

#include "fppg/surface_mesh.h"

#include "core/disjoint_set.h"
#include "meshes/mesh_query.h"
#include "walls/plate_thickness.h"
#include "walls/step_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace fppg
{
namespace
{

/// Of the surface of a shell: what is thin in a plate, and what fluid is on.
constexpr double least_plate = 0.5;
constexpr double least_side = 0.2;
constexpr double most_else = 0.02; ///< small parts of it, such as hinges

/// How far before a facet fluid beside it is looked for, dp, and from how many facets of a side,
/// the largest ones.
constexpr double before_dp = 2;
constexpr std::size_t most_looks = 12;
constexpr double opposite_face = -0.5; ///< cosine, of the two faces of a plate
constexpr double sharp = 0.5;          ///< the same of a face and a rim
/// Of the six: a trough has three, a tank without a lid five.
constexpr int ways_around = 3;

/// The thin facets of a plate; of each the side that it belongs to, named by a facet.
class PlateSides
{
public:
    PlateSides(const SurfaceMesh& mesh, const std::vector<double>& thickness, double thin,
               double dp, int threads)
        : mesh_(mesh),
          thickness_(thickness),
          thin_dp_(thin),
          dp_(dp),
          threads_(threads),
          sides_(mesh.facets.size()),
          shells_(mesh.facets.size()),
          is_of_side_(mesh.facets.size(), 0),
          is_wet_(mesh.facets.size(), 0),
          all_(fppg::soup_of(mesh), threads)
    {
        for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        {
            for (const std::uint32_t other : mesh.neighbours[f])
            {
                if (other == no_index) continue;
                shells_.join(f, other);
                if (is_thin(f) == is_thin(other) && !is_round_the_rim(f, other))
                    sides_.join(f, other);
            }
            if (is_thin(f)) thin_.push_back(f);
        }
        join_thick_parts();
        std::stable_sort(thin_.begin(), thin_.end(),
                         [&](std::uint32_t a, std::uint32_t b)
                         { return mesh.areas[a] > mesh.areas[b]; });
        for (const std::uint32_t f : thin_)
            if (std::vector<std::uint32_t>& of = looks_of_[sides_.find(f)]; of.size() < most_looks)
                of.push_back(f);
        all_.prepare_nearest();
    }

    /// Finds the sides that fluid comes to: those nearest to it, and those that face it along an
    /// axis, from where it is and from places before the sides that were found.
    void find_wet(const std::vector<Vec3>& fluid)
    {
        std::vector<Vec3> todo = fluid;
        const MeshQuery thin(thin_soup(), threads_);
        thin.prepare_nearest();
        for (const Vec3& p : fluid) take(thin_[thin.closest_point(p).facet], todo);
        while (!todo.empty())
        {
            const Vec3 p = todo.back();
            todo.pop_back();
            for (int axis = 0; axis < 3; ++axis)
                for (const bool is_up : {true, false})
                    if (const auto f = facing_facet(p, axis, is_up)) take(*f, todo);
        }
        join_corners();
    }

    /// The shells that fluid is on one face of: their wet sides make up the sheet, all facets of
    /// the others the rest.
    ///
    /// counts  whether a facet counts for the surface of a plate
    std::optional<WetSide> sheet(const std::function<bool(std::uint32_t)>& counts)
    {
        std::map<std::uint32_t, Shell> shells;
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f)
        {
            Shell& shell = shells[shells_.find(f)];
            const auto& beside = mesh_.neighbours[f];
            shell.is_open |= std::find(beside.begin(), beside.end(), no_index) != beside.end();
            if (!counts(f)) continue;
            shell.area += mesh_.areas[f];
            if (!is_of_side(f))
            {
                if (!is_of_rim(f)) shell.thick_area += mesh_.areas[f];
                continue;
            }
            shell.thin_area += mesh_.areas[f];
            if (!is_wet(f)) continue;
            shell.wet_area += mesh_.areas[f];
            if (is_wet_behind(f)) shell.area_of_both += mesh_.areas[f];
        }
        WetSide out;
        out.thickness = std::numeric_limits<double>::infinity();
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f)
        {
            const Shell& shell = shells[shells_.find(f)];
            if (!shell.is_wet_on_one())
            {
                // Where slabs touch edge to edge they are several pieces; those that are dry are
                // the backs of others.
                if (shell.wet_area > 0 || !shell.is_open) add(f, out.rest.soup);
            }
            else if (is_of_side(f) && is_wet(f))
            {
                add(f, out.sheet.soup);
                is_of_closed_ = is_of_closed_ && !shell.is_open;
                out.thickness = std::min(out.thickness, thickness_[f]);
                if (is_thin(f)) thickest_ = std::max(thickest_, thickness_[f]);
            }
        }
        if (out.sheet.soup.vertices.empty()) return std::nullopt;
        return out;
    }

    /// Whether sheet() is round the fluid. Where thicker slabs touch, one of them may go on behind
    /// another.
    bool holds(const std::vector<Vec3>& fluid) const
    {
        return is_around(fluid) && (is_of_closed_ || thickest_ < plate_dp * dp_);
    }

private:
    struct Shell
    {
        double area = 0; ///< m2
        double thin_area = 0;
        double thick_area = 0; ///< but for rims
        double wet_area = 0;
        double area_of_both = 0; ///< wet where the other face is wet too
        bool is_open = false;

        bool is_wet_on_one() const
        {
            return wet_area > 0 && thin_area >= least_plate * area &&
                   wet_area >= least_side * area && area_of_both <= most_else * area &&
                   thick_area <= most_else * area;
        }
    };

    /// Whether of the six ways along axes from a place in the fluid three or more first meet a wet
    /// side.
    bool is_around(const std::vector<Vec3>& fluid) const
    {
        return std::any_of(fluid.begin(), fluid.end(),
                           [&](const Vec3& p)
                           {
                               int ways = 0;
                               for (int axis = 0; axis < 3; ++axis)
                                   for (const bool is_up : {true, false})
                                       if (const auto f = facing_facet(p, axis, is_up);
                                           f && is_wet(*f))
                                           ++ways;
                               return ways >= ways_around;
                           });
    }

    bool is_thin(std::uint32_t f) const { return std::isfinite(thickness_[f]); }
    /// Thin, or where a plate is thicker, as in the corner where it bends.
    bool is_of_side(std::uint32_t f) const { return is_of_side_[f] != 0; }
    bool is_wet(std::uint32_t f) const { return is_wet_[f] != 0; }
    /// Whether the way from one facet to the other leads over an edge as the rim of a plate has:
    /// where plates cross, their rims are before others, and thin.
    bool is_round_the_rim(std::uint32_t f, std::uint32_t other) const
    {
        const Vec3& n = mesh_.normals[f];
        return dot(n, mesh_.normals[other]) < sharp && dot(n, middle(other) - middle(f)) < 0;
    }
    /// Whether a facet is as narrow as plates are thick.
    bool is_of_rim(std::uint32_t f) const
    {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, norm(mesh_.vertices[mesh_.facets[f][k]] -
                                             mesh_.vertices[mesh_.facets[f][(k + 1) % 3]]));
        return 2 * mesh_.areas[f] < thin_dp_ * dp_ * longest;
    }
    /// Facets that are not thin belong to the side that alone is beside them.
    void join_thick_parts()
    {
        std::vector<std::uint32_t> part_of(mesh_.facets.size());
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f)
        {
            part_of[f] = sides_.find(f);
            if (is_thin(f)) continue;
            std::set<std::uint32_t>& sides = beside_[part_of[f]];
            for (const std::uint32_t other : mesh_.neighbours[f])
                if (other != no_index && is_thin(other)) sides.insert(sides_.find(other));
        }
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f)
            is_of_side_[f] = is_thin(f) || beside_[part_of[f]].size() == 1 ? 1 : 0;
        for (auto part = beside_.begin(); part != beside_.end();)
        {
            const bool is_joined = part->second.size() == 1;
            if (is_joined) sides_.join(part->first, *part->second.begin());
            part = is_joined ? beside_.erase(part) : std::next(part);
        }
    }
    /// Those between several sides that are all wet, or all dry, belong to these; rims are between
    /// both.
    void join_corners()
    {
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f)
            is_wet_[f] = is_of_side(f) && wet_.contains(sides_.find(f)) ? 1 : 0;
        for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f)
        {
            const auto part = is_of_side(f) ? beside_.end() : beside_.find(sides_.find(f));
            if (part == beside_.end() || part->second.empty()) continue;
            const auto wet =
                std::count_if(part->second.begin(), part->second.end(),
                              [&](std::uint32_t side) { return wet_.contains(sides_.find(side)); });
            if (wet > 0 && wet < static_cast<std::ptrdiff_t>(part->second.size())) continue;
            is_of_side_[f] = 1;
            is_wet_[f] = wet > 0 ? 1 : 0;
        }
    }
    /// Whether the other face of the plate behind a facet is wet too.
    bool is_wet_behind(std::uint32_t f)
    {
        if (!is_thin(f)) return false;
        const Vec3 behind = middle(f) - mesh_.normals[f] * (1.5 * thickness_[f]);
        const std::uint32_t other = all_.closest_point(behind).facet;
        return other != f && shells_.find(other) == shells_.find(f) && is_thin(other) &&
               is_wet(other) && dot(mesh_.normals[other], mesh_.normals[f]) < opposite_face;
    }
    void add(std::uint32_t f, TriangleSoup& soup) const
    {
        for (const std::uint32_t v : mesh_.facets[f]) soup.vertices.push_back(mesh_.vertices[v]);
    }
    TriangleSoup thin_soup() const
    {
        TriangleSoup out;
        for (const std::uint32_t f : thin_) add(f, out);
        return out;
    }
    Vec3 middle(std::uint32_t f) const
    {
        const auto& [a, b, c] = mesh_.facets[f];
        return (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3;
    }

    /// The facet that the way from p along an axis meets first.
    std::optional<std::uint32_t> first_facet(const Vec3& p, int axis, bool is_up) const
    {
        Vec3 from = p;
        if (!is_up) from[axis] = -std::numeric_limits<float>::max();
        std::optional<std::uint32_t> out;
        for (const Crossing& c : all_.crossings(from, axis))
        {
            if (is_up) return c.facet;
            if (!(c.position < p[axis])) break;
            out = c.facet;
        }
        return out;
    }

    /// The same, if it belongs to a side of a plate, which looks to p.
    std::optional<std::uint32_t> facing_facet(const Vec3& p, int axis, bool is_up) const
    {
        const std::optional<std::uint32_t> f = first_facet(p, axis, is_up);
        return f && is_of_side(*f) && (mesh_.normals[*f][axis] < 0) == is_up ? f : std::nullopt;
    }

    /// Notes that the side of a facet is wet; where that is new, adds places before it.
    void take(std::uint32_t facet, std::vector<Vec3>& todo)
    {
        const std::uint32_t side = sides_.find(facet);
        if (!wet_.insert(side).second) return;
        for (const std::uint32_t f : looks_of_[side])
            for (const double before : {before_dp, before_dp / 4})
            {
                const Vec3 p = middle(f) + mesh_.normals[f] * (before * dp_);
                if (all_.closest_point(p).distance < 0.9 * before * dp_) continue;
                todo.push_back(p);
                break;
            }
    }

    const SurfaceMesh& mesh_;
    const std::vector<double>& thickness_;
    double thin_dp_;
    double dp_;
    int threads_;
    DisjointSet sides_;
    DisjointSet shells_;
    std::vector<char> is_of_side_;
    std::vector<char> is_wet_; ///< of facets, once find_wet() is done
    /// The parts that belong to no side, with the sides beside them.
    std::map<std::uint32_t, std::set<std::uint32_t>> beside_;
    std::vector<std::uint32_t> thin_;                              ///< the largest first
    std::map<std::uint32_t, std::vector<std::uint32_t>> looks_of_; ///< of each side, most_looks
    MeshQuery all_;
    std::set<std::uint32_t> wet_; ///< sides
    double thickest_ = 0;         ///< of the thin facets of sheet(), metres
    bool is_of_closed_ = true;    ///< sheet() is of closed shells only
};

} // namespace

std::optional<WetSide> wet_side(const ShapeMesh& shape, const LatticeGrid& grid,
                                const FitSettings& settings, int threads)
{
    if (settings.gives_sheets || (!settings.thickens && settings.sheet_depths_dp.empty()))
        return std::nullopt;
    const std::vector<Vec3>& fluid = settings.fluid_places;
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
    const double thin_dp = settings.thickens ? settings.depths_dp.back() + 0.5 : plate_dp;
    const PlateThickness thickness = plate_thickness(mesh, grid, threads, thin_dp);
    if (!thickness.is_plate) return std::nullopt;
    PlateSides sides(mesh, thickness.of_facets, thin_dp, grid.dp, threads);
    sides.find_wet(fluid);
    std::optional<WetSide> out = sides.sheet(
        [&](std::uint32_t f) { return !grid.is_2d || !lies_across(mesh.normals[f], 1); });
    if (!out || (settings.thickens && !sides.holds(fluid))) return std::nullopt;
    out->rest.is_solid = shape.is_solid;
    out->of_mesh = report.warnings;
    return out;
}

std::vector<std::string> warnings_of(const WetSide& side, const std::vector<double>& depths_dp,
                                     double dp)
{
    std::vector<std::string> out = side.of_mesh;
    out.push_back(fmt::format(
        "it is {:.3g} m thick, too thin for the rows of particles that fluid on one side of it "
        "feels: {} rows stand {}, the last {:.3g} m behind it.",
        side.thickness, depths_dp.size(),
        depths_dp.front() > 0 ? "behind that side" : "on that side and behind it",
        depths_dp.back() * dp));
    return out;
}

} // namespace fppg
