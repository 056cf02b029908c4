#include "newcase/plan.h"

#include "core/parallel.h"
#include "core/principal_axes.h"
#include "core/transforms.h"
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
/// A surface with fewer of them is round, as a cylinder of facets.
constexpr double least_share = 0.01;
/// A part turns onto itself where half of these places are off by less than this share of its
/// size: keyways and holes may break a symmetry.
constexpr double half_within = 5e-4;

struct SurfacePlace
{
    Vec3 place;
    Vec3 normal;
};

/// Places spread evenly over the area; always the same.
std::vector<SurfacePlace> places_on(const SurfaceMesh& mesh)
{
    std::vector<double> up_to(mesh.facets.size());
    double area = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) up_to[f] = area += mesh.areas[f];
    std::vector<SurfacePlace> out(sample_count);
    for (std::size_t i = 0; i < sample_count; ++i)
    {
        const double share = (static_cast<double>(i) + 0.5) / sample_count;
        const auto at = std::upper_bound(up_to.begin(), up_to.end() - 1, share * area);
        const auto f = static_cast<std::size_t>(at - up_to.begin());
        double u = std::fmod(static_cast<double>(i) * 0.7548776662466927, 1.0);
        double v = std::fmod(static_cast<double>(i) * 0.5698402909980532, 1.0);
        if (u + v > 1)
        {
            u = 1 - u;
            v = 1 - v;
        }
        const auto& c = mesh.facets[f];
        const Vec3& a = mesh.vertices[c[0]];
        out[i] = {a + u * (mesh.vertices[c[1]] - a) + v * (mesh.vertices[c[2]] - a),
                  mesh.normals[f]};
    }
    return out;
}

/// The places that tell how far the part has turned about a line.
std::vector<Vec3> telling_places(const std::vector<SurfacePlace>& places, const AxisLine& line)
{
    std::vector<Vec3> out;
    for (const SurfacePlace& p : places)
    {
        const Vec3 along = cross(line.direction, p.place - line.point);
        const double length = norm(along);
        if (length > 0 && std::abs(dot(along, p.normal)) > least_slant * length)
            out.push_back(p.place);
    }
    return out;
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

/// Along a coordinate axis where that is nearly so: parts are modelled along them.
AxisLine tidied(AxisLine line, double size)
{
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(line.direction[axis]) > 1 - 1e-6)
        {
            line.direction = {};
            line.direction[axis] = 1;
        }
    // Of parallel axes the one that points to larger coordinates.
    for (const int axis : {2, 1, 0})
        if (std::abs(line.direction[axis]) > 0.5)
        {
            if (line.direction[axis] < 0) line.direction = -line.direction;
            break;
        }
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(line.point[axis]) < 2e-4 * size) line.point[axis] = 0;
    return line;
}

struct AxisTrial
{
    int times = 1; ///< 0: any angle
    double off = 0;
};

AxisTrial try_axis(const NewPart& part, const MeshQuery& query,
                   const std::vector<SurfacePlace>& all, const AxisLine& line)
{
    const double size = norm(part.box().max - part.box().min);
    std::vector<Vec3> places = telling_places(all, line);
    if (static_cast<double>(places.size()) < least_share * sample_count) return {0, 0};
    const std::size_t step = (places.size() + most_judged - 1) / most_judged;
    for (std::size_t i = 0; i * step < places.size(); ++i) places[i] = places[i * step];
    places.resize((places.size() + step - 1) / step);
    AxisTrial best;
    for (int times = 2; times <= most_times; ++times)
    {
        const double off = turned_off(query, places, line, 2 * std::numbers::pi / times);
        // A finer fold must fit as well as the coarse one that it may only resemble.
        if (off < half_within * size && (best.times == 1 || off < 3 * best.off + 1e-5 * size))
            best = {times, off};
    }
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
    for (std::size_t i = 0; i < 3; ++i) lines[i] = tidied({part.body.center, found.axes[i]}, size);
    parallel_for(3, threads,
                 [&](std::size_t i) { trials[i] = try_axis(part, query, places, lines[i]); });
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
