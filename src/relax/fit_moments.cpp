#include "relax/fit_moments.h"

#include "core/parallel.h"
#include "core/principal_axes.h"
#include "fit/wall_section.h"
#include "meshes/crowded_points.h"
#include "offset/wall_depth.h"
#include "relax/part_pairs.h"
#include "relax/sliding_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace fppg
{
namespace
{

using Matrix = std::array<Vec3, 3>;

constexpr int most_rounds = 12;
/// No particle moves farther, dp, or than this share of the body's size about its centre.
constexpr double longest_way_dp = 0.75;
constexpr double most_stretch = 0.03;
constexpr double most_jump_dp = 0.02;
/// Of the centre, dp, and of the second moments where fitting ends.
constexpr double centre_tolerance = 1e-3;
constexpr double moment_tolerance = 2e-4;
/// Bodies whose particles have another volume by more are cut.
constexpr double whole = 0.03;
/// Parts of those whose facets bound another volume by more overlap.
constexpr double overlapping = 0.005;
/// Particles come so far apart where there is room, dp; else least_pair_dp.
constexpr double even_pair_dp = 0.75;
/// So often particles are parted and moments fitted in turn.
constexpr int passes_apart = 4;
/// Those of the volume that give way stay so far behind the surface, dp.
constexpr double keeps_depth_dp = 0.5;

/// Centre and second moments about it, per volume.
struct Moments
{
    double volume = 0;
    Vec3 centre;
    Matrix second{};
};

void add_product(Matrix& to, double factor, const Vec3& a, const Vec3& b)
{
    for (int i = 0; i < 3; ++i)
        to[static_cast<std::size_t>(i)] = to[static_cast<std::size_t>(i)] + (factor * a[i]) * b;
}

/// sums     the volume, and the integrals of what is off `origin` and of its products
/// per_sum  of the volume
Moments about_centre(const Moments& sums, const Vec3& origin, double per_sum)
{
    Moments out;
    const Vec3 mean = sums.centre / sums.volume;
    out.volume = per_sum * sums.volume;
    out.centre = origin + mean;
    out.second = sums.second;
    for (Vec3& row : out.second) row = row / sums.volume;
    add_product(out.second, -1, mean, mean);
    return out;
}

/// Of the inside of a closed mesh, by tetrahedra from a point near it.
Moments moments_of(const SurfaceMesh& mesh)
{
    Moments sums;
    const Vec3 origin = mesh.vertices[0];
    for (const auto& f : mesh.facets)
    {
        const Vec3 a = mesh.vertices[f[0]] - origin;
        const Vec3 b = mesh.vertices[f[1]] - origin;
        const Vec3 c = mesh.vertices[f[2]] - origin;
        const double six = dot(a, cross(b, c));
        const Vec3 all = a + b + c;
        sums.volume += six / 6;
        sums.centre = sums.centre + (six / 24) * all;
        for (const Vec3& v : {all, a, b, c}) add_product(sums.second, six / 120, v, v);
    }
    return about_centre(sums, origin, 1);
}

/// Of the section of a closed mesh with a plane y = constant, by triangles from a point near it;
/// its area counts dp thick.
Moments moments_of_section(const SurfaceMesh& mesh, const LatticeGrid& grid)
{
    const WallSection section = wall_section(mesh, grid.origin.y);
    if (section.lengths.empty()) return {};
    const Vec3 origin = section.soup.vertices[0];
    Moments sums;
    for (std::size_t i = 0; i < section.lengths.size(); ++i)
    {
        const Vec3 a = section.soup.vertices[3 * i] - origin;
        const Vec3 b = section.soup.vertices[3 * i + 1] - origin;
        const double twice = dot(section.normals[i], a) * section.lengths[i];
        sums.volume += twice / 2;
        sums.centre = sums.centre + (twice / 6) * (a + b);
        for (const Vec3& v : {a + b, a, b}) add_product(sums.second, twice / 24, v, v);
    }
    return about_centre(sums, origin, grid.dp);
}

Vec3 times(const Matrix& m, const Vec3& v)
{
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

/// The symmetric M with M S + S M = D, but for directions in which S has less than `least`.
Matrix stretch_for(const Matrix& s, const Matrix& d, double least)
{
    const PrincipalAxes of = principal_axes(s);
    Matrix out{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
        {
            const double si = of.values[i], sj = of.values[j];
            if (std::min(si, sj) < least) continue;
            const Vec3& a = of.axes[static_cast<std::size_t>(i)];
            const Vec3& b = of.axes[static_cast<std::size_t>(j)];
            add_product(out, dot(a, times(d, b)) / (si + sj), a, b);
        }
    return out;
}

class MomentFit
{
public:
    MomentFit(RunField& field, std::size_t body, const AllWalls& all, int threads)
        : field_(field), body_(body), all_(all), threads_(threads), dp_(field.grid.dp)
    {
    }

    void run()
    {
        const FittedWalls& walls = field_.walls;
        const FittedBody& body = walls.bodies[body_];
        if (!body.is_inside || body.is_layer() || is_cut()) return;
        collect();
        const double dp3 = dp_ * dp_ * dp_;
        shape_ =
            field_.grid.is_2d ? moments_of_section(body.mesh, field_.grid) : moments_of(body.mesh);
        spread();
        if (std::abs(static_cast<double>(count()) * dp3 / body.measures.volume - 1) > whole ||
            std::abs(shape_.volume / body.measures.volume - 1) > overlapping)
            return put_distances();
        const std::vector<Vec3> start = places();
        for (int pass = 0; pass < passes_apart && !fit(even_pair_dp); ++pass) spread();
        // What moments cannot have with room between all they have without.
        for (const double apart : {0.7, 0.65, least_pair_dp})
        {
            if (best_.misfit <= 1) break;
            put(start);
            std::fill(way_.begin(), way_.end(), Vec3{});
            fit(apart);
        }
        put(best_.places);
        put_distances();
    }

private:
    bool is_cut() const
    {
        const FittedWalls& walls = field_.walls;
        if (walls.bodies[body_].measures.kept < 1) return true;
        return std::any_of(walls.cut_bodies.begin(), walls.cut_bodies.end(),
                           [&](std::uint32_t b)
                           { return b == body_ || walls.bodies[b].owner == body_; });
    }

    void collect()
    {
        const FittedWalls& walls = field_.walls;
        std::vector<char> is_own(65536, 0);
        is_own[walls.bodies[body_].mk] = 1;
        for (const std::uint16_t mk : walls.bodies[body_].facet_mk) is_own[mk] = 1;
        std::size_t alike = 0;
        for (const FittedBody& other : walls.bodies)
            if (!other.is_layer() && is_own[other.mk] != 0) ++alike;
        const auto is_mine = [&](const Vec3& p)
        { return alike == 1 || all_.closest(p).body == body_; };
        for (std::uint32_t i = 0; i < walls.particles.size(); ++i)
        {
            const std::uint32_t b = walls.particles.bodies[i];
            if (b == body_ || walls.bodies[b].owner == body_) of_wall_.push_back(i);
        }
        for (std::uint32_t i = 0; i < walls.volume.size(); ++i)
            if (is_own[walls.volume.mk[i]] != 0 && is_mine(walls.volume.positions[i]))
                of_volume_.push_back(i);
        for (std::uint32_t x = 0; x < field_.slabs.size(); ++x)
            for (const Run& run : field_.slabs[x])
            {
                if (run.is_covered || is_own[run.mk] == 0) continue;
                for (std::uint32_t z = run.z_begin; z < run.z_end; ++z)
                {
                    const Vec3 p = place_of({x, run.y, z}, field_.grid);
                    if (is_mine(p)) nodes_.push_back(p);
                }
            }
        way_.resize(of_wall_.size() + of_volume_.size());
    }

    bool is_2d() const { return field_.grid.is_2d; }

    std::size_t count() const { return of_wall_.size() + of_volume_.size() + nodes_.size(); }

    Vec3& place(std::size_t i)
    {
        FittedWalls& walls = field_.walls;
        return i < of_wall_.size() ? walls.particles.positions[of_wall_[i]]
                                   : walls.volume.positions[of_volume_[i - of_wall_.size()]];
    }

    /// The way across the sheets of a plate; zero elsewhere.
    Vec3 across(std::size_t i)
    {
        const FittedWalls& walls = field_.walls;
        if (walls.bodies[body_].sheets == 0 || i >= of_wall_.size()) return {};
        const std::uint32_t p = of_wall_[i];
        return walls.bodies[walls.particles.bodies[p]]
            .wall->at(walls.particles.positions[p])
            .direction;
    }

    Moments moments_of_particles()
    {
        Moments out;
        const std::size_t moving = way_.size();
        Vec3 sum;
        for (std::size_t i = 0; i < moving; ++i) sum = sum + (place(i) - shape_.centre);
        for (const Vec3& p : nodes_) sum = sum + (p - shape_.centre);
        const auto n = static_cast<double>(count());
        out.centre = shape_.centre + sum / n;
        const FittedBody& body = field_.walls.bodies[body_];
        const double step = body.sheets > 0 ? body.thickness / body.sheets : dp_;
        const double area = dp_ * dp_ * dp_ / step; // of a particle in its sheet
        const double along = (is_2d() ? area * area / (dp_ * dp_) : area) / 12;
        for (std::size_t i = 0; i < moving; ++i)
        {
            const Vec3 d = place(i) - out.centre;
            add_product(out.second, 1 / n, d, d);
            const Vec3 normal = across(i);
            add_product(out.second, (step * step / 12 - along) / n, normal, normal);
        }
        for (const Vec3& p : nodes_)
        {
            const Vec3 d = p - out.centre;
            add_product(out.second, 1 / n, d, d);
        }
        for (int i = 0; i < 3; i += is_2d() ? 2 : 1)
            out.second[static_cast<std::size_t>(i)][i] += along;
        return out;
    }

    /// The distance of each particle that moves to the nearest other one, at most dp.
    std::vector<double> nearest()
    {
        std::vector<Vec3> all = places();
        all.insert(all.end(), nodes_.begin(), nodes_.end());
        std::vector<double> distances = nearest_distances(all, dp_, threads_);
        distances.resize(way_.size());
        return distances;
    }

    /// Of those that move.
    std::vector<Vec3> places()
    {
        std::vector<Vec3> out;
        for (std::size_t i = 0; i < way_.size(); ++i) out.push_back(place(i));
        return out;
    }

    void put(const std::vector<Vec3>& places)
    {
        for (std::size_t i = 0; i < way_.size(); ++i) place(i) = in_plane(places[i]);
    }

    /// In 2D y stays exactly that of the plane.
    Vec3 in_plane(const Vec3& p) const
    {
        return is_2d() ? Vec3{p.x, field_.grid.origin.y, p.z} : p;
    }

    /// Moves all until the moments are met, none nearer to others than a distance, dp; false where
    /// they are not. The best that was found is kept in best_.
    bool fit(double apart_dp)
    {
        apart_ = apart_dp * dp_;
        for (int round = 0; round < most_rounds && move(); ++round)
        {
        }
        Matrix off{};
        const double misfit = misfit_of(moments_of_particles(), off);
        if (misfit < best_.misfit) best_ = {misfit, places()};
        return misfit <= 1;
    }

    /// Parts particles that are too near to others, those of layers along these.
    void spread()
    {
        std::vector<Vec3> all = places();
        all.insert(all.end(), nodes_.begin(), nodes_.end());
        part_pairs(
            all, way_.size(), even_pair_dp * dp_,
            [&](std::size_t i, const Vec3& from, const Vec3& to) {
                return i < of_wall_.size() ? beside_on_layer(i, from, to) : beside_inside(from, to);
            },
            threads_);
        put(all);
    }

    /// Puts particles back that came nearer to others than they may, until there are none.
    void part(const std::vector<double>& distances, const std::vector<Vec3>& before)
    {
        for (int round = 0; round < most_rounds; ++round)
        {
            const std::vector<double> now = nearest();
            bool is_near = false;
            for (std::size_t i = 0; i < way_.size(); ++i)
            {
                if (now[i] >= std::min(distances[i], apart_) * (1 - 1e-9)) continue;
                is_near = true;
                place(i) = before[i];
            }
            if (!is_near) return;
        }
        for (std::size_t i = 0; i < way_.size(); ++i) place(i) = before[i];
    }

    /// Moves all by `steps`, those of layers along these.
    void take(const std::vector<Vec3>& steps)
    {
        const std::vector<double> distances = nearest();
        std::vector<Vec3> before(way_.size());
        parallel_for(
            way_.size(), threads_,
            [&](std::size_t i)
            {
                before[i] = place(i);
                const Vec3 normal = across(i);
                const Vec3 to = before[i] + (steps[i] - dot(steps[i], normal) * normal);
                place(i) = in_plane(i < of_wall_.size() ? beside_on_layer(i, before[i], to) : to);
            },
            64);
        part(distances, before);
        for (std::size_t i = 0; i < way_.size(); ++i) way_[i] = way_[i] + (place(i) - before[i]);
    }

    /// How far moments are from those of the shape, in tolerances; `off`: what the second ones
    /// lack.
    double misfit_of(const Moments& now, Matrix& off) const
    {
        double worst = 0, size = 0;
        for (std::size_t i = 0; i < 3; ++i)
        {
            off[i] = shape_.second[i] - now.second[i];
            size = std::max(size, shape_.second[i][static_cast<int>(i)]);
            for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(off[i][j]));
        }
        return std::max(norm(shape_.centre - now.centre) / (centre_tolerance * dp_),
                        worst / (moment_tolerance * size));
    }

    /// One step; false where it is not needed or leads too far.
    bool move()
    {
        const Moments now = moments_of_particles();
        const Vec3 shift = shape_.centre - now.centre;
        Matrix off{};
        if (misfit_of(now, off) < 1) return false;
        const Matrix stretch = stretch_for(now.second, off, 0.25 * dp_ * dp_);
        std::vector<Vec3> steps(way_.size());
        double longest = 0, size = 0;
        for (std::size_t i = 0; i < way_.size(); ++i)
        {
            size = std::max(size, norm(place(i) - now.centre));
            steps[i] = shift + times(stretch, place(i) - now.centre);
            longest = std::max(longest, norm(way_[i] + steps[i]));
        }
        const double most = std::max(longest_way_dp * dp_, most_stretch * size);
        double share = 1;
        if (longest > most)
        {
            double before = 0, step = 0;
            for (std::size_t i = 0; i < way_.size(); ++i)
            {
                before = std::max(before, norm(way_[i]));
                step = std::max(step, norm(steps[i]));
            }
            share = (most - before) / step;
            if (share < 0.05) return false;
        }
        for (Vec3& step : steps) step = share * step;
        take(steps);
        return true;
    }

    /// The place on its layer that a particle may have near to another.
    Vec3 beside_on_layer(std::size_t i, const Vec3& from, const Vec3& to) const
    {
        const FittedWalls& walls = field_.walls;
        const std::uint32_t particle = of_wall_[i];
        const bool is_free = walls.bodies[walls.particles.bodies[particle]].mesh.facets.empty() &&
                             walls.bodies[body_].sheets == 0;
        if (is_free) return to;
        const Vec3 on =
            put_back(walls, particle, to, dp_,
                     [&](const Vec3& p, double within) { return all_.closest_point(p, within); });
        // Where layers bend within dp the nearest place may be on another face.
        return norm(on - from) > 2 * norm(to - from) + most_jump_dp * dp_ ? from : on;
    }

    /// The place behind the surface that a particle of the volume may have near to another.
    Vec3 beside_inside(const Vec3& from, const Vec3& to) const
    {
        const double depth = keeps_depth_dp * dp_;
        const AllWalls::Closest near = all_.closest(to, depth);
        if (!(near.distance < depth)) return to;
        const Vec3 away = from - near.point;
        const double was = norm(away);
        if (near.distance >= was || was == 0) return to;
        const Vec3 along = to - (dot(to - from, away) / (was * was)) * away;
        const double least = std::min(was, depth) * (1 - 1e-3);
        return all_.closest(along, depth).distance >= least ? along : from;
    }

    void put_distances()
    {
        VolumeParticles& volume = field_.walls.volume;
        parallel_for(
            of_volume_.size(), threads_,
            [&](std::size_t i)
            {
                const std::uint32_t v = of_volume_[i];
                volume.distances[v] =
                    static_cast<float>(-all_.closest(volume.positions[v]).distance);
            },
            256);
    }

    RunField& field_;
    std::size_t body_;
    const AllWalls& all_;
    int threads_;
    double dp_;
    double apart_ = 0; ///< no pair comes nearer than this by fitting, metres
    Moments shape_;
    std::vector<std::uint32_t> of_wall_;
    std::vector<std::uint32_t> of_volume_;
    std::vector<Vec3> nodes_;
    std::vector<Vec3> way_; ///< of walls, then of volume particles
    struct Best
    {
        double misfit = std::numeric_limits<double>::infinity();
        std::vector<Vec3> places;
    };
    Best best_;
};

} // namespace

void fit_moments(RunField& field, std::size_t body, const AllWalls& all, int threads)
{
    MomentFit(field, body, all, threads).run();
}

} // namespace fppg
