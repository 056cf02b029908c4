#include "offset/round_wall.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fppg
{
namespace
{

constexpr int newton_steps = 8;
/// Steps along the surface to the nearest place; each gains about depth over radius.
constexpr int slide_steps = 60;

/// Facets and surface agree on a distance to this, in chord errors.
constexpr double same_distance = 1.5;

} // namespace

RoundWall::RoundWall(const SurfaceMesh& mesh, std::shared_ptr<const RoundSurface> round, bool is_2d)
    : round_(std::move(round)), is_2d_(is_2d), axis_(round_->cover_normal)
{
    const Vec3 axis = axis_;
    const bool has_axis = !(axis == Vec3{});
    if (has_axis)
    {
        end_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const Vec3& v : mesh.vertices)
            end_ = {std::min(end_[0], dot(v, axis)), std::max(end_[1], dot(v, axis))};
    }
    double looks_out = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const auto& corners = mesh.facets[f];
        const Vec3& a = mesh.vertices[corners[0]];
        const Vec3& normal = mesh.normals[f];
        if (has_axis && std::fabs(dot(normal, axis)) > 0.5)
        {
            const std::size_t end = dot(a, axis) < 0.5 * (end_[0] + end_[1]) ? 0 : 1;
            has_cover_[end] = true;
            cover_normal_[end] = dot(normal, axis) < 0 ? -axis : axis;
            continue;
        }
        has_tube_ = true;
        Vec3 middle;
        for (std::size_t c = 0; c < 3; ++c)
        {
            const Vec3& p = mesh.vertices[corners[c]];
            const Vec3& q = mesh.vertices[corners[(c + 1) % 3]];
            middle = middle + p / 3;
            const Level level = round_->level_at(0.5 * (p + q));
            chord_ = std::max(chord_, std::fabs(level.value) / norm(level.gradient));
        }
        const Level level = round_->level_at(middle);
        chord_ = std::max(chord_, std::fabs(level.value) / norm(level.gradient));
        looks_out += mesh.areas[f] * dot(level.gradient, normal);
    }
    sense_ = looks_out < 0 ? -1 : 1;
    if (is_2d_) axis_.y = 0;
    has_ends_ = norm(axis_) > 1e-6;
    if (!has_ends_) has_cover_ = {false, false};
}

Level RoundWall::level_in_plane(const Vec3& p) const
{
    Level level = round_->level_at(p);
    if (is_2d_) level.gradient.y = 0;
    return level;
}

double RoundWall::along(const Vec3& p) const
{
    return dot(p, round_->cover_normal);
}

/// By Newton's method; false where the surface has no way towards it.
bool RoundWall::put_on_surface(Vec3& p) const
{
    for (int step = 0; step < newton_steps; ++step)
    {
        const Level level = level_in_plane(p);
        const double rate = dot(level.gradient, level.gradient);
        if (!(rate > 1e-6)) return false;
        p = p - level.gradient * (level.value / rate);
        if (std::fabs(level.value) <= 1e-15 * round_->size) break;
    }
    return true;
}

/// The same in the plane of a cover.
bool RoundWall::put_on_rim(Vec3& p, int end) const
{
    const auto e = static_cast<std::size_t>(end);
    p = p + axis_ * ((end_[e] - along(p)) / dot(axis_, axis_));
    const Vec3 line = is_2d_ ? unit(Vec3{axis_.z, 0, -axis_.x}) : Vec3{};
    for (int step = 0; step < newton_steps; ++step)
    {
        const Level level = round_->level_at(p);
        const Vec3 way = is_2d_ ? line * dot(line, level.gradient) : level.gradient;
        const double rate = dot(way, level.gradient);
        if (!(rate > 1e-6)) return false;
        p = p - way * (level.value / rate);
        if (std::fabs(level.value) <= 1e-15 * round_->size) break;
    }
    return true;
}

RoundWall::Candidate RoundWall::on_tube(const Vec3& p, const Vec3& start) const
{
    Candidate out;
    if (!has_tube_) return out;
    out.point = round_->is_distance ? p : start;
    if (!put_on_surface(out.point)) return out;
    // Along the tangent plane at the foot to the point below p, until that stays.
    for (int step = 0; step < slide_steps && (is_2d_ || !round_->is_distance); ++step)
    {
        const Vec3 normal = unit(level_in_plane(out.point).gradient);
        Vec3 next = p - normal * dot(p - out.point, normal);
        if (!put_on_surface(next)) return out;
        const double moved = norm(next - out.point);
        out.point = next;
        if (moved <= 1e-12 * round_->size) break;
    }
    out.is_found = true;
    if (!has_ends_) return out;
    const double at = along(out.point);
    const double room = 1e-12 * round_->size;
    if (at < end_[0] - room)
        out.rim = 0;
    else if (at > end_[1] + room)
        out.rim = 1;
    if (out.rim >= 0) out.is_found = put_on_rim(out.point, out.rim);
    return out;
}

RoundWall::Candidate RoundWall::on_cover(const Vec3& p, int end) const
{
    const auto e = static_cast<std::size_t>(end);
    Candidate out;
    if (!has_cover_[e]) return out;
    out.point = p + axis_ * ((end_[e] - along(p)) / dot(axis_, axis_));
    out.is_found = true;
    if (round_->level_at(out.point).value <= 1e-12 * round_->size) return out;
    out.rim = end;
    out.is_found = put_on_rim(out.point, end);
    return out;
}

Vec3 RoundWall::tube_normal(const Vec3& p) const
{
    return sense_ * unit(level_in_plane(p).gradient);
}

std::optional<ExactPlace> RoundWall::at(const Vec3& p, const Vec3& start) const
{
    const std::array<Candidate, 3> candidates{on_tube(p, start), on_cover(p, 0), on_cover(p, 1)};
    std::size_t best = candidates.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < candidates.size(); ++i)
    {
        if (!candidates[i].is_found) continue;
        const double distance = norm(candidates[i].point - p);
        if (!(distance < least)) continue;
        least = distance;
        best = i;
    }
    if (best == candidates.size()) return std::nullopt;
    if (std::fabs(least - norm(start - p)) > same_distance * chord_ + 1e-12 * round_->size)
        return std::nullopt;
    const Candidate& found = candidates[best];
    ExactPlace out;
    out.nearest = found.point;
    const auto normal_of_cover = [&](int end)
    {
        Vec3 normal = cover_normal_[static_cast<std::size_t>(end)];
        if (is_2d_) normal.y = 0;
        return unit(normal);
    };
    if (found.rim < 0)
    {
        out.faces[0] =
            best == 0 ? tube_normal(found.point) : normal_of_cover(static_cast<int>(best) - 1);
        return out;
    }
    const bool has_cover = has_cover_[static_cast<std::size_t>(found.rim)];
    out.face_count = has_tube_ && has_cover ? 2 : 1;
    out.is_beyond_rim = out.face_count == 1;
    if (has_tube_) out.faces[0] = tube_normal(found.point);
    if (has_cover) out.faces[has_tube_ ? 1 : 0] = normal_of_cover(found.rim);
    return out;
}

} // namespace fppg
