#include "nodes/upward_field.h"

#include "core/parallel.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace fppg
{

std::optional<UpAxis> up_axis(const Vec3& gravity)
{
    std::optional<UpAxis> out;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (gravity[axis] == 0) continue;
        if (out) return {};
        out = UpAxis{axis, gravity[axis] < 0};
    }
    return out;
}

UpwardField::UpwardField(const RunField& field, const UpAxis& up, int threads)
    : up_(up), across_(up.axis == 0 ? 1 : 0), along_(up.axis == 2 ? 1 : 2), field_(&field)
{
    if (up.is_z()) return;
    const LatticeGrid& from = field.grid;
    const auto n = [&](int axis) { return from.n[static_cast<std::size_t>(axis)]; };
    last_ = static_cast<std::int64_t>(n(up.axis)) - 1;
    const auto made = std::make_shared<RunField>();
    LatticeGrid& grid = made->grid;
    grid.dp = from.dp;
    grid.is_2d = from.is_2d;
    grid.n = {n(across_), n(along_), n(up.axis)};
    grid.stretch = {from.stretch[across_], from.stretch[along_], from.stretch[up.axis]};
    Vec3 lowest = from.origin;
    if (!up.is_positive) lowest[up.axis] += static_cast<double>(last_) * from.step(up.axis);
    grid.origin = turned(lowest);
    made->slabs.resize(grid.n[0]);
    parallel_for(
        made->slabs.size(), threads,
        [&](std::size_t slab) { made->slabs[slab] = runs_of_slab(field, slab); }, 4);
    turned_ = made;
    field_ = turned_.get();
}

Vec3 UpwardField::turned(const Vec3& p) const
{
    return {p[across_], p[along_], up_.is_positive ? p[up_.axis] : -p[up_.axis]};
}

Node UpwardField::turned(const Node& node) const
{
    return {node[across_], node[along_], up_.is_positive ? node[up_.axis] : last_ - node[up_.axis]};
}

Vec3 UpwardField::turned_back(const Vec3& p) const
{
    Vec3 out;
    out[across_] = p.x;
    out[along_] = p.y;
    out[up_.axis] = up_.is_positive ? p.z : -p.z;
    return out;
}

/// The runs at one place along the axis that becomes x.
std::vector<Run> UpwardField::runs_of_slab(const RunField& field, std::size_t slab) const
{
    std::vector<Run> nodes; // runs of one
    const auto take = [&](std::size_t x, const Run& run)
    {
        for (std::uint32_t z = run.z_begin; z < run.z_end; ++z)
        {
            const Node at = turned(Node{static_cast<std::int64_t>(x), run.y, z});
            const auto height = static_cast<std::uint32_t>(at.z);
            nodes.push_back(
                {static_cast<std::uint32_t>(at.y), height, height + 1, run.mk, run.is_covered});
        }
    };
    if (across_ == 0)
        for (const Run& run : field.slabs[slab]) take(slab, run);
    else
        for (std::size_t x = 0; x < field.slabs.size(); ++x)
        {
            const std::vector<Run>& runs = field.slabs[x];
            const auto y = static_cast<std::uint32_t>(slab);
            auto run = std::lower_bound(runs.begin(), runs.end(), y,
                                        [](const Run& r, std::uint32_t v) { return r.y < v; });
            for (; run != runs.end() && run->y == y; ++run) take(x, *run);
        }
    std::sort(nodes.begin(), nodes.end(),
              [](const Run& a, const Run& b)
              { return std::tie(a.y, a.z_begin) < std::tie(b.y, b.z_begin); });
    std::vector<Run> out;
    for (const Run& node : nodes)
        if (!out.empty() && out.back().y == node.y && out.back().z_end == node.z_begin &&
            out.back().mk == node.mk && out.back().is_covered == node.is_covered)
            ++out.back().z_end;
        else
            out.push_back(node);
    return out;
}

} // namespace fppg
