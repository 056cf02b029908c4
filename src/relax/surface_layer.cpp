#include "relax/surface_layer.h"

#include "core/parallel.h"
#include "core/raw_array.h"
#include "fit/for_each_chart.h"
#include "meshes/mesh_query.h"

#include <algorithm>
#include <memory>

namespace fppg
{

namespace
{

constexpr float skin = 0.4f; // dp
constexpr double layer_momentum = 0.9;
constexpr double largest_step = 0.1; // dp
/// How far within a feature edge particles are kept, dp.
constexpr double inside_border = 1e-10;
constexpr std::size_t prefetch_ahead = 8;

/// Particles whose normals oppose by more than 120 degrees are on two sheets, as in fitting: were
/// only those right behind one another left out, the two sides of a thin plate would thin and fill
/// each other without end.
constexpr float opposing = -0.5f;

Vec3 vector_at(const PointArrays& v, std::size_t i)
{
    return {v.x[i], v.y[i], v.z[i]};
}

void set_vector(PointArrays& v, std::size_t i, const Vec3& value)
{
    v.x[i] = static_cast<float>(value.x);
    v.y[i] = static_cast<float>(value.y);
    v.z[i] = static_cast<float>(value.z);
}

/// Keeps the values that an order names, in that order, which is at most as long as they are.
template <typename T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order, int threads)
{
    const std::size_t n = order.size();
    RawArray<T> sorted(n);
    parallel_for(
        n, threads, [&](std::size_t k) { std::construct_at(&sorted[k], values[order[k]]); },
        NeighbourList::rows_per_chunk);
    values.resize(n);
    parallel_for(
        n, threads, [&](std::size_t k) { values[k] = sorted[k]; }, NeighbourList::rows_per_chunk);
}

std::size_t chunks_of(std::size_t n)
{
    return (n + NeighbourList::rows_per_chunk - 1) / NeighbourList::rows_per_chunk;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 d = b - a;
    const double t = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
    return norm(p - (a + d * t));
}

/// The feature particle that place_feature_particles() made, found by place and facet.
FeatureParticle feature_at(const FittedBody& body, FitKind kind, const SlidePlace& place)
{
    const SurfaceMesh& mesh = body.mesh;
    FeatureParticle particle;
    particle.position = place.position;
    particle.is_corner = kind == FitKind::Corner;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < 3; ++s)
    {
        const Vec3& a = mesh.vertices[mesh.facets[place.facet][s]];
        const Vec3& b = mesh.vertices[mesh.facets[place.facet][(s + 1) % 3]];
        const std::uint32_t edge = mesh.facet_edges[place.facet][s];
        if (!particle.is_corner && !body.features.is_feature_edge[edge]) continue;
        const double distance = particle.is_corner ? norm(a - place.position)
                                                   : distance_to_segment(place.position, a, b);
        if (distance >= best) continue;
        best = distance;
        (particle.is_corner ? particle.vertex : particle.edge) =
            particle.is_corner ? mesh.facets[place.facet][s] : edge;
    }
    // On a facet without a feature edge, the first of its sides stands for it.
    if (!particle.is_corner && particle.edge == no_index)
        particle.edge = mesh.facet_edges[place.facet][0];
    return particle;
}

/// The Voronoi cell of the origin in a plane, cut by one neighbour after another.
class VoronoiCell
{
public:
    explicit VoronoiCell(float half_side)
        : x_{-half_side, half_side, half_side, -half_side},
          y_{-half_side, -half_side, half_side, half_side}
    {
    }

    bool is_within(float radius) const
    {
        float farthest = 0;
        for (std::size_t k = 0; k < count_; ++k)
            farthest = std::max(farthest, x_[k] * x_[k] + y_[k] * y_[k]);
        return farthest <= radius * radius;
    }

