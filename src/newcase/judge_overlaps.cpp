#include "newcase/plan.h"

#include "core/transforms.h"
#include "fppg/error.h"
#include "meshes/inside_test.h"
#include "newcase/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace fppg
{

namespace
{

/// Depths below this share of the smaller part's size are those of facets that stand for round
/// surfaces.
constexpr double rounding_share = 3e-3;
/// Shafts overlap their bores by less than this share of it.
constexpr double deep_share = 0.03;
constexpr int turned_places = 12;

/// Corners and middles of facets of one part inside another.
struct Overlap
{
    std::size_t corners = 0;
    std::size_t all = 0;
    double depth = 0; ///< metres below the other one's surface
    Vec3 at;
    std::vector<Vec3> places;
};

Overlap overlap_of(const NewPart& part, const NewPart& other, const InsideTest& inside)
{
    Overlap out;
    const Box3& box = other.box();
    const auto look = [&](const Vec3& p)
    {
        ++out.all;
        bool is_near = true;
        for (int axis = 0; axis < 3; ++axis)
            is_near &= p[axis] >= box.min[axis] && p[axis] <= box.max[axis];
        if (!is_near || !inside.is_inside(p)) return;
        ++out.corners;
        const double depth = inside.query().closest_point(p).distance;
        if (out.places.size() < 200) out.places.push_back(p);
        if (depth <= out.depth) return;
        out.depth = depth;
        out.at = p;
    };
    // Corners may all lie in the other one's faces, as those of gears of one width.
    const std::vector<Vec3>& vertices = part.mesh.vertices;
    for (const Vec3& v : vertices) look(v);
    for (const auto& f : part.mesh.facets)
        look((vertices[f[0]] + vertices[f[1]] + vertices[f[2]]) / 3);
    return out;
}

/// Whether what overlaps stays where it is when the part turns: a shaft in its bore.
bool stays_when_turned(const Overlap& overlap, const AxisLine& axis, const InsideTest& inside)
{
    std::size_t in = 0;
    for (const Vec3& v : overlap.places)
        for (int k = 1; k < turned_places; ++k)
        {
            const double angle = 2 * std::numbers::pi * k / turned_places;
            in += inside.is_inside(around(axis.point, rotation(axis.direction, angle))(v)) ? 1 : 0;
        }
    const auto all = static_cast<double>(overlap.places.size() * (turned_places - 1));
    return static_cast<double>(in) > 0.8 * all;
}

void judge_pair(CasePlan& plan, const PartPair& pair)
{
    const NewPart& a = plan.parts[pair.first];
    const NewPart& b = plan.parts[pair.second];
    if (move_alike(a, b)) return;
    const int threads = plan.options->threads;
    const double rounding =
        rounding_share * std::min(norm(a.box().max - a.box().min), norm(b.box().max - b.box().min));
    for (const bool is_turned : {false, true})
    {
        const NewPart& part = is_turned ? b : a;
        const NewPart& other = is_turned ? a : b;
        if (!other.report.is_watertight) continue;
        const InsideTest inside(other.tree->soup(), threads);
        const Overlap overlap = overlap_of(part, other, inside);
        if (overlap.corners == 0 || overlap.depth < rounding) continue;
        const bool is_whole = overlap.corners == overlap.all && !pair.gap.crosses;
        const NewPart& mover = part.turning ? part : other;
        const bool is_one = part.turning.has_value() != other.turning.has_value();
        if (!is_whole && is_one && stays_when_turned(overlap, mover.turning->axis, inside))
        {
            if (overlap.depth > deep_share / rounding_share * rounding)
                plan.warnings.push_back(fmt::format(
                    "{} overlaps {}, up to {} m deep at {}, all round its axis: meant is a shaft "
                    "in its bore. Expected parts that do not lie in one another.",
                    part.path, other.path, short_number(overlap.depth, 3), place_text(overlap.at)));
            continue;
        }
        const std::string what =
            is_whole ? fmt::format(
                           "{}: the part lies in the solid of {}: its cavity is missing. Export "
                           "{} with its inner walls",
                           part.path, other.path, other.name)
                     : fmt::format(
                           "{}: the part overlaps {}, up to {} m deep at {}, and moves against "
                           "it. Move one of them, turn it by part of a tooth, or export it "
                           "smaller",
                           part.path, other.path, short_number(overlap.depth, 3),
                           place_text(overlap.at));
        if (!plan.options->allows_overlap)
            throw GeometryError(what + "; --allow-overlap takes them as they are");
        plan.warnings.push_back(what + ".");
    }
}

} // namespace

bool move_alike(const NewPart& a, const NewPart& b)
{
    if (!a.moves() && !b.moves()) return true;
    return a.turning && b.turning && a.turning->degrees_per_s == b.turning->degrees_per_s &&
           a.turning->axis.point == b.turning->axis.point &&
           a.turning->axis.direction == b.turning->axis.direction;
}

void judge_overlaps(CasePlan& plan)
{
    for (const PartPair& pair : plan.pairs)
    {
        const Box3& a = plan.parts[pair.first].box();
        const Box3& b = plan.parts[pair.second].box();
        bool are_apart = false;
        for (int axis = 0; axis < 3; ++axis)
            are_apart |= a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis];
        if (!are_apart) judge_pair(plan, pair);
    }
}

} // namespace fppg
