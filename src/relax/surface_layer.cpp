#include "relax/surface_layer.h"

#include "core/parallel.h"
#include "core/raw_array.h"
#include "meshes/mesh_query.h"
#include "relax/surface_holes.h"

#include <algorithm>
#include <memory>

namespace fppg
{

namespace
{

/// Lists reach 2 h + 0.4 and are made anew when a particle has moved by 0.4, half of the skin. A
/// pair that comes from beyond that to below 2 h - 0.4 in between, which takes two of the fastest
/// on course for one another, is missed; at 1.2 dp it is no nearest neighbour.
constexpr float skin = 0.8f;          // dp
constexpr double beyond_kernel = 0.4; // dp
/// Holes are looked for among the neighbours so far away, whatever h is.
constexpr double least_list_radius = 1.6; // dp
constexpr double layer_momentum = 0.85;
constexpr float largest_step = 0.1f; // dp
/// How steps are made.
struct Pace
{
    double share; ///< of the step that the stiffest mode of an even layer bears
    int steps;    ///< in the plane of a facet before a particle is taken back to the surface
    double worth; ///< dp; what has moved less in them stays off a while longer
};
constexpr Pace quick{1.6, 4, 0.03};
/// For few particles, which mostly crowd on a surface that bends within a few dp.
constexpr Pace careful{1.0, 1, 0};

Pace pace_of(std::size_t particles)
{
    return particles < few_particles ? careful : quick;
}
/// A particle that is taken back to a place so far from where it was, in dp, met a border.
constexpr double held_up = 0.01;
/// How far within a feature edge particles are kept, dp.
constexpr double inside_border = 1e-10;
constexpr float none_near = 1e30f;
constexpr float far_off = 1e15f; // dp: its square is still a float

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

/// Calls body(chunk, begin, end) for chunks of [0, n).
template <typename Body>
void for_chunks(std::size_t n, int threads, const Body& body)
{
    parallel_for(chunks_of(n), threads,
                 [&](std::size_t c)
                 {
                     const std::size_t begin = c * NeighbourList::rows_per_chunk;
                     body(c, begin, std::min(begin + NeighbourList::rows_per_chunk, n));
                 });
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

Vec3 middle_of(const SurfaceMesh& mesh)
{
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.add(v);
    return (box.min + box.max) * 0.5;
}

} // namespace

SurfaceLayer::SurfaceLayer(const FittedBody& body, std::shared_ptr<const WorkMesh> work,
                           std::vector<LayerParticle> particles, double dp, double h, int threads)
    : body_(&body),
      dp_(dp),
      threads_(threads),
      shared_work_(std::move(work)),
      work_(*shared_work_),
      forces_of_(static_cast<float>(h)),
      step_over_force_(static_cast<float>(pace_of(particles.size()).share /
                                          (stiffest_mode(h) + SurfaceForces::stiffness_of_push()))),
      origin_(middle_of(body.mesh)),
      particles_(std::move(particles)),
      list_(static_cast<float>(std::max(2 * h, least_list_radius) + beyond_kernel) - skin, skin)
{
    place_on_work_mesh();
    sort();
    const std::size_t n = particles_.size();
    velocities_.resize(n);
    forces_.resize(n);
    nearest_squared_.resize(n);
    normals_.resize(n);
    parallel_for(
        n, threads_, [&](std::size_t i) { set_vector(normals_, i, normal_of(particles_[i])); },
        NeighbourList::rows_per_chunk);
}

SurfaceLayer::~SurfaceLayer() = default;
SurfaceLayer::SurfaceLayer(SurfaceLayer&&) noexcept = default;

void SurfaceLayer::place_on_work_mesh()
{
    std::vector<FeatureParticle> on_features;
    for (LayerParticle& p : particles_)
    {
        if (p.kind == FitKind::Surface) continue;
        p.site = static_cast<std::uint32_t>(on_features.size());
        on_features.push_back(feature_at(*body_, p.kind, p.place));
        p.place.facet = work_.first_piece[p.place.facet];
    }
    parallel_for(
        particles_.size(), threads_,
        [&](std::size_t i)
        {
            LayerParticle& p = particles_[i];
            if (p.is_moving)
                p.place = place_on_facet(work_, p.place.facet, p.place.position);
            else if (p.kind == FitKind::Surface)
                p.place.facet = work_.locate(p.place.facet, p.place.position);
        },
        NeighbourList::rows_per_chunk);
    sites_ = make_feature_sites(body_->mesh, work_, on_features, threads_);
}

void SurfaceLayer::sort()
{
    const std::size_t n = particles_.size();
    points_.resize(n);
    const auto take_over = [&](std::size_t i)
    { set_vector(points_, i, local(particles_[i].place.position)); };
    parallel_for(n, threads_, take_over, NeighbourList::rows_per_chunk);
    reorder(particles_, morton_order(points_, 2, threads_), threads_);
    parallel_for(n, threads_, take_over, NeighbourList::rows_per_chunk);
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
    const PointArrays& n = normals_;
    const auto is_own_sheet = [&](std::uint32_t i, std::uint32_t j)
    {
        if (n.x[i] * n.x[j] + n.y[i] * n.y[j] + n.z[i] * n.z[j] >= opposing) return true;
        return is_close_across(vector_at(n, i), vector_at(points_, j) - vector_at(points_, i),
                               particles_[j].kind != FitKind::Surface);
    };
    list_.build(
        points_, threads_, [&](std::uint32_t i) { return particles_[i].is_awake; }, is_own_sheet);
    is_listed_ = true;
    // What sleeps keeps its own.
    roles_.resize(particles_.size());
    parallel_for(
        particles_.size(), threads_,
        [&](std::size_t i)
        {
            if (particles_[i].is_awake) nearest_squared_[i] = none_near;
            roles_[i] = !particles_[i].is_moving ? Role::Still
                        : particles_[i].is_awake ? Role::Awake
                                                 : Role::Asleep;
        },
        NeighbourList::rows_per_chunk);
}

LayerState SurfaceLayer::state_of_rows(std::size_t begin, std::size_t end) const
{
    LayerState state;
    for (std::size_t row = begin; row < end; ++row)
    {
        const std::uint32_t i = list_.point(row);
        if (roles_[i] == Role::Still) continue;
        const float reach = 4; // dp squared: nothing is near
        const float squared = std::min(nearest_squared_[i], reach);
        ++state.moving;
        state.spacing_sum += double{std::sqrt(squared)};
        state.spacing_square_sum += double{squared};
        if (roles_[i] == Role::Asleep) continue;
        state.power += double{forces_.x[i] * velocities_.x[i] + forces_.y[i] * velocities_.y[i] +
                              forces_.z[i] * velocities_.z[i]};
    }
    return state;
}

/// Those that no longer count are packed far away from all.
///
/// is_out  empty, or per particle
void SurfaceLayer::pack_points(const std::vector<char>& is_out)
{
    packed_.resize(particles_.size());
    parallel_for(
        particles_.size(), threads_,
        [&](std::size_t i)
        {
            if (is_out.empty() || is_out[i] == 0)
                packed_[i] = PackedPoint{points_.x[i], points_.y[i], points_.z[i], 0};
            else
                packed_[i] = PackedPoint{far_off, far_off, far_off, 0};
        },
        NeighbourList::rows_per_chunk);
}

LayerState SurfaceLayer::look_around()
{
    if (!is_listed_ || (steps_off_ == 0 && list_.is_outdated(points_, threads_))) build_list();
    pack_points({});
    std::vector<LayerState> states(chunks_of(list_.rows()));
    for_chunks(
        list_.rows(), threads_,
        [&](std::size_t c, std::size_t begin, std::size_t end)
        {
            forces_of_.compute({list_, begin, end}, packed_.data(), forces_, nearest_squared_);
            states[c] = state_of_rows(begin, end);
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

/// Makes a particle's step in the plane of its facet; returns the square of its length, dp.
float SurfaceLayer::push_on(std::size_t i, bool is_restart)
{
    const float kept = is_restart ? 0.0f : static_cast<float>(layer_momentum);
    float x = forces_.x[i] * step_over_force_ + velocities_.x[i] * kept;
    float y = forces_.y[i] * step_over_force_ + velocities_.y[i] * kept;
    float z = forces_.z[i] * step_over_force_ + velocities_.z[i] * kept;
    const float across = x * normals_.x[i] + y * normals_.y[i] + z * normals_.z[i];
    x -= across * normals_.x[i];
    y -= across * normals_.y[i];
    z -= across * normals_.z[i];
    float squared = x * x + y * y + z * z;
    if (squared > largest_step * largest_step)
    {
        const float shorter = largest_step / std::sqrt(squared);
        x *= shorter;
        y *= shorter;
        z *= shorter;
        squared = largest_step * largest_step;
    }
    velocities_.x[i] = x;
    velocities_.y[i] = y;
    velocities_.z[i] = z;
    points_.x[i] += x;
    points_.y[i] += y;
    points_.z[i] += z;
    return squared;
}

double SurfaceLayer::step(bool is_restart)
{
    std::vector<float> largest(chunks_of(particles_.size()), 0);
    for_chunks(particles_.size(), threads_,
               [&](std::size_t c, std::size_t begin, std::size_t end)
               {
                   for (std::size_t i = begin; i < end; ++i)
                       if (roles_[i] == Role::Awake)
                           largest[c] = std::max(largest[c], push_on(i, is_restart));
               });
    const Pace pace = pace_of(particles_.size());
    if (++steps_off_ >= pace.steps) settle(pace.worth);
    return std::sqrt(double{*std::max_element(largest.begin(), largest.end())});
}

/// From where a particle last stood on the surface, along the facet there, dp.
Vec3 SurfaceLayer::strayed(std::size_t i) const
{
    const SlidePlace& place = particles_[i].place;
    const Vec3 normal = vector_at(normals_, i);
    const Vec3 step = vector_at(points_, i) - local(place.position);
    return step - normal * dot(step, normal);
}

void SurfaceLayer::accept(std::size_t i, const SlidePlace& place)
{
    const Vec3& normal = work_.facets[place.facet].normal;
    const Vec3 at = local(place.position);
    Vec3 velocity = vector_at(velocities_, i);
    const Vec3 set_back = at - vector_at(points_, i);
    const Vec3 along = set_back - normal * dot(set_back, normal);
    if (dot(along, along) > held_up * held_up) velocity = {};
    set_vector(velocities_, i, velocity - normal * dot(velocity, normal));
    set_vector(points_, i, at);
    set_vector(normals_, i, normal);
    particles_[i].place = place;
}

/// Takes a particle back to the surface if it is farther than `least` dp from where it last stood
/// on it. False where that takes too many facets.
bool SurfaceLayer::slide_back(std::size_t i, double least)
{
    const Vec3 step = strayed(i);
    if (dot(step, step) <= least * least) return true;
    SlidePlace place = particles_[i].place;
    if (!slide(work_, place, step * dp_, inside_border * dp_)) return false;
    accept(i, place);
    return true;
}

void SurfaceLayer::settle(double least)
{
    steps_off_ = 0;
    std::vector<std::vector<std::uint32_t>> stuck(chunks_of(particles_.size()));
    for_chunks(particles_.size(), threads_,
               [&](std::size_t c, std::size_t begin, std::size_t end)
               {
                   for (std::size_t i = begin; i < end; ++i)
                   {
                       if (roles_[i] == Role::Awake && !slide_back(i, least))
                           stuck[c].push_back(static_cast<std::uint32_t>(i));
                   }
               });
    for (const auto& of_chunk : stuck)
        for (const std::uint32_t i : of_chunk) project(i);
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

void SurfaceLayer::project(std::size_t i)
{
    if (!query_)
    {
        query_ = std::make_unique<MeshQuery>(soup_of(body_->mesh), threads_);
        find_patches();
    }
    const SlidePlace& place = particles_[i].place;
    const Vec3 step = strayed(i) * dp_;
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
    accept(i, place);
    set_vector(velocities_, i, {});
    ++returned_;
}

/// Marks moving particles that go as they are too near others; those nearest to another go first.
std::vector<char> SurfaceLayer::find_crowded(double least)
{
    const auto limit = static_cast<float>(least * least);
    using Row = std::pair<float, std::uint32_t>;
    std::vector<std::vector<Row>> of_chunk(chunks_of(list_.rows()));
    for_chunks(
        list_.rows(), threads_,
        [&](std::size_t c, std::size_t begin, std::size_t end)
        {
            for (std::size_t row = begin; row < end; ++row)
            {
                const std::uint32_t i = list_.point(row);
                if (particles_[i].is_moving && nearest_squared_[i] < limit)
                    of_chunk[c].push_back({nearest_squared_[i], static_cast<std::uint32_t>(row)});
            }
        });
    std::vector<Row> rows;
    for (const auto& some : of_chunk) rows.insert(rows.end(), some.begin(), some.end());
    std::sort(rows.begin(), rows.end());
    std::vector<char> is_out(particles_.size(), 0);
    for (const auto& [nearest, row] : rows)
    {
        const std::uint32_t i = list_.point(row);
        const auto near = list_.neighbours(row);
        is_out[i] = std::any_of(near.begin(), near.end(),
                                [&](std::uint32_t j)
                                {
                                    const Vec3 d = vector_at(points_, j) - vector_at(points_, i);
                                    return is_out[j] == 0 && dot(d, d) < limit;
                                });
    }
    return is_out;
}

void SurfaceLayer::wake_around(std::size_t row, std::vector<char>& is_awake) const
{
    is_awake[list_.point(row)] = 1;
    for (const std::uint32_t j : list_.neighbours(row)) is_awake[j] = 1;
}

LayerChange SurfaceLayer::renew(const Limits& limits, bool is_local,
                                const std::function<bool(const Vec3&, const Vec3&)>& may_fill)
{
    settle(0);
    if (!is_listed_) look_around();
    const std::vector<char> is_out = find_crowded(limits.least);
    pack_points(is_out);
    const HoleFinder finder(*this, is_out, limits.hole_radius);
    const std::vector<SurfaceHole> holes = finder.find(may_fill, limits.is_sampled);
    const std::size_t given = particles_.size();
    std::vector<char> is_awake(given, is_local ? 0 : 1);
    LayerChange change;
    for (std::size_t row = 0; row < list_.rows(); ++row)
    {
        if (is_out[list_.point(row)] == 0) continue;
        wake_around(row, is_awake);
        ++change.removed;
    }
    for (const SurfaceHole& hole : holes)
    {
        wake_around(hole.row, is_awake);
        if (!hole.is_filled) continue;
        ++change.inserted;
        LayerParticle p;
        p.place = hole.place;
        p.is_new = true;
        const LayerParticle& beside = particles_[hole.beside];
        p.source = beside.source;
        p.is_moving = beside.kind != FitKind::Surface || beside.is_moving;
        particles_.push_back(p);
    }
    parallel_for(
        given, threads_, [&](std::size_t i) { particles_[i].is_awake = is_awake[i] != 0; },
        NeighbourList::rows_per_chunk);
    if (change.inserted + change.removed == 0) return change;
    const std::size_t n = particles_.size();
    for (PointArrays* v : {&points_, &velocities_, &normals_, &forces_}) v->resize(n);
    nearest_squared_.resize(n);
    for (std::size_t i = given; i < n; ++i)
    {
        set_vector(points_, i, local(particles_[i].place.position));
        set_vector(normals_, i, normal_of(particles_[i]));
    }
    if (change.removed > 0)
    {
        std::vector<std::uint32_t> kept;
        for (std::uint32_t i = 0; i < n; ++i)
            if (i >= given || is_out[i] == 0) kept.push_back(i);
        reorder(particles_, kept, threads_);
        for (PointArrays* v : {&points_, &velocities_, &normals_, &forces_})
            for (std::vector<float>* axis : {&v->x, &v->y, &v->z}) reorder(*axis, kept, threads_);
        reorder(nearest_squared_, kept, threads_);
    }
    is_listed_ = false;
    return change;
}

} // namespace fppg