    /// Keeps what is nearer to the origin than to a point over (x, y) whose distance has the square
    /// `squared`.
    void cut(float x, float y, float squared)
    {
        std::array<float, capacity> excess;
        bool is_cut = false;
        for (std::size_t k = 0; k < count_; ++k)
        {
            excess[k] = x_[k] * x + y_[k] * y - 0.5f * squared;
            is_cut |= excess[k] > 0;
        }
        if (!is_cut || count_ + 2 > capacity) return;
        std::array<float, capacity> xs;
        std::array<float, capacity> ys;
        std::size_t n = 0;
        for (std::size_t k = 0; k < count_; ++k)
        {
            const std::size_t next = k + 1 == count_ ? 0 : k + 1;
            if (excess[k] <= 0)
            {
                xs[n] = x_[k];
                ys[n++] = y_[k];
            }
            if ((excess[k] > 0) == (excess[next] > 0)) continue;
            const float t = excess[k] / (excess[k] - excess[next]);
            xs[n] = x_[k] + t * (x_[next] - x_[k]);
            ys[n++] = y_[k] + t * (y_[next] - y_[k]);
        }
        x_ = xs;
        y_ = ys;
        count_ = n;
    }

private:
    /// A convex polygon gains at most one corner a cut; a cell that has too many is left too wide.
    static constexpr std::size_t capacity = 24;
    std::array<float, capacity> x_;
    std::array<float, capacity> y_;
    std::size_t count_ = 4;
};

Vec3 middle_of(const SurfaceMesh& mesh)
{
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.add(v);
    return (box.min + box.max) * 0.5;
}

} // namespace

SurfaceLayer::SurfaceLayer(const FittedBody& body, std::vector<LayerParticle> particles, double dp,
                           double h, int threads)
    : body_(&body),
      dp_(dp),
      threads_(threads),
      work_(make_work_mesh(body.mesh, body.features, longest_chart_side * dp)),
      charts_(work_, dp),
      forces_of_(static_cast<float>(h)),
      step_over_force_(static_cast<float>(1 / stiffest_mode(h))),
      origin_(middle_of(body.mesh)),
      particles_(std::move(particles)),
      list_(static_cast<float>(2 * h), skin)
{
    std::vector<FeatureParticle> on_features;
    for (LayerParticle& p : particles_)
    {
        if (p.kind != FitKind::Surface)
        {
            p.site = static_cast<std::uint32_t>(on_features.size());
            on_features.push_back(feature_at(body, p.kind, p.place));
            p.place.facet = work_.first_piece[p.place.facet];
        }
    }
    parallel_for(
        particles_.size(), threads_,
        [&](std::size_t i)
        {
            LayerParticle& p = particles_[i];
            if (p.kind != FitKind::Surface) return;
            if (p.is_moving)
                p.place = place_on_facet(work_, p.place.facet, p.place.position);
            else
                p.place.facet = work_.locate(p.place.facet, p.place.position);
        },
        NeighbourList::rows_per_chunk);
    sites_ = make_feature_sites(body.mesh, work_, on_features, threads);
    velocities_.resize(particles_.size());
    sort();
}

SurfaceLayer::~SurfaceLayer() = default;
SurfaceLayer::SurfaceLayer(SurfaceLayer&&) noexcept = default;

void SurfaceLayer::sort()
{
    const std::size_t n = particles_.size();
    points_.resize(n);
    parallel_for(
        n, threads_,
        [&](std::size_t i) { set_vector(points_, i, local(particles_[i].place.position)); },
        NeighbourList::rows_per_chunk);
    const auto order = morton_order(points_, 2, threads_);
    reorder(particles_, order, threads_);
    for (PointArrays* v : {&points_, &velocities_})
        for (std::vector<float>* axis : {&v->x, &v->y, &v->z}) reorder(*axis, order, threads_);
    forces_.resize(n);
    nearest_squared_.resize(n);
    is_listed_ = false;
}

Vec3 SurfaceLayer::normal_of(const LayerParticle& particle) const
{
    if (particle.kind == FitKind::Surface) return work_.facets[particle.place.facet].normal;
    const Vec3& normal = sites_[particle.site].normal;
    const double length = norm(normal);
    return length > 0 ? normal / length : normal;
}

