#include "meshes/point_slabs.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// Cuts lie on multiples of the box's length over this.
constexpr std::size_t steps = 65536;

} // namespace

std::vector<PointSlab> cut_into_slabs(const std::vector<Vec3>& points,
                                      const std::vector<std::uint32_t>& which, std::size_t about,
                                      double thinnest)
{
    Box3 box;
    for (const std::uint32_t i : which) box.add(points[i]);
    const Vec3 size = which.empty() ? Vec3{} : box.max - box.min;
    int axis = 0;
    for (const int other : {1, 2})
        if (size[other] > size[axis]) axis = other;
    const std::size_t slabs = (which.size() + about - 1) / about;
    const double step = size[axis] / static_cast<double>(steps);
    const double thinnest_steps = thinnest / step;
    if (!(step > 0)) return {{.axis = axis, .members = which}};
    const auto step_of = [&](std::uint32_t i)
    {
        const auto at = static_cast<std::size_t>((points[i][axis] - box.min[axis]) / step);
        return std::min(at, steps - 1);
    };
    std::vector<std::size_t> in_step(steps, 0);
    for (const std::uint32_t i : which) ++in_step[step_of(i)];
    std::vector<PointSlab> out(1);
    std::vector<std::size_t> in_slab(1, 0);
    std::vector<std::uint32_t> slab_of_step(steps, 0);
    std::size_t before = 0, last_cut = 0;
    for (std::size_t s = 0; s < steps; ++s)
    {
        if (before * slabs >= which.size() * out.size() &&
            static_cast<double>(std::min(s - last_cut, steps - s)) >= thinnest_steps)
        {
            const double cut = box.min[axis] + step * static_cast<double>(s);
            out.back().high = cut;
            out.emplace_back().low = cut;
            in_slab.push_back(0);
            last_cut = s;
        }
        slab_of_step[s] = static_cast<std::uint32_t>(out.size() - 1);
        before += in_step[s];
        in_slab.back() += in_step[s];
    }
    for (std::size_t k = 0; k < out.size(); ++k)
    {
        out[k].axis = axis;
        out[k].members.reserve(in_slab[k]);
    }
    for (const std::uint32_t i : which) out[slab_of_step[step_of(i)]].members.push_back(i);
    return out;
}

} // namespace fppg
