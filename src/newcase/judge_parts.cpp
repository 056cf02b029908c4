#include "newcase/plan.h"

#include "core/length_units.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fppg
{

namespace
{

/// A part so much larger or smaller than the middle one is in other units, or no part of this case.
constexpr double other_unit_ratio = 100;
/// So many sizes of all others away, a part is not where it was meant to be.
constexpr double far_sizes = 3;

double diagonal(const Box3& box)
{
    return norm(box.max - box.min);
}

double distance_between(const Box3& a, const Box3& b)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double away = std::max({a.min[axis] - b.max[axis], b.min[axis] - a.max[axis], 0.0});
        sum += away * away;
    }
    return std::sqrt(sum);
}

Box3 box_of_others(const CasePlan& plan, std::size_t without)
{
    Box3 box;
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
    {
        if (i == without) continue;
        box.add(plan.parts[i].box().min);
        box.add(plan.parts[i].box().max);
    }
    return box;
}

std::string size_text(const Vec3& size)
{
    return fmt::format("{} x {} x {} m", short_number(size.x), short_number(size.y),
                       short_number(size.z));
}

void refuse_other_units(const CasePlan& plan)
{
    std::vector<double> sizes;
    for (const NewPart& part : plan.parts) sizes.push_back(diagonal(part.box()));
    if (sizes.size() < 2) return;
    std::vector<double> sorted = sizes;
    std::sort(sorted.begin(), sorted.end());
    const double middle = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
        const NewPart& part = plan.parts[i];
        const double ratio = sizes[i] / middle;
        if (ratio > 1 / other_unit_ratio && ratio < other_unit_ratio) continue;
        std::string fit;
        for (const char* unit : {"m", "cm", "mm", "in"})
        {
            const double by = metres_of_unit(unit) / part.metre;
            if (ratio * by < 0.02 || ratio * by > 50 || unit == part.unit) continue;
            const Box3 box{part.box().min * by, part.box().max * by};
            const Box3 others = box_of_others(plan, i);
            if (distance_between(box, others) > diagonal(others)) continue;
            fit = fmt::format("; in {0} it would be {1} and stand among the others: --unit {2}={0}",
                              unit, size_text(box.max - box.min), part.name);
            break;
        }
        throw GeometryError(fmt::format(
            "{}: in {} the part is {} at {}, {} times {} than the others are ({} m across in the "
            "middle): is it in another unit?{}",
            part.path, part.unit, size_text(part.box().max - part.box().min),
            place_text((part.box().min + part.box().max) * 0.5),
            short_number(ratio > 1 ? ratio : 1 / ratio, 3), ratio > 1 ? "larger" : "smaller",
            short_number(middle),
            fit.empty() ? "; --unit PART=mm says so, or leave the file out" : fit));
    }
}

void refuse_far(const CasePlan& plan)
{
    if (plan.options->allows_far || plan.parts.size() < 2) return;
    for (std::size_t i = 0; i < plan.parts.size(); ++i)
    {
        const NewPart& part = plan.parts[i];
        const Box3 others = box_of_others(plan, i);
        const double away = distance_between(part.box(), others);
        const double size = std::max(diagonal(others), diagonal(part.box()));
        if (away <= far_sizes * size) continue;
        throw GeometryError(fmt::format(
            "{}: the part is at {}, {} m from all others, which are {} in size at {}: expected "
            "parts in their places in one assembly. Export it in its place, leave it out, or give "
            "--allow-far",
            part.path, place_text((part.box().min + part.box().max) * 0.5), short_number(away),
            size_text(others.max - others.min), place_text((others.min + others.max) * 0.5)));
    }
}

} // namespace

void judge_parts(CasePlan& plan)
{
    refuse_other_units(plan);
    refuse_far(plan);
    for (const NewPart& part : plan.parts)
    {
        for (const std::string& warning : part.report.warnings)
            plan.file_warnings.push_back(fmt::format("{}: {}", part.path, warning));
        if (diagonal(part.box()) > 0 && part.report.area > 0) continue;
        throw GeometryError(fmt::format("{}: the part has no extent", part.path));
    }
}

void measure_pairs(CasePlan& plan)
{
    for (std::size_t a = 0; a < plan.parts.size(); ++a)
        for (std::size_t b = a + 1; b < plan.parts.size(); ++b)
        {
            PartPair pair;
            pair.first = a;
            pair.second = b;
            pair.gap = plan.parts[a].tree->gap_to(*plan.parts[b].tree, {});
            const double size =
                std::min(diagonal(plan.parts[a].box()), diagonal(plan.parts[b].box()));
            pair.touches = pair.gap.crosses || pair.gap.distance < 1e-4 * size;
            plan.pairs.push_back(pair);
        }
}

const PartPair& CasePlan::pair(std::size_t a, std::size_t b) const
{
    const std::size_t low = std::min(a, b), high = std::max(a, b), n = parts.size();
    return pairs[low * n - low * (low + 1) / 2 + high - low - 1];
}

} // namespace fppg