void SurfaceLayer::build_list()
{
    struct Normal
    {
        float x, y, z;
    };
    RawArray<Normal> normals(particles_.size());
    parallel_for(
        particles_.size(), threads_,
        [&](std::size_t i)
        {
            if (i + prefetch_ahead < particles_.size()) prefetch_facet(i + prefetch_ahead);
            const Vec3 normal = normal_of(particles_[i]);
            normals[i] = {static_cast<float>(normal.x), static_cast<float>(normal.y),
                          static_cast<float>(normal.z)};
        },
        NeighbourList::rows_per_chunk);
    const auto is_own_sheet = [&](std::uint32_t i, std::uint32_t j)
    {
        const float cosine =
            normals[i].x * normals[j].x + normals[i].y * normals[j].y + normals[i].z * normals[j].z;
        if (cosine >= opposing) return true;
        return is_close_across({normals[i].x, normals[i].y, normals[i].z},
                               vector_at(points_, j) - vector_at(points_, i),
                               particles_[j].kind != FitKind::Surface);
    };
    list_.build(
        points_, threads_, [&](std::uint32_t i) { return particles_[i].is_moving; }, is_own_sheet);
    is_listed_ = true;
}

LayerState SurfaceLayer::look_around()
{
    if (!is_listed_ || list_.is_outdated(points_, threads_)) build_list();
    std::vector<LayerState> states(chunks_of(list_.rows()));
    parallel_for(states.size(), threads_,
                 [&](std::size_t c)
                 {
                     const std::size_t begin = c * NeighbourList::rows_per_chunk;
                     const std::size_t end =
                         std::min(begin + NeighbourList::rows_per_chunk, list_.rows());
                     forces_of_.compute(list_, begin, end, points_, forces_, nearest_squared_);
                     LayerState& state = states[c];
                     for (std::size_t row = begin; row < end; ++row)
                     {
                         const std::uint32_t i = list_.point(row);
                         if (!particles_[i].is_moving) continue;
                         const double reach = 4; // dp squared: nothing is near
                         const double squared = std::min<double>(nearest_squared_[i], reach);
                         ++state.moving;
                         state.spacing_sum += std::sqrt(squared);
                         state.spacing_square_sum += squared;
                         state.power += dot(vector_at(forces_, i), vector_at(velocities_, i));
                     }
                 });
    LayerState sum;
    for (const LayerState& state : states)
    {
        sum.moving += state.moving;
        sum.spacing_sum += state.spacing_sum;
        sum.spacing_square_sum += state.spacing_square_sum;
        sum.power += state.power;
    }
    return sum;
}

Vec3 SurfaceLayer::intended_step(std::size_t i, bool is_restart) const
{
    const Vec3& normal = work_.facets[particles_[i].place.facet].normal;
    Vec3 step = vector_at(forces_, i) * step_over_force_;
    if (!is_restart) step = step + vector_at(velocities_, i) * layer_momentum;
    step = step - normal * dot(step, normal);
    const double length = norm(step);
    return length > largest_step ? step * (largest_step / length) : step;
}

void SurfaceLayer::accept(std::size_t i, const SlidePlace& place)
{
    const Vec3& normal = work_.facets[place.facet].normal;
    const Vec3 moved = (place.position - particles_[i].place.position) / dp_;
    set_vector(velocities_, i, moved - normal * dot(moved, normal));
    set_vector(points_, i, local(place.position));
    particles_[i].place = place;
}

bool SurfaceLayer::move(std::size_t i, bool is_restart)
{
    SlidePlace place = particles_[i].place;
    if (!slide(work_, place, intended_step(i, is_restart) * dp_, inside_border * dp_)) return false;
    accept(i, place);
    return true;
}

/// Facets lie in the order of the file, which need not be one in space.
void SurfaceLayer::prefetch_facet(std::size_t i) const
{
    const char* facet = reinterpret_cast<const char*>(&work_.facets[particles_[i].place.facet]);
    __builtin_prefetch(facet);
    __builtin_prefetch(facet + 64);
}

