#include "meshes/cad_surface.h"

#include "core/parallel.h"
#include "meshes/mesh_facets.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{
namespace
{

constexpr int newton_steps = 30;
/// Steps along an edge to the place nearest to a point; each gains about depth over radius.
constexpr int edge_steps = 60;
/// Facets and surface agree on a distance to this, in chord errors.
constexpr double same_distance = 1.5;
/// From the size of a body: what is so near is the same place.
constexpr double place_rounding = 1e-9;

Vec3 turned(const Transform& place, const Vec3& v)
{
    return {dot(place.linear[0], v), dot(place.linear[1], v), dot(place.linear[2], v)};
}

/// One step of Newton's method towards the place nearest to p, in parameters; false where the face
/// is degenerate there.
bool newton_step(const FacePoint& at, const Vec3& p, double& du, double& dv)
{
    const Vec3 r = p - at.s;
    const double gu = dot(r, at.su), gv = dot(r, at.sv);
    double e = dot(at.su, at.su), f = dot(at.su, at.sv), g = dot(at.sv, at.sv);
    const double plain = e * g - f * f;
    if (!(plain > 1e-20 * e * g)) return false;
    const double e2 = e - dot(r, at.suu), f2 = f - dot(r, at.suv), g2 = g - dot(r, at.svv);
    double det = plain;
    // Where the distance is no bowl, as behind the middle of a curve, its first order goes on.
    if (e2 > 0 && e2 * g2 - f2 * f2 > 1e-3 * plain)
    {
        e = e2;
        f = f2;
        g = g2;
        det = e * g - f * f;
    }
    du = (g * gu - f * gv) / det;
    dv = (e * gv - f * gu) / det;
    return true;
}

} // namespace

CadModels::CadModels(std::vector<CadSource> sources, int threads) : sources_(std::move(sources))
{
    TriangleSoup all;
    for (const CadSource& source : sources_)
    {
        begin_.push_back(static_cast<std::uint32_t>(all.size()));
        for (const Vec3& v : source.facets->soup.vertices) all.vertices.push_back(source.place(v));
        const auto& rows = source.place.linear;
        sense_.push_back(dot(rows[0], cross(rows[1], rows[2])) < 0 ? -1 : 1);
    }
    query_ = std::make_unique<MeshQuery>(std::move(all), threads);
}

std::array<Vec3, 3> CadModels::corners(const CadRef& ref) const
{
    const std::size_t f = 3 * (std::size_t{begin_[ref.source]} + ref.facet);
    const std::vector<Vec3>& all = query_->soup().vertices;
    return {all[f], all[f + 1], all[f + 2]};
}

CadRef CadModels::find(const Vec3& p, const Vec3& normal, double reach) const
{
    const ClosestPoint near = query_->closest_point(p, reach);
    if (!(near.distance <= reach)) return {};
    const auto next = std::upper_bound(begin_.begin(), begin_.end(), near.facet);
    CadRef ref;
    ref.source = static_cast<std::uint32_t>(next - begin_.begin()) - 1;
    ref.facet = near.facet - begin_[ref.source];
    const auto [a, b, c] = corners(ref);
    const Vec3 of_facet = cross(b - a, c - a);
    return std::fabs(dot(of_facet, normal)) > 0.9 * norm(of_facet) ? ref : CadRef{};
}

std::array<double, 2> CadModels::parameters(const CadRef& ref, const Vec3& p) const
{
    const auto [a, b, c] = corners(ref);
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const Vec3 n = cross(ab, ac);
    const double square = dot(n, n);
    double of_b = 0, of_c = 0;
    if (square > 0)
    {
        of_b = dot(cross(ap, ac), n) / square;
        of_c = dot(cross(ab, ap), n) / square;
    }
    const auto& uv = sources_[ref.source].facets->uv[ref.facet];
    std::array<double, 2> out{};
    for (std::size_t k = 0; k < 2; ++k)
        out[k] = uv[0][k] + of_b * (uv[1][k] - uv[0][k]) + of_c * (uv[2][k] - uv[0][k]);
    return out;
}

