#include "fppg/motion_gaps.h"

#include "core/parallel.h"
#include "gaps/case_parts.h"
#include "gaps/passages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace fppg
{

namespace
{

constexpr int coarse_looks = 400; // for how fast parts are
constexpr int refining_looks = 40;
constexpr int depth_looks = 12;
constexpr std::size_t most_corners = 20000; // that a depth is asked of

/// The corners farthest along 26 directions: as fast as the fastest of a rigid body, nearly.
std::vector<Vec3> extremes_of(const TriangleSoup& soup)
{
    std::vector<Vec3> out;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
            {
                const Vec3 way{static_cast<double>(x), static_cast<double>(y),
                               static_cast<double>(z)};
                if (x == 0 && y == 0 && z == 0) continue;
                out.push_back(*std::max_element(soup.vertices.begin(), soup.vertices.end(),
                                                [&](const Vec3& a, const Vec3& b)
                                                { return dot(a, way) < dot(b, way); }));
            }
    return out;
}

/// How far the fastest of some places gets along its way; metres.
double way_of(const std::vector<Vec3>& places, const std::function<Transform(double)>& motion,
              double end)
{
    double way = 0;
    std::vector<Vec3> last = places;
    // At odd shares as well: a whole turn a look would be no way.
    for (int step = 0; step < coarse_looks; ++step)
        for (const double share : {0.382, 1.0})
        {
            const Transform place = motion(end * (step + share) / coarse_looks);
            double most = 0;
            for (std::size_t i = 0; i < places.size(); ++i)
            {
                const Vec3 now = place(places[i]);
                most = std::max(most, norm(now - last[i]));
                last[i] = now;
            }
            way += most;
        }
    return way;
}

bool is_in_solid(const CasePart& part, const Vec3& p)
{
    return std::any_of(part.shapes.begin(), part.shapes.end(),
                       [&](const CaseShape* shape)
                       { return shape->is_closed && shape->solid->is_inside(p); });
}

double distance_to(const CasePart& part, const Vec3& p)
{
    double least = std::numeric_limits<double>::infinity();
    for (const CaseShape* shape : part.shapes) least = std::min(least, shape->solid->distance(p));
    return least;
}

/// One pair of mks through the motion.
class PairWatch
{
public:
    PairWatch(const CasePart& first, const CasePart& second, const MotionGaps& gaps,
              const MotionGapOptions& options)
        : first_(first), second_(second), dp_(gaps.dp), end_(gaps.end), options_(options)
    {
        out_.first = first.mkbound;
        out_.second = second.mkbound;
        out_.first_name = first.name;
        out_.second_name = second.name;
    }

    MkGap run()
    {
        const double way = relative_way();
        out_.moves = way > 0;
        if (!out_.moves)
        {
            look(0);
            out_.looks = 1;
        }
        else
        {
            const double wanted = std::ceil(way / (options_.step_dp * dp_));
            const int steps = static_cast<int>(std::clamp<double>(wanted, 8, options_.most_steps));
            out_.step_dp = way / steps / dp_;
            watch(steps);
        }
        find_depth();
        out_.least_dp = least_ / dp_;
        return std::move(out_);
    }

private:
    Transform relative(double time) const
    {
        return inverse_of(first_.place(time)) * second_.place(time);
    }

    /// How far they move against each other at most: each by itself, together; 0 where they keep
    /// their places.
    double relative_way() const
    {
        if (!first_.motion && !second_.motion) return 0;
        const std::vector<Vec3> of_first = extremes_of(first_.tree->soup());
        const std::vector<Vec3> of_second = extremes_of(second_.tree->soup());
        const double size = norm(second_.tree->bounds().max - second_.tree->bounds().min);
        if (!(way_of(
                  of_second, [this](double t) { return relative(t); }, end_) > 1e-6 * size))
            return 0;
        const auto own_way = [this](const std::vector<Vec3>& places, const CasePart& part)
        {
            return part.motion ? way_of(
                                     places, [&](double t) { return part.place(t); }, end_)
                               : 0;
        };
        return own_way(of_first, first_) + own_way(of_second, second_);
    }

    /// The distance at a time, and what it tells of the least; infinite beyond the least and 8 dp.
    double look(double time)
    {
        const SurfaceGap gap = first_.tree->gap_to(*second_.tree, relative(time), least_ + 8 * dp_);
        if (gap.crosses) overlap(time, first_.place(time)(gap.on_first));
        if (gap.distance < least_)
        {
            least_ = gap.distance;
            out_.time = time;
            out_.place = first_.place(time)((gap.on_first + gap.on_second) * 0.5);
        }
        return gap.distance;
    }

    void overlap(double time, const Vec3& place)
    {
        if (out_.overlapping++ == 0)
        {
            out_.overlap_time = time;
            out_.overlap_place = place;
        }
        overlaps_.push_back(time);
    }

    void watch(int steps)
    {
        const double dt = end_ / steps;
        const double way = out_.step_dp * dp_;
        for (int step = 0; step <= steps; ++step)
        {
            const double gap = look(step * dt);
            ++out_.looks;
            // No farther than they move can they come nearer.
            const double spare = std::isfinite(gap) ? gap - least_ : 8 * dp_;
            const double free = std::floor(spare / (1.5 * way)) - 1;
            if (free > 0) step += static_cast<int>(std::min<double>(free, steps));
        }
        if (least_ > 0) refine(dt);
    }

    /// Golden sections around the least.
    void refine(double dt)
    {
        double low = std::max(0.0, out_.time - dt), high = std::min(end_, out_.time + dt);
        constexpr double golden = 0.6180339887498949;
        double a = high - golden * (high - low), b = low + golden * (high - low);
        double at_a = look(a), at_b = look(b);
        for (int k = 0; k < refining_looks && (high - low) / dt * out_.step_dp > 1e-3; ++k)
        {
            if (at_a < at_b)
            {
                high = b;
                b = a;
                at_b = at_a;
                a = high - golden * (high - low);
                at_a = look(a);
            }
            else
            {
                low = a;
                a = b;
                at_a = at_b;
                b = low + golden * (high - low);
                at_b = look(b);
            }
        }
    }

    void find_depth()
    {
        if (overlaps_.empty())
        {
            // One may be whole in the other's solid, without a surface crossing.
            judge_depth(0);
            if (out_.depth_dp > 0) overlap(0, out_.overlap_place);
        }
        const std::size_t n = overlaps_.size();
        for (std::size_t k = 0; k < std::min<std::size_t>(n, depth_looks); ++k)
            judge_depth(overlaps_[k * n / std::min<std::size_t>(n, depth_looks)]);
        if (out_.overlapping > 0) least_ = 0;
    }

    void judge_depth(double time)
    {
        const Transform place = relative(time);
        deepest(second_, first_, place, first_.place(time));
        deepest(first_, second_, inverse_of(place), second_.place(time));
    }

    /// part  its corners, moved by `place`, are looked at in the places of `other`
    void deepest(const CasePart& part, const CasePart& other, const Transform& place,
                 const Transform& to_case)
    {
        const std::vector<Vec3>& corners = part.tree->soup().vertices;
        const Box3& box = other.tree->bounds();
        const auto look = [&](const Vec3& corner)
        {
            const Vec3 p = place(corner);
            bool is_near = true;
            for (int axis = 0; axis < 3; ++axis)
                is_near &= p[axis] >= box.min[axis] && p[axis] <= box.max[axis];
            if (!is_near || !is_in_solid(other, p)) return;
            const double depth = distance_to(other, p) / dp_;
            if (depth <= out_.depth_dp || depth < 1e-6) return;
            out_.depth_dp = depth;
            out_.overlap_place = to_case(p);
        };
        // Corners may all lie in the other one's faces, as those of gears of one width.
        const std::size_t step = corners.size() / most_corners + 1;
        for (std::size_t i = 0; i < corners.size(); i += step) look(corners[i]);
        for (std::size_t f = 0; f < corners.size() / 3; f += step)
            look((corners[3 * f] + corners[3 * f + 1] + corners[3 * f + 2]) / 3);
    }

    const CasePart& first_;
    const CasePart& second_;
    double dp_;
    double end_;
    const MotionGapOptions& options_;
    double least_ = std::numeric_limits<double>::infinity();
    std::vector<double> overlaps_; ///< times
    MkGap out_;
};

} // namespace

MotionGaps measure_motion_gaps(const std::string& definition, const MotionGapOptions& options)
{
    const GapCase of = read_gap_case(definition, options);
    const std::vector<CasePart>& parts = of.parts;
    MotionGaps out;
    out.definition = definition;
    out.dp = of.def.grid.dp;
    out.end = of.end;
    out.notes = of.notes;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t a = 0; a < parts.size(); ++a)
        for (std::size_t b = a + 1; b < parts.size(); ++b) pairs.emplace_back(a, b);
    out.pairs.resize(pairs.size());
    parallel_for(
        pairs.size(), options.threads,
        [&](std::size_t k) {
            out.pairs[k] =
                PairWatch(parts[pairs[k].first], parts[pairs[k].second], out, options).run();
        });
    if (options.finds_passages) find_passages(of.def, of.solids, options.threads, out);
    return out;
}

} // namespace fppg