double SurfaceLayer::step(bool is_restart)
{
    struct Outcome
    {
        double largest = 0;
        std::vector<std::uint32_t> stuck;
    };
    std::vector<Outcome> outcomes(chunks_of(particles_.size()));
    parallel_for(outcomes.size(), threads_,
                 [&](std::size_t c)
                 {
                     const std::size_t end =
                         std::min((c + 1) * NeighbourList::rows_per_chunk, particles_.size());
                     for (std::size_t i = c * NeighbourList::rows_per_chunk; i < end; ++i)
                     {
                         if (i + prefetch_ahead < end) prefetch_facet(i + prefetch_ahead);
                         if (!particles_[i].is_moving) continue;
                         if (!move(i, is_restart))
                             outcomes[c].stuck.push_back(static_cast<std::uint32_t>(i));
                         else
                         {
                             const Vec3 v = vector_at(velocities_, i);
                             outcomes[c].largest = std::max(outcomes[c].largest, dot(v, v));
                         }
                     }
                 });
    double largest = 0;
    for (const Outcome& outcome : outcomes)
    {
        largest = std::max(largest, outcome.largest);
        for (const std::uint32_t i : outcome.stuck) project(i, is_restart);
    }
    return std::sqrt(largest);
}

/// Labels the facets between borders, so that a projected point is known to be on its own.
void SurfaceLayer::find_patches()
{
    patches_.assign(work_.facets.size(), no_index);
    std::vector<std::uint32_t> open;
    for (std::uint32_t first = 0; first < work_.facets.size(); ++first)
    {
        if (patches_[first] != no_index) continue;
        patches_[first] = first;
        open.push_back(first);
        while (!open.empty())
        {
            const std::uint32_t f = open.back();
            open.pop_back();
            for (const std::uint32_t next : work_.facets[f].neighbours)
                if (next != no_index && patches_[next] == no_index)
                {
                    patches_[next] = first;
                    open.push_back(next);
                }
        }
    }
}

void SurfaceLayer::project(std::size_t i, bool is_restart)
{
    if (!query_)
    {
        query_ = std::make_unique<MeshQuery>(soup_of(body_->mesh), threads_);
        find_patches();
    }
    const SlidePlace& place = particles_[i].place;
    const Vec3 step = intended_step(i, is_restart) * dp_;
    const ClosestPoint found = query_->closest_point(place.position + step);
    const std::uint32_t piece = work_.locate(found.facet, found.point);
    const bool is_own_sheet =
        patches_[piece] == patches_[place.facet] &&
        dot(work_.facets[piece].normal, work_.facets[place.facet].normal) > 0 &&
        norm(found.point - place.position) <= 1.5 * norm(step);
    if (is_own_sheet)
    {
        accept(i, {found.point, piece});
        ++projected_;
        return;
    }
    set_vector(velocities_, i, {});
    ++returned_;
}

std::size_t SurfaceLayer::thin(double least)
{
    look_around();
    const auto limit = static_cast<float>(least * least);
    std::vector<std::pair<float, std::uint32_t>> rows; // nearest first
    for (std::uint32_t row = 0; row < list_.rows(); ++row)
    {
        const std::uint32_t i = list_.point(row);
        if (particles_[i].is_moving && nearest_squared_[i] < limit)
            rows.push_back({nearest_squared_[i], row});
    }
    std::sort(rows.begin(), rows.end());
    std::vector<char> is_out(particles_.size(), 0);
    std::size_t count = 0;
    for (const auto& [nearest, row] : rows)
    {
        const std::uint32_t i = list_.point(row);
        const auto near = list_.neighbours(row);
        const bool is_too_near = std::any_of(near.begin(), near.end(),
                                             [&](std::uint32_t j)
                                             {
                                                 const Vec3 d =
                                                     vector_at(points_, j) - vector_at(points_, i);
                                                 return !is_out[j] && dot(d, d) < limit;
                                             });
        if (!is_too_near) continue;
        is_out[i] = 1;
        ++count;
    }
    if (count == 0) return 0;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < particles_.size(); ++i)
        if (!is_out[i]) kept.push_back(i);
    reorder(particles_, kept, threads_);
    for (PointArrays* v : {&points_, &velocities_})
        for (std::vector<float>* axis : {&v->x, &v->y, &v->z}) reorder(*axis, kept, threads_);
    sort();
    return count;
}