std::optional<FaceFoot> CadModels::foot(const CadRef& ref, const Vec3& p, const Vec3& start) const
{
    const CadSource& source = sources_[ref.source];
    const std::uint32_t face = source.facets->face[ref.facet];
    const auto [a, b, c] = corners(ref);
    const Vec3 flat = cross(b - a, c - a);
    const std::array<double, 2> first = parameters(ref, start);
    double u = first[0], v = first[1];
    FacePoint at;
    const auto look = [&]
    {
        at = source.facets->at(face, u, v);
        at.s = source.place(at.s);
        for (Vec3* d : {&at.su, &at.sv, &at.suu, &at.suv, &at.svv}) *d = turned(source.place, *d);
    };
    const double enough = 1e-14 * std::max(largest_coordinate(p), norm(b - a));
    look();
    bool is_at_rest = false, was_at_pole = false;
    for (int step = 0; step < newton_steps && !is_at_rest; ++step)
    {
        double du = 0, dv = 0;
        const bool is_at_pole = !newton_step(at, p, du, dv);
        if (is_at_pole)
        {
            // The pole of a sphere, the tip of a cone: right beside it.
            const auto [mu, mv] = parameters(ref, (a + b + c) / 3);
            du = 1e-7 * (mu - u);
            dv = 1e-7 * (mv - v);
        }
        if (!std::isfinite(du) || !std::isfinite(dv)) return std::nullopt;
        is_at_rest = is_at_pole ? was_at_pole : norm(du * at.su + dv * at.sv) <= enough;
        was_at_pole = was_at_pole || is_at_pole;
        u += du;
        v += dv;
        look();
    }
    const Vec3 normal = cross(at.su, at.sv);
    const double length = norm(normal);
    if (!is_at_rest || !(length > 0) || !std::isfinite(length)) return std::nullopt;
    FaceFoot out;
    out.point = at.s;
    out.normal = (dot(normal, sense_[ref.source] * flat) < 0 ? -1 / length : 1 / length) * normal;
    return out;
}

CadSurface::CadSurface(const SurfaceMesh& mesh, std::vector<CadSource> sources, int threads)
    : models_(std::move(sources), threads)
{
    for (const Vec3& v : mesh.vertices) size_ = std::max(size_, largest_coordinate(v));
    refs_.resize(mesh.facets.size());
    parallel_for(
        mesh.facets.size(), threads,
        [&](std::size_t f)
        {
            const auto& [a, b, c] = mesh.facets[f];
            const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
            refs_[f] = models_.find(middle, mesh.normals[f], 1e-6 * size_);
        },
        256);
    bends_.resize(mesh.edges.size());
    parallel_for(
        mesh.edges.size(), threads,
        [&](std::size_t e)
        { bends_[e] = static_cast<float>(bend_at(mesh, static_cast<std::uint32_t>(e))); },
        256);
    bent_edge_.assign(mesh.vertices.size(), no_index);
    bent_count_.assign(mesh.vertices.size(), 0);
    for (std::uint32_t e = 0; e < mesh.edges.size(); ++e)
    {
        if (!is_bent(e)) continue;
        for (const std::uint32_t v : mesh.edges[e])
        {
            bent_edge_[v] = e;
            if (bent_count_[v] < 255) ++bent_count_[v];
        }
    }
    measure_chord(mesh, threads);
}

double CadSurface::bend_at(const SurfaceMesh& mesh, std::uint32_t edge) const
{
    const auto [f, g] = mesh.edge_facets[edge];
    if (g == no_index || mesh.is_manifold[edge] == 0) return -1;
    const CadRef& a = refs_[f];
    const CadRef& b = refs_[g];
    if (!a.is_known() || !b.is_known()) return -1;
    const Vec3 middle =
        0.5 * (mesh.vertices[mesh.edges[edge][0]] + mesh.vertices[mesh.edges[edge][1]]);
    if (a.source == b.source && models_.face_of(a) == models_.face_of(b))
    {
        if (models_.is_plane(a)) return 0;
        // A face may meet itself in an edge: there its parameters are others on both sides.
        const auto pa = models_.parameters(a, middle);
        const auto pb = models_.parameters(b, middle);
        const auto near = [](double p, double q)
        { return std::fabs(p - q) <= 1e-6 * (1 + std::fabs(p)); };
        if (near(pa[0], pb[0]) && near(pa[1], pb[1])) return 0;
    }
    const auto of_a = models_.foot(a, middle, middle);
    const auto of_b = models_.foot(b, middle, middle);
    if (!of_a || !of_b) return -1;
    // As the facets look: those of a mended mesh may be turned.
    const auto facing = [&](const FaceFoot& foot, std::uint32_t facet)
    { return dot(foot.normal, mesh.normals[facet]) < 0 ? -foot.normal : foot.normal; };
    return angle_between(facing(*of_a, f), facing(*of_b, g));
}

