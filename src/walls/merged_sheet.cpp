#include "walls/merged_sheet.h"

#include "fppg/features.h"

#include "core/parallel.h"
#include "meshes/facing_distance.h"
#include "meshes/joined_points.h"
#include "meshes/point_grid.h"
#include "meshes/small_pieces.h"
#include "offset/middle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace fppg
{
namespace
{

constexpr double sample_dp = 0.3;
/// Of smaller facets, one in each cube of this edge is taken, dp. With 0.3, a fifth of the
/// particles between the sides of thin parts of a motorbike of 330,000 facets was missing.
constexpr double sampled_facet_dp = 0.15;
/// Cosine of what faces turn by at the rims of thin parts; at edges that turn by less, as those
/// that facets of a twisted blade make, it goes on.
constexpr double turn_at_rim = 0.5;
/// Of a line in 2D: their number is met by the distance between those that are taken in turn.
constexpr double sample_of_line_dp = 0.02;
/// Between candidates that are taken at first, and from one that is put into a hole, dp.
constexpr double first_spacing_dp = 0.92;
constexpr double hole_dp = 0.83;
/// Reach of the forces that even the sheet out, dp, and their step.
constexpr double reach_dp = 1.6;
constexpr double step_dp = 0.25;
/// Of sheets whose particles stand for dp^3, times dp.
constexpr double closest_spacing = 0.7;
constexpr double widest_spacing = 2.5;
/// Rims of thin parts are so near to their middle, of the depth up to which they are thin: the
/// diagonal of their corners.
constexpr double rim_reach = 1.5;
/// Points of gaps between layers that are no farther apart are of one patch, which has its own
/// number of particles.
constexpr double patch_dp = 1;
constexpr int rounds = 4;
constexpr int steps_a_round = 12;

class Middle
{
public:
    Middle(const WallDepth& wall, const Features& features, const MergedSheetOptions& options)
        : wall_(wall),
          options_(options),
          edges_(std::max(0.1, options.off_edges_dp) * options.dp,
                 features.edges.empty() ? 1 : 1024)
    {
        const SurfaceMesh& mesh = wall.mesh();
        has_rims_ = !options.plane_y &&
                    std::any_of(mesh.edge_facets.begin(), mesh.edge_facets.end(),
                                [](const auto& facets) { return facets[1] == no_index; });
        for (const std::uint32_t e : features.edges)
        {
            const auto [f, other] = mesh.edge_facets[e];
            // Far rims of what is drawn out along y.
            if (options.plane_y && other == no_index) continue;
            if (other != no_index && dot(mesh.normals[f], mesh.normals[other]) > turn_at_rim)
                continue;
            const Vec3& a = mesh.vertices[mesh.edges[e][0]];
            const Vec3 along = mesh.vertices[mesh.edges[e][1]] - a;
            const int parts = 1 + static_cast<int>(norm(along) / (0.2 * options.dp));
            for (int i = 0; i <= parts; ++i)
                edges_.add(a + (static_cast<double>(i) / parts) * along);
        }
    }

    /// The ball under a point of the surface, if the part is thin there or ends.
    ///
    /// normal  of the facet, unit
    std::optional<InnerBall> ball_under(const Vec3& foot, const Vec3& normal) const
    {
        return off_rims(touching_ball(wall_, foot, normal, deepest() * options_.dp));
    }

    /// The middle under a point of the surface, if the part is thin there.
    ///
    /// normal  of the facet, unit
    std::optional<MiddlePoint> under(const Vec3& foot, const Vec3& normal,
                                     std::uint32_t facet) const
    {
        const auto ball = ball_under(foot, normal);
        return ball ? at(*ball, facet) : std::nullopt;
    }

    /// The middle at the centre of a ball, if it is one.
    std::optional<MiddlePoint> at(const InnerBall& ball, std::uint32_t facet) const
    {
        const double depth_dp = ball.radius / options_.dp;
        const SheetGap* gap = gap_at(depth_dp);
        if (!ball.is_across || (depth_dp > options_.least_depth_dp && gap == nullptr) ||
            (options_.off_edges_dp > 0 &&
             edges_.has_nearer(ball.centre, options_.off_edges_dp * options_.dp)))
            return std::nullopt;
        if (gap != nullptr)
        {
            const double number = 2 * depth_dp - gap->layers;
            return MiddlePoint{ball.centre, facet, spacing_for(1 / number), number};
        }
        return MiddlePoint{ball.centre, facet, spacing_at(2 * ball.radius)};
    }

    /// A point back on the middle.
    std::optional<MiddlePoint> back(const Vec3& p) const
    {
        const DepthPlace place = wall_.at(p);
        const auto ball = off_rims(ball_through(wall_, place, p, deepest() * options_.dp));
        return ball ? at(*ball, place.facet) : std::nullopt;
    }

    /// How deep the middle may be, dp.
    double deepest() const
    {
        double out = options_.least_depth_dp;
        for (const SheetGap& gap : options_.gaps) out = std::max(out, gap.to_dp);
        return out;
    }

private:
    std::optional<InnerBall> off_rims(std::optional<InnerBall> ball) const
    {
        return ball && has_rims_ && is_at_rim(ball->centre, ball->radius) ? std::nullopt : ball;
    }

    const SheetGap* gap_at(double depth_dp) const
    {
        for (const SheetGap& gap : options_.gaps)
            if (depth_dp >= gap.from_dp && depth_dp < gap.to_dp) return &gap;
        return nullptr;
    }

    /// Whether a ball touches an open edge instead of another side.
    bool is_at_rim(const Vec3& centre, double radius) const
    {
        const DepthPlace place = wall_.at(centre);
        return place.is_beyond_rim || place.depth < 0.5 * radius;
    }

    double spacing_at(double thickness) const
    {
        if (options_.parts == 0) return 1;
        return spacing_for(options_.parts * options_.dp / thickness);
    }

    /// area  that a particle has, dp^2
    double spacing_for(double area) const
    {
        return std::clamp(options_.plane_y ? area : std::sqrt(area), closest_spacing,
                          widest_spacing);
    }

    const WallDepth& wall_;
    const MergedSheetOptions& options_;
    PointGrid edges_;
    bool has_rims_ = false;
};

/// Visits points of a facet that are `apart` from one another.
template <typename Visit>
void for_each_sample(const SurfaceMesh& mesh, std::size_t f, double apart, const Visit& visit)
{
    constexpr double sliver = 1.0 / 3;
    const auto corner = [&](std::size_t k) -> const Vec3&
    { return mesh.vertices[mesh.facets[f][k % 3]]; };
    std::size_t first = 0; // of the longest edge
    for (std::size_t k = 1; k < 3; ++k)
        if (norm(corner(k + 1) - corner(k)) > norm(corner(first + 1) - corner(first))) first = k;
    const double longest = norm(corner(first + 1) - corner(first));
    const int n = static_cast<int>(std::clamp(std::ceil(longest / apart), 1.0, 1e9));
    const double height = 2 * mesh.areas[f] / longest;
    // As many rows as a sliver is long would be far too many.
    const bool is_sliver = height < sliver * longest;
    const int rows =
        is_sliver ? static_cast<int>(std::clamp(std::ceil(height / apart), 1.0, 1e9)) : n;
    if (!is_sliver) first = 0;
    const Vec3& a = corner(first);
    const Vec3 u = corner(first + 1) - a;
    const Vec3 v = corner(first + 2) - a;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < rows; ++j)
        {
            const double s = (i + 1.0 / 3) / n, t = (j + 1.0 / 3) / rows;
            if (s + t < 1) visit(a + s * u + t * v);
        }
}

PointGrid grid_of(const std::vector<MiddlePoint>& points, double cell)
{
    PointGrid out(cell, points.size());
    for (const MiddlePoint& p : points) out.add(p.position);
    return out;
}

/// What lies under a facet where the part is thin.
struct ThinFacet
{
    std::vector<MiddlePoint> middle;
    double volume = 0; ///< above the middle, metres cubed
    /// Centres of balls that touch an edge's other face, and the volume above them: at the rims of
    /// thin parts, and along edges of thick ones.
    std::vector<std::pair<Vec3, double>> ends;
};

/// area  metres squared, that the facet stands for
ThinFacet sample_facet(std::uint32_t f, double area, const Middle& middle, const SurfaceMesh& mesh,
                       double dp)
{
    ThinFacet out;
    std::size_t samples = 0;
    for_each_sample(mesh, f, sample_dp * dp,
                    [&](const Vec3& p)
                    {
                        ++samples;
                        const auto ball = middle.ball_under(p, mesh.normals[f]);
                        if (!ball) return;
                        if (const auto at = middle.at(*ball, f))
                        {
                            out.middle.push_back(*at);
                            out.volume += ball->radius;
                        }
                        else
                            out.ends.emplace_back(ball->centre, ball->radius);
                    });
    if (samples == 0) return out;
    area /= static_cast<double>(samples);
    out.volume *= area;
    for (auto& [centre, volume] : out.ends) volume *= area;
    return out;
}

/// Along a line of the section of a 2D case, which two facets were drawn out of: the first is
/// asked.
void sample_line(std::size_t facet, const Middle& middle, const SurfaceMesh& mesh,
                 const MergedSheetOptions& options, std::vector<MiddlePoint>& out)
{
    if (facet % 2 != 0) return;
    Vec3 p = mesh.vertices[mesh.facets[facet][0]];
    Vec3 q = p;
    for (const std::uint32_t v : mesh.facets[facet])
        if (mesh.vertices[v].x != p.x || mesh.vertices[v].z != p.z) q = mesh.vertices[v];
    p.y = *options.plane_y;
    q.y = *options.plane_y;
    const int n = static_cast<int>(
        std::clamp(std::ceil(norm(q - p) / (sample_of_line_dp * options.dp)), 1.0, 1e9));
    for (int i = 0; i < n; ++i)
        if (const auto at = middle.under(p + ((i + 0.5) / n) * (q - p), mesh.normals[facet],
                                         static_cast<std::uint32_t>(facet)))
            out.push_back(*at);
}

/// Takes candidates that are at least `spacing` from all that is taken, dp, up to a number; at
/// least least_pair_dp from what keeps its place, for the others are evened out. Candidates between
/// layers are so far from it already.
void take(const std::vector<MiddlePoint>& candidates, const PointGrid& held, double spacing,
          double dp, std::size_t most, std::vector<MiddlePoint>& sheet)
{
    PointGrid grid(spacing * dp, sheet.size());
    for (const MiddlePoint& p : sheet) grid.add(p.position);
    for (const MiddlePoint& p : candidates)
    {
        if (sheet.size() >= most) break;
        const double apart = spacing * p.spacing;
        if (grid.has_nearer(p.position, apart * dp) ||
            (!p.is_in_gap() && held.has_nearer(p.position, std::max(apart, least_pair_dp) * dp)))
            continue;
        grid.add(p.position);
        sheet.push_back(p);
    }
}

/// Takes a number of candidates as far from one another as may be.
void take_number(const std::vector<MiddlePoint>& candidates, const PointGrid& taken, double dp,
                 std::size_t wanted, std::vector<MiddlePoint>& sheet)
{
    double near = 0.3, far = 2;
    for (int step = 0; step < 12; ++step)
    {
        const double spacing = 0.5 * (near + far);
        sheet.clear();
        take(candidates, taken, spacing, dp, wanted + 1, sheet);
        (sheet.size() > wanted ? near : far) = spacing;
    }
    sheet.clear();
    take(candidates, taken, far, dp, wanted, sheet);
    for (double spacing = far; sheet.size() < wanted && spacing > 0.3; spacing *= 0.97)
        take(candidates, taken, spacing, dp, wanted, sheet);
}

/// Whether a particle comes nearer than `least` to one that keeps its place, and nearer than it
/// was.
///
/// first  of those, in `grid`
bool comes_near(const PointGrid& grid, std::size_t first, const Vec3& from, const Vec3& to,
                double least)
{
    bool found = false;
    grid.for_each_near(to, least,
                       [&](std::uint32_t j, double squared)
                       {
                           const Vec3 before = from - grid.points()[j];
                           found = found || (j >= first && squared < dot(before, before));
                       });
    return found;
}

/// One step away from the neighbours, back onto the middle.
void even_out(const Middle& middle, const std::vector<Vec3>& taken, double dp, int threads,
              std::vector<MiddlePoint>& sheet)
{
    const double reach = reach_dp * dp;
    PointGrid grid(reach, taken.size() + sheet.size());
    for (const MiddlePoint& p : sheet) grid.add(p.position);
    for (const Vec3& p : taken) grid.add(p);
    std::vector<MiddlePoint> moved = sheet;
    parallel_for(
        sheet.size(), threads,
        [&](std::size_t i)
        {
            Vec3 force;
            const double own = reach * sheet[i].spacing;
            grid.for_each_near(sheet[i].position, own,
                               [&](std::uint32_t j, double squared)
                               {
                                   if (j == i || !(squared > 0)) return;
                                   const double r = std::sqrt(squared);
                                   const double s = 1 - r / own;
                                   force = force +
                                           (s * s * s / r) * (sheet[i].position - grid.points()[j]);
                               });
            const double size = norm(force);
            const double most = 0.1;
            const Vec3 step = (size > most ? most / size : 1) * step_dp * 4 * dp * force;
            const auto at = middle.back(sheet[i].position + step);
            if (at && !comes_near(grid, sheet.size(), sheet[i].position, at->position,
                                  least_pair_dp * dp))
                moved[i] = *at;
        },
        64);
    sheet = std::move(moved);
}

/// Particles spread evenly over points of the middle.
///
/// wanted  their number; empty: as many as there is room for
std::vector<MiddlePoint> fill_sheet(const Middle& middle, const std::vector<MiddlePoint>& points,
                                    const std::vector<Vec3>& taken,
                                    std::optional<std::size_t> wanted,
                                    const MergedSheetOptions& options, int threads)
{
    constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
    const PointGrid held = grid_of(taken, options.dp);
    std::vector<MiddlePoint> sheet;
    if (wanted)
        take_number(points, held, options.dp, *wanted, sheet);
    else
        take(points, held, first_spacing_dp, options.dp, no_limit, sheet);
    for (int round = 0; round < (options.evens_out ? rounds : 0); ++round)
    {
        for (int step = 0; step < steps_a_round; ++step)
            even_out(middle, taken, options.dp, threads, sheet);
        if (!wanted) take(points, held, hole_dp, options.dp, no_limit, sheet);
    }
    return sheet;
}

/// Points of a gap that are joined.
struct GapPatch
{
    std::vector<MiddlePoint> points;
    std::vector<double> numbers; ///< of settle_numbers()
    /// Of the sheet, the particle that was nearest to each point; no_index: it is not known.
    std::vector<std::uint32_t> nearest;
};

/// How many particles each point of a gap stands for: of what layers lack there. A point has an
/// even share of a disk around it (2D: of a piece of the line). Points too near to a layer for a
/// particle go.
void settle_numbers(const PointGrid& taken, double dp, bool is_2d, int threads, GapPatch& patch)
{
    constexpr double disk_dp = 0.45;
    const double room = is_2d ? 2 * disk_dp : std::numbers::pi * disk_dp * disk_dp;
    const PointGrid all = grid_of(patch.points, disk_dp * dp);
    std::vector<int> in_disk(patch.points.size(), 0);
    parallel_for(
        patch.points.size(), threads,
        [&](std::size_t k)
        {
            const Vec3& p = patch.points[k].position;
            if (!taken.has_nearer(p, least_pair_dp * dp))
                all.for_each_near(p, disk_dp * dp, [&](std::uint32_t, double) { ++in_disk[k]; });
        },
        256);
    std::vector<MiddlePoint> free;
    for (std::size_t k = 0; k < in_disk.size(); ++k)
    {
        if (in_disk[k] == 0) continue;
        free.push_back(patch.points[k]);
        patch.numbers.push_back(patch.points[k].number * room / in_disk[k]);
    }
    patch.points = std::move(free);
}

/// Moves each particle of a sheet in a gap to the middle of the points that are nearest to it, as
/// by Lloyd. Weights by the square of what a point lacks make particles as dense as they are
/// wanted; with forces between them they leave the middle of the patch for its ends.
void centre(const Middle& middle, GapPatch& patch, const PointGrid& taken,
            const MergedSheetOptions& options, int threads, std::vector<MiddlePoint>& sheet)
{
    const std::vector<MiddlePoint>& points = patch.points;
    const double near = first_spacing_dp * options.dp; // most points have one so near
    const PointGrid grid = grid_of(sheet, near);
    patch.nearest.resize(points.size(), no_index);
    std::vector<std::uint32_t>& nearest = patch.nearest;
    parallel_for(
        points.size(), threads,
        [&](std::size_t k)
        {
            const Vec3& p = points[k].position;
            double reach = near;
            if (nearest[k] != no_index) // it has hardly moved
                reach = std::min(reach, norm(p - sheet[nearest[k]].position) * (1 + 1e-9));
            auto found = grid.nearest(p, reach);
            if (!found) found = grid.nearest(p, widest_spacing * options.dp);
            nearest[k] = found.value_or(no_index);
        },
        256);
    struct Sum
    {
        Vec3 places;
        double weights = 0;
    };
    std::vector<Sum> sums(sheet.size());
    for (std::size_t k = 0; k < points.size(); ++k)
    {
        if (nearest[k] == no_index) continue;
        Sum& sum = sums[nearest[k]];
        const double weight = points[k].number * patch.numbers[k];
        sum.places = sum.places + weight * points[k].position;
        sum.weights += weight;
    }
    const double least_pair = least_pair_dp * options.dp;
    parallel_for(
        sheet.size(), threads,
        [&](std::size_t i)
        {
            if (!(sums[i].weights > 0)) return;
            const auto at = middle.back(sums[i].places / sums[i].weights);
            if (at && !comes_near(taken, 0, sheet[i].position, at->position, least_pair))
                sheet[i] = *at;
        },
        64);
}

/// As many particles in a patch of a gap as it lacks.
std::vector<MiddlePoint> fill_gap(const Middle& middle, GapPatch& patch, const PointGrid& taken,
                                  const MergedSheetOptions& options, int threads)
{
    settle_numbers(taken, options.dp, options.plane_y.has_value(), threads, patch);
    const auto wanted = static_cast<std::size_t>(
        std::lround(std::accumulate(patch.numbers.begin(), patch.numbers.end(), 0.0)));
    std::vector<MiddlePoint> sheet;
    if (wanted == 0) return sheet;
    take_number(patch.points, taken, options.dp, wanted, sheet);
    for (int step = 0; step < steps_a_round; ++step)
        centre(middle, patch, taken, options, threads, sheet);
    return sheet;
}

/// The points of gaps, patch by patch: those of a large one must not lose their number to many that
/// are too small for a particle.
std::vector<GapPatch> patches_of(const std::vector<MiddlePoint>& points, double dp)
{
    std::vector<Vec3> places;
    for (const MiddlePoint& p : points) places.push_back(p.position);
    DisjointSet sets = joined_within(places, patch_dp * dp);
    std::vector<GapPatch> out;
    std::vector<std::size_t> patch_of(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
    {
        const std::uint32_t first = sets.find(i);
        if (first == i)
        {
            patch_of[i] = out.size();
            out.emplace_back();
        }
        out[patch_of[first]].points.push_back(points[i]);
    }
    return out;
}

} // namespace

ThinParts find_thin_parts(const WallDepth& wall, const Features& features,
                          const MergedSheetOptions& options, int threads)
{
    const Middle middle(wall, features, options);
    const SurfaceMesh& mesh = wall.mesh();
    std::vector<ThinFacet> of_facet(mesh.facets.size());
    if (options.plane_y)
        parallel_for(
            of_facet.size(), threads,
            [&](std::size_t f) { sample_line(f, middle, mesh, options, of_facet[f].middle); }, 16);
    else
    {
        const std::vector<AskedFacet> asked =
            facets_to_ask(mesh, sampled_facet_dp * options.dp, threads);
        parallel_for(
            asked.size(), threads,
            [&](std::size_t i)
            {
                const auto& [facet, area] = asked[i];
                of_facet[facet] = sample_facet(facet, area, middle, mesh, options.dp);
            },
            16);
    }
    ThinParts out;
    for (const ThinFacet& facet : of_facet)
    {
        out.middle.insert(out.middle.end(), facet.middle.begin(), facet.middle.end());
        out.volume += facet.volume;
    }
    if (out.middle.empty()) return out;
    const double reach = rim_reach * middle.deepest() * options.dp;
    const PointGrid grid = grid_of(out.middle, reach);
    for (const ThinFacet& facet : of_facet)
        for (const auto& [centre, volume] : facet.ends)
            if (grid.has_nearer(centre, reach)) out.volume += volume;
    return out;
}

std::vector<double> sample_thickness(const WallDepth& wall, double most, std::size_t count,
                                     std::optional<double> plane_y, int threads)
{
    const SurfaceMesh& mesh = wall.mesh();
    const std::vector<FacetSpot> points = even_places(mesh, count);
    std::vector<double> out(count, 0);
    parallel_for(
        points.size(), threads,
        [&](std::size_t i)
        {
            Vec3 p = points[i].place;
            if (plane_y) p.y = *plane_y;
            if (const auto ball = inner_ball(wall, p, mesh.normals[points[i].facet], 0.5 * most))
                out[i] = 2 * ball->radius;
        },
        16);
    return out;
}

double samples_of_thin_parts(const SurfaceMesh& mesh, double dp, int threads)
{
    double out = 0;
    for (const AskedFacet& asked : facets_to_ask(mesh, sampled_facet_dp * dp, threads))
        for_each_sample(mesh, asked.facet, sample_dp * dp, [&](const Vec3&) { ++out; });
    return out;
}

SurfaceParticles merged_sheet(const WallDepth& wall, const Features& features,
                              const std::vector<MiddlePoint>& points,
                              const std::vector<Vec3>& taken, const MergedSheetOptions& options,
                              int threads)
{
    const Middle middle(wall, features, options);
    std::vector<MiddlePoint> of_both, in_gaps;
    for (const MiddlePoint& p : points) (p.is_in_gap() ? in_gaps : of_both).push_back(p);
    std::vector<MiddlePoint> sheet =
        fill_sheet(middle, of_both, taken, options.wanted, options, threads);
    PointGrid all = grid_of(taken, options.dp);
    for (const MiddlePoint& p : sheet) all.add(p.position);
    for (GapPatch& patch : patches_of(in_gaps, options.dp))
        for (const MiddlePoint& p : fill_gap(middle, patch, all, options, threads))
        {
            // Where the number has no room, and where two came near to one another in one step.
            if (all.has_nearer(p.position, least_pair_dp * options.dp)) continue;
            all.add(p.position);
            sheet.push_back(p);
        }
    SurfaceParticles out;
    for (const MiddlePoint& p : sheet)
    {
        out.positions.push_back(p.position);
        out.kinds.push_back(FitKind::Surface);
        out.facets.push_back(p.facet);
    }
    return out;
}

} // namespace fppg
