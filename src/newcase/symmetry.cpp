#include "newcase/plan.h"

#include "core/parallel.h"
#include "core/principal_axes.h"
#include "core/transforms.h"
#include "meshes/facing_distance.h"
#include "meshes/mesh_query.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fppg
{

namespace
{

constexpr std::size_t sample_count = 4000;
constexpr std::size_t most_judged = 300;
constexpr int most_times = 120; ///< teeth and the like
/// Only places whose normal has such a part along the turn tell how far a part has turned.
constexpr double least_slant = 0.2;
/// A surface with fewer of them, of all places that do not look along the axis, is round, as a
/// cylinder of facets.
constexpr double least_share = 0.01;
/// And so is one with fewer than this that has no other symmetry: a shaft with its keyway.
constexpr double round_share = 0.12;
/// Parts are modelled along the axes of coordinates: nearer than 3 degrees, those are tried.
constexpr double nearly_along = 0.9986;
/// A part turns onto itself where half of these places are off by less than this share of its
/// size: keyways and holes may break a symmetry.
constexpr double half_within = 2e-3;

struct SurfacePlace
{
    Vec3 place;
    Vec3 normal;
};

/// Places spread evenly over the area; always the same.
std::vector<SurfacePlace> places_on(const SurfaceMesh& mesh)
{
    std::vector<SurfacePlace> out;
    for (const FacetSpot& spot : even_places(mesh, sample_count))
        out.push_back({spot.place, mesh.normals[spot.facet]});
    return out;
}

/// What of the surface tells how far the part has turned about a line.
struct TellingPlaces
{
    std::vector<Vec3> places;
    std::vector<Vec3> others; ///< of what does not look along the axis
    double share = 0;         ///< of all places that do not look along the axis
};

TellingPlaces telling_places(const std::vector<SurfacePlace>& places, const AxisLine& line)
{
    TellingPlaces out;
    std::size_t sideways = 0;
    for (const SurfacePlace& p : places)
    {
        if (std::abs(dot(line.direction, p.normal)) > 0.9) continue;
        ++sideways;
        const Vec3 along = cross(line.direction, p.place - line.point);
        const double length = norm(along);
        if (length > 0 && std::abs(dot(along, p.normal)) > least_slant * length)
            out.places.push_back(p.place);
        else
            out.others.push_back(p.place);
    }
    out.share =
        sideways == 0 ? 0 : static_cast<double>(out.places.size()) / static_cast<double>(sideways);
    return out;
}

/// The point through which an axis of this direction passes: normals of round surfaces meet it,
/// (p - c) . (n x d) = 0. What is far from doing so, such as a keyway, counts less from step to
/// step.
Vec3 point_on_axis(const std::vector<SurfacePlace>& places, const Vec3& direction, Vec3 from,
                   double size)
{
    double scale = size;
    for (int step = 0; step < 30; ++step)
    {
        std::array<Vec3, 3> matrix{};
        Vec3 right;
        for (const SurfacePlace& p : places)
        {
            const Vec3 across = cross(p.normal, direction);
            const double off = dot(p.place - from, across);
            const double weight = 1 / (1 + off * off / (scale * scale));
            for (int i = 0; i < 3; ++i)
                matrix[static_cast<std::size_t>(i)] =
                    matrix[static_cast<std::size_t>(i)] + (weight * across[i]) * across;
            right = right + (weight * off) * across;
        }
        const PrincipalAxes found = principal_axes(matrix);
        const double largest = std::max({found.values.x, found.values.y, found.values.z});
        for (int i = 0; i < 3; ++i)
        {
            const Vec3& way = found.axes[static_cast<std::size_t>(i)];
            if (found.values[i] > 1e-3 * largest)
                from = from + (dot(way, right) / found.values[i]) * way;
        }
        scale = std::max(scale / 2, 1e-3 * size);
    }
    return from;
}

/// How far half of the places are from the surface at most when it is turned, metres.
double turned_off(const MeshQuery& query, const std::vector<Vec3>& places, const AxisLine& line,
                  double angle)
{
    const Transform turn = around(line.point, rotation(line.direction, angle));
    std::vector<double> off(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        off[i] = query.closest_point(turn(places[i])).distance;
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2),
                     off.end());
    return off[off.size() / 2];
}

/// The shortest number within a distance of a value.
double shortest_near(double value, double within)
{
    for (int digits = 1; digits < 12; ++digits)
    {
        const double rounded = round_nearest(value, digits);
        if (std::abs(rounded - value) <= within) return rounded;
    }
    return value;
}

/// The same line, as a person would write it: of parallel ones that which points to larger
/// coordinates, its numbers rounded.
AxisLine tidied(AxisLine line, double within)
{
    for (const int axis : {2, 1, 0})
        if (std::abs(line.direction[axis]) > 0.5)
        {
            if (line.direction[axis] < 0) line.direction = -line.direction;
            break;
        }
    for (int axis = 0; axis < 3; ++axis)
    {
        const double value = line.point[axis];
        line.point[axis] = std::abs(value) <= within || line.direction[axis] == 1
                               ? 0
                               : shortest_near(value, within);
    }
    return line;
}

struct AxisTrial
{
    int times = 1; ///< 0: any angle
    double off = 0;
};

/// Some hundreds of places, evenly.
std::vector<Vec3> some_of(const std::vector<Vec3>& places)
{
    std::vector<Vec3> out;
    const std::size_t step = (places.size() + most_judged - 1) / most_judged;
    for (std::size_t i = 0; i < places.size(); i += step) out.push_back(places[i]);
    return out;
}

AxisTrial try_axis(const NewPart& part, const MeshQuery& query,
                   const std::vector<SurfacePlace>& all, const AxisLine& line)
{
    const double size = norm(part.box().max - part.box().min);
    const TellingPlaces telling = telling_places(all, line);
    // A golden part of a turn is near no other one.
    constexpr double golden = 2 * std::numbers::pi * 0.3819660112501051;
    const auto round = [&]() -> AxisTrial
    {
        if (telling.others.empty()) return {0, 0};
        return {0, turned_off(query, some_of(telling.others), line, golden)};
    };
    if (telling.share < least_share) return round();
    const std::vector<Vec3> places = some_of(telling.places);
    AxisTrial best;
    for (int times = 2; times <= most_times; ++times)
    {
        const double off = turned_off(query, places, line, 2 * std::numbers::pi / times);
        // A finer fold must fit as well as the coarse one that it may only resemble.
        if (off < half_within * size && (best.times == 1 || off < 3 * best.off + 1e-5 * size))
            best = {times, off};
    }
    if (best.times == 1 && telling.share < round_share) return round();
    return best;
}

std::optional<SymmetryAxis> find_symmetry(const NewPart& part, int threads)
{
    if (!(part.body.volume > 0)) return std::nullopt;
    const PrincipalAxes found = principal_axes(part.body.inertia);
    const MeshQuery query(part.tree->soup(), threads);
    const std::vector<SurfacePlace> places = places_on(part.mesh);
    const double size = norm(part.box().max - part.box().min);
    std::array<AxisTrial, 3> trials;
    std::array<AxisLine, 3> lines;
    parallel_for(3, threads,
                 [&](std::size_t i)
                 {
                     AxisLine line{part.body.center, found.axes[i]};
                     for (int axis = 0; axis < 3; ++axis)
                         if (std::abs(line.direction[axis]) > nearly_along)
                         {
                             line.direction = {};
                             line.direction[axis] = 1;
                         }
                     // The centre of mass of a part with teeth is on its axis, to rounding; a
                     // keyway draws it off.
                     const AxisLine central = tidied(line, 1e-6 * size);
                     trials[i] = try_axis(part, query, places, central);
                     lines[i] = central;
                     if (trials[i].times > 1) return;
                     line.point = point_on_axis(places, line.direction, line.point, size);
                     const AxisLine fitted = tidied(line, 5e-5 * size);
                     const AxisTrial trial = try_axis(part, query, places, fitted);
                     if (trials[i].times == 0 && !(2 * trial.off < trials[i].off)) return;
                     lines[i] = fitted;
                     trials[i] = trial;
                 });
    const auto rank = [](const AxisTrial& t) { return t.times == 0 ? 1000 : t.times; };
    std::size_t best = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (rank(trials[i]) > rank(trials[best])) best = i;
    if (rank(trials[best]) < 2) return std::nullopt;
    // A cube, a ball, a box: several axes are as good.
    for (std::size_t i = 0; i < 3; ++i)
        if (i != best && rank(trials[i]) == rank(trials[best])) return std::nullopt;
    return SymmetryAxis{lines[best], trials[best].times, trials[best].off};
}

} // namespace

const std::optional<SymmetryAxis>& symmetry_of(NewPart& part, int threads)
{
    if (!part.knows_symmetry) part.symmetry = find_symmetry(part, threads);
    part.knows_symmetry = true;
    return part.symmetry;
}

} // namespace fppg