void CadSurface::measure_chord(const SurfaceMesh& mesh, int threads)
{
    std::vector<double> chords(mesh.facets.size(), 0);
    parallel_for(
        mesh.facets.size(), threads,
        [&](std::size_t f)
        {
            if (!refs_[f].is_known() || models_.is_plane(refs_[f])) return;
            const auto& corners = mesh.facets[f];
            Vec3 middle;
            for (std::size_t c = 0; c < 3; ++c)
            {
                const Vec3& p = mesh.vertices[corners[c]];
                const Vec3& q = mesh.vertices[corners[(c + 1) % 3]];
                middle = middle + p / 3;
                const Vec3 side = 0.5 * (p + q);
                if (const auto foot = models_.foot(refs_[f], side, side))
                    chords[f] = std::max(chords[f], norm(foot->point - side));
            }
            if (const auto foot = models_.foot(refs_[f], middle, middle))
                chords[f] = std::max(chords[f], norm(foot->point - middle));
        },
        256);
    for (const double chord : chords) chord_ = std::max(chord_, chord);
}

CadSurface::Meeting CadSurface::across(const SurfaceMesh& mesh, std::uint32_t edge) const
{
    Meeting out;
    const auto [f, g] = mesh.edge_facets[edge];
    if (g == no_index || mesh.is_manifold[edge] == 0) return out;
    if (!refs_[f].is_known() || !refs_[g].is_known()) return out;
    out.refs = {refs_[f], refs_[g]};
    out.facets = {f, g};
    out.count = 2;
    return out;
}

CadSurface::Meeting CadSurface::meeting_at(const SurfaceMesh& mesh, const Vec3& p,
                                           std::uint32_t facet, double room) const
{
    Meeting out;
    const auto& corners = mesh.facets[facet];
    for (const std::uint32_t v : corners)
    {
        if (norm(p - mesh.vertices[v]) > room || bent_count_[v] == 0) continue;
        return bent_count_[v] == 2 ? across(mesh, bent_edge_[v]) : out;
    }
    for (std::size_t side = 0; side < 3; ++side)
    {
        const std::uint32_t edge = mesh.facet_edges[facet][side];
        if (!is_bent(edge)) continue;
        const Vec3& a = mesh.vertices[corners[side]];
        const Vec3 along = mesh.vertices[corners[(side + 1) % 3]] - a;
        if (norm(cross(along, p - a)) <= room * norm(along)) return across(mesh, edge);
    }
    if (!refs_[facet].is_known()) return out;
    out.refs[0] = refs_[facet];
    out.facets[0] = facet;
    out.count = 1;
    return out;
}

std::optional<FaceFoot> CadSurface::foot(const SurfaceMesh& mesh, const Vec3& p,
                                         std::uint32_t facet) const
{
    if (!refs_[facet].is_known()) return std::nullopt;
    std::optional<FaceFoot> out = models_.foot(refs_[facet], p, p);
    if (!out || norm(out->point - p) > 4 * chord_ + place_rounding * size_) return std::nullopt;
    if (dot(out->normal, mesh.normals[facet]) < 0) out->normal = -out->normal;
    return out;
}

std::optional<Vec3> CadSurface::edge_normal(const SurfaceMesh& mesh, const Vec3& p,
                                            std::uint32_t facet) const
{
    const Meeting meeting = meeting_at(mesh, p, facet, 4 * chord_ + place_rounding * size_);
    if (meeting.count != 2) return std::nullopt;
    Vec3 sum;
    for (std::size_t i = 0; i < 2; ++i)
    {
        const auto foot = models_.foot(meeting.refs[i], p, p);
        if (!foot) return std::nullopt;
        sum = sum +
              (dot(foot->normal, mesh.normals[meeting.facets[i]]) < 0 ? -1.0 : 1.0) * foot->normal;
    }
    const double length = norm(sum);
    // Below this length the direction is that of rounding errors.
    if (!(length > 1e-6)) return std::nullopt;
    return sum / length;
}

void CadSurface::project(const SurfaceMesh& mesh, Vec3& p, std::uint32_t facet, bool is_2d) const
{
    const Meeting meeting = meeting_at(mesh, p, facet, place_rounding * size_);
    if (meeting.count == 0) return;
    Vec3 at = p;
    // The smallest step onto the tangent planes of all faces that meet there, until it stays.
    for (int step = 0; step < newton_steps; ++step)
    {
        std::array<Vec3, 2> way;
        std::array<double, 2> off{};
        for (std::size_t i = 0; i < meeting.count; ++i)
        {
            const auto foot = models_.foot(meeting.refs[i], at, p);
            if (!foot) return;
            way[i] = foot->normal;
            if (is_2d) way[i].y = 0;
            off[i] = dot(foot->point - at, foot->normal);
        }
        Vec3 move;
        const double first = dot(way[0], way[0]);
        if (meeting.count == 1)
        {
            if (!(first > 1e-6)) return;
            move = way[0] * (off[0] / first);
        }
        else
        {
            const double both = dot(way[0], way[1]), second = dot(way[1], way[1]);
            const double det = first * second - both * both;
            if (!(det > 1e-8)) return;
            move = way[0] * ((off[0] * second - off[1] * both) / det) +
                   way[1] * ((off[1] * first - off[0] * both) / det);
        }
        at = at + move;
        if (norm(move) <= 1e-15 * size_) break;
    }
    // Where faces meet at a small angle, their line may be farther from its chord than they.
    if (norm(at - p) <= 60 * chord_ + place_rounding * size_) p = at;
}