/// Per particle whether its Voronoi cell reaches farther than a radius, in dp, or may do so.
std::vector<char> SurfaceLayer::find_near_holes(float radius)
{
    if (!is_listed_ || list_.is_outdated(points_, threads_)) build_list();
    // The cell is taken in the plane of the facet and in float: a little room for both.
    const float limit = 0.99f * radius;
    std::vector<char> is_near_hole(particles_.size(), 1);
    parallel_for(
        list_.rows(), threads_,
        [&](std::size_t row)
        {
            const std::uint32_t i = list_.point(row);
            if (!particles_[i].is_moving) return;
            const WorkFacet& facet = work_.facets[particles_[i].place.facet];
            const Vec3 side = facet.corners[1] - facet.corners[0];
            const Vec3 x_axis = side / norm(side);
            const Vec3 y_axis = cross(facet.normal, x_axis);
            VoronoiCell cell(1.3f);
            // The nearest first, after which there is mostly nothing left to cut.
            for (const bool is_close : {true, false})
            {
                for (const std::uint32_t j : list_.neighbours(row))
                {
                    const Vec3 d = vector_at(points_, j) - vector_at(points_, i);
                    const auto squared = static_cast<float>(dot(d, d));
                    if ((squared < 1.7f) != is_close) continue;
                    cell.cut(static_cast<float>(dot(d, x_axis)), static_cast<float>(dot(d, y_axis)),
                             squared);
                }
                if (!cell.is_within(limit)) continue;
                is_near_hole[i] = 0;
                return;
            }
        },
        NeighbourList::rows_per_chunk);
    return is_near_hole;
}

std::size_t SurfaceLayer::fill(double radius,
                               const std::function<bool(const Vec3&, const Vec3&)>& may_fill)
{
    FillState state{work_, charts_, sites_, dp_, std::vector<ChartParticles>(charts_.size())};
    state.hole_radius = radius;
    state.may_fill = may_fill;
    state.share_out_features();
    const std::vector<char> is_near_hole = find_near_holes(static_cast<float>(radius));
    std::vector<std::size_t> given(charts_.size(), 0);
    for (const LayerParticle& p : particles_)
        if (p.kind == FitKind::Surface) ++given[charts_.of_facet(p.place.facet)];
    for (std::size_t c = 0; c < given.size(); ++c)
        state.particles[c].sites.reserve(given[c] + given[c] / 16);
    for (std::uint32_t i = 0; i < particles_.size(); ++i)
    {
        const LayerParticle& p = particles_[i];
        if (p.kind != FitKind::Surface) continue;
        SurfaceSite site;
        site.position = p.place.position;
        site.facet = p.place.facet;
        site.is_irregular = is_near_hole[i];
        site.is_at_seam = charts_.near_point(site.position).size() > 1;
        state.particles[charts_.of_facet(site.facet)].sites.push_back(site);
    }
    for_each_chart(state, threads_,
                   [](ChartFiller& filler, std::uint32_t c) { filler.fill_holes(c); });
    std::size_t count = 0;
    for (std::size_t c = 0; c < given.size(); ++c)
        for (std::size_t s = given[c]; s < state.particles[c].sites.size(); ++s)
        {
            const SurfaceSite& site = state.particles[c].sites[s];
            LayerParticle p;
            p.place = {site.position, site.facet};
            p.is_moving = true;
            p.is_new = true;
            particles_.push_back(p);
            ++count;
        }
    if (count == 0) return 0;
    velocities_.resize(particles_.size());
    sort();
    build_list();
    name_sources();
    return count;
}

/// New particles take after the given particle that is nearest to them: its mk, and whether it is
/// held, or those that fill a gap in a held row would leave it.
void SurfaceLayer::name_sources()
{
    for (std::size_t row = 0; row < list_.rows(); ++row)
    {
        const std::uint32_t i = list_.point(row);
        if (particles_[i].source != no_index) continue;
        double best = std::numeric_limits<double>::infinity();
        std::uint32_t nearest = i;
        for (const std::uint32_t j : list_.neighbours(row))
        {
            const Vec3 d = vector_at(points_, j) - vector_at(points_, i);
            if (particles_[j].source == no_index || dot(d, d) >= best) continue;
            best = dot(d, d);
            nearest = j;
        }
        particles_[i].source = particles_[nearest].source;
        if (particles_[nearest].kind == FitKind::Surface)
            particles_[i].is_moving = particles_[nearest].is_moving;
    }
}

} // namespace fppg
