#include "lattice/flush_walls.h"

#include "core/parallel.h"

namespace fppg
{
namespace
{

/// How far behind a face it is looked whether a body goes on there, and how far that may be from
/// its facets, which are chords of round shapes, dp.
constexpr double behind_dp = 0.1;
constexpr double beside_dp = 0.05;

/// A place a step before the facet that is nearest to p.
Vec3 before_nearest_facet(const InsideTest& extent, const Vec3& p, double step)
{
    const Vec3* c = &extent.query().soup().vertices[3 * extent.query().closest_point(p).facet];
    const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
    if (!(norm(n) > 0)) return p;
    const Vec3 away = n * (step / norm(n));
    return extent.is_inside(p + away) ? p - away : p + away;
}

} // namespace

std::vector<char> flush_particles(const FittedWalls& walls, const InsideTest& extent, double dp,
                                  int threads)
{
    const WallParticles& all = walls.particles;
    const double rounding = on_face_dp * dp;
    const double step = behind_dp * dp;
    const double beside = beside_dp * dp;
    Box3 box;
    for (const Vec3& v : extent.query().soup().vertices) box.add(v);
    std::vector<char> is_on_face(all.size(), 0);
    parallel_for(
        all.size(), threads,
        [&](std::size_t i)
        {
            const FittedBody& body = walls.bodies[all.bodies[i]];
            is_on_face[i] =
                body.is_solid && !body.is_layer() && !body.is_inside &&
                box.has(all.positions[i], rounding) &&
                extent.query().closest_point(all.positions[i], rounding).distance < rounding;
        },
        1024);
    std::vector<std::vector<std::size_t>> of_body(walls.bodies.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        if (is_on_face[i]) of_body[all.bodies[i]].push_back(i);
    std::vector<char> out(all.size(), 0);
    for (std::size_t b = 0; b < of_body.size(); ++b)
    {
        if (of_body[b].empty()) continue;
        const InsideTest test(soup_of(walls.bodies[b].mesh), threads);
        test.query().prepare_nearest();
        parallel_for(
            of_body[b].size(), threads,
            [&](std::size_t k)
            {
                const std::size_t i = of_body[b][k];
                const Vec3 behind = before_nearest_facet(extent, all.positions[i], step);
                out[i] = test.is_inside(behind) ||
                         test.query().closest_point(behind, beside).distance < beside;
            },
            256);
    }
    return out;
}

} // namespace fppg