std::optional<ExactPlace> CadSurface::on_edge(const Meeting& meeting, const Vec3& p,
                                              const Vec3& start) const
{
    Vec3 at = start;
    ExactPlace out;
    out.face_count = 2;
    for (int step = 0; step < edge_steps; ++step)
    {
        std::array<double, 2> off{};
        for (std::size_t i = 0; i < 2; ++i)
        {
            const auto foot = models_.foot(meeting.refs[i], at, start);
            if (!foot) return std::nullopt;
            out.faces[i] = foot->normal;
            off[i] = dot(foot->point - at, foot->normal);
        }
        const Vec3 line = cross(out.faces[0], out.faces[1]);
        const double square = dot(line, line);
        if (!(square > 1e-8)) return std::nullopt;
        const double both = dot(out.faces[0], out.faces[1]);
        const Vec3 move = out.faces[0] * ((off[0] - off[1] * both) / square) +
                          out.faces[1] * ((off[1] - off[0] * both) / square) +
                          line * (dot(p - at, line) / square);
        at = at + move;
        if (norm(move) > 1e-13 * size_) continue;
        out.nearest = at;
        return out;
    }
    return std::nullopt;
}

std::optional<ExactPlace> CadSurface::at(const SurfaceMesh& mesh, const Vec3& p, const Vec3& start,
                                         std::uint32_t facet) const
{
    const Meeting meeting = meeting_at(mesh, start, facet, place_rounding * size_);
    if (meeting.count == 0 || is_flat(meeting)) return std::nullopt;
    std::optional<ExactPlace> out;
    if (meeting.count == 2)
        out = on_edge(meeting, p, start);
    else if (const auto foot = models_.foot(meeting.refs[0], p, start))
    {
        out.emplace();
        out->nearest = foot->point;
        out->faces[0] = foot->normal;
    }
    if (!out) return out;
    const double difference = std::fabs(norm(out->nearest - p) - norm(start - p));
    if (difference > same_distance * chord_ + 1e-12 * size_) return std::nullopt;
    for (std::size_t i = 0; i < meeting.count; ++i)
        if (dot(out->faces[i], mesh.normals[meeting.facets[i]]) < 0) out->faces[i] = -out->faces[i];
    return out;
}

std::optional<ExactPlace> CadSurface::in_plane(const SurfaceMesh& mesh, const Vec3& p,
                                               const Vec3& start, std::uint32_t facet) const
{
    const Meeting meeting = meeting_at(mesh, start, facet, place_rounding * size_);
    if (meeting.count == 0 || is_flat(meeting)) return std::nullopt;
    ExactPlace out;
    out.face_count = static_cast<int>(meeting.count);
    Vec3 next = start;
    double least_slope = 1; // of a face against the plane: chords are so much longer in it
    // Along the tangent at the foot to the point below p, until that stays; a corner stays at once.
    for (int step = 0; step < edge_steps; ++step)
    {
        Vec3& at = out.nearest = next;
        project(mesh, at, facet, true);
        for (std::size_t i = 0; i < meeting.count; ++i)
        {
            const auto foot = models_.foot(meeting.refs[i], at, start);
            if (!foot || norm(foot->point - at) > 1e-9 * size_) return std::nullopt;
            const bool turns = dot(foot->normal, mesh.normals[meeting.facets[i]]) < 0;
            const Vec3 in_plane{foot->normal.x, 0, foot->normal.z};
            const double slope = norm(in_plane);
            if (!(slope > 1e-3)) return std::nullopt;
            least_slope = std::min(least_slope, slope);
            out.faces[i] = (turns ? -1 : 1) / slope * in_plane;
        }
        const Vec3 along{out.faces[0].z, 0, -out.faces[0].x};
        const double off = meeting.count == 2 ? 0 : dot(p - at, along);
        if (std::fabs(off) <= 1e-13 * size_) break;
        next = at + off * along;
    }
    const double difference = std::fabs(norm(out.nearest - p) - norm(start - p));
    if (difference > same_distance * chord_ / least_slope + 1e-12 * size_) return std::nullopt;
    return out;
}

} // namespace fppg
