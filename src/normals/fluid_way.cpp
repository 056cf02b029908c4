#include "normals/fluid_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

constexpr std::uint16_t never = 0xFFFF;
constexpr std::uint16_t blocked = 0xFFFE;
constexpr std::int64_t most_cells = std::int64_t{1} << 25;
/// Nodes around all that is drawn. What lies farther out is free and changes no way.
constexpr std::int64_t margin = 4;

struct NodeRange
{
    std::int64_t begin = std::numeric_limits<std::int64_t>::max();
    std::int64_t end = 0;

    void add(std::int64_t first, std::int64_t behind)
    {
        begin = std::min(begin, first);
        end = std::max(end, behind);
    }
};

/// Nodes along each axis between which something is drawn, with a margin; all along periodic ones.
std::array<NodeRange, 3> drawn_nodes(const RunField& field)
{
    std::array<NodeRange, 3> out;
    for (std::size_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& run : field.slabs[x])
        {
            const auto at = static_cast<std::int64_t>(x);
            out[0].add(at, at + 1);
            out[1].add(run.y, std::int64_t{run.y} + 1);
            out[2].add(run.z_begin, run.z_end);
        }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::int64_t n = field.grid.n[axis];
        const bool is_whole = field.grid.is_periodic[axis] || out[axis].end == 0;
        out[axis].begin = is_whole ? 0 : std::max<std::int64_t>(out[axis].begin - margin, 0);
        out[axis].end = is_whole ? n : std::min(out[axis].end + margin, n);
    }
    return out;
}

} // namespace

template <typename IsBound>
FluidWay::FluidWay(const RunField& field, std::uint16_t first_bound, const IsBound& is_bound)
    : grid_(field.grid)
{
    const std::array<NodeRange, 3> drawn = drawn_nodes(field);
    for (std::size_t axis = 0; axis < 3; ++axis) first_[axis] = drawn[axis].begin;
    const auto cells = [&](std::size_t axis)
    { return (drawn[axis].end - drawn[axis].begin + side_ - 1) / side_; };
    while (cells(0) * cells(1) * cells(2) > most_cells) ++side_;
    n_ = {cells(0), cells(1), cells(2)};
    steps_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), never);
    for (std::int64_t x = 0; x < std::int64_t{grid_.n[0]}; ++x)
        for (const Run& run : field.slabs[static_cast<std::size_t>(x)])
        {
            if (run.mk < first_bound)
                mark(x, run, 0);
            else if (is_bound(run.mk))
                mark(x, run, blocked);
        }
    for (const GapParticle& gap : field.walls.gaps)
    {
        const Vec3 at = grid_.steps_to(gap.place);
        std::array<std::int64_t, 3> cell{};
        bool is_on_grid = true;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto k = static_cast<std::size_t>(axis);
            cell[k] = (std::llround(at[axis]) - first_[k]) / side_;
            is_on_grid = is_on_grid && cell[k] >= 0 && cell[k] < n_[k];
        }
        if (is_on_grid) steps_[index(cell[0], cell[1], cell[2])] = blocked;
    }
    has_fluid_ = std::find(steps_.begin(), steps_.end(), 0) != steps_.end();
}

FluidWay::FluidWay(const RunField& field, std::uint16_t first_bound, const Vec3& gravity)
    : FluidWay(field, first_bound, [](std::uint16_t) { return true; })
{
    for (int axis = 0; axis < 3; ++axis)
        if (gravity[axis] != 0 &&
            (up_axis_ < 0 || std::fabs(gravity[axis]) > std::fabs(gravity[up_axis_])))
            up_axis_ = axis;
    is_up_negative_ = up_axis_ >= 0 && gravity[up_axis_] > 0;
    measure_heights();
    measure_lengths();
    find_what_runs_out(field.grid);
}

FluidWay FluidWay::around(const RunField& field, std::uint16_t first_bound, std::uint16_t mk)
{
    FluidWay out(field, first_bound, [mk](std::uint16_t of) { return of == mk; });
    out.measure_lengths();
    return out;
}

void FluidWay::mark(std::int64_t x, const Run& run, std::uint16_t steps)
{
    const auto cell_of = [&](std::int64_t node, std::size_t axis)
    { return (node - first_[axis]) / side_; };
    for (std::int64_t z = cell_of(run.z_begin, 2); z <= cell_of(std::int64_t{run.z_end} - 1, 2);
         ++z)
    {
        std::uint16_t& cell = steps_[index(cell_of(x, 0), cell_of(run.y, 1), z)];
        if (steps == blocked || cell == never) cell = steps;
    }
}

std::array<std::int64_t, 3> FluidWay::place(std::size_t cell) const
{
    const auto at = static_cast<std::int64_t>(cell);
    return {at / (n_[1] * n_[2]), at / n_[2] % n_[1], at % n_[2]};
}

std::uint16_t FluidWay::height(std::size_t cell) const
{
    if (up_axis_ < 0) return 0;
    const auto axis = static_cast<std::size_t>(up_axis_);
    const std::int64_t at = place(cell)[axis];
    return static_cast<std::uint16_t>(
        std::min<std::int64_t>(is_up_negative_ ? n_[axis] - 1 - at : at, never));
}

template <typename Visit>
void FluidWay::for_each_beside(std::size_t cell, const Visit& visit) const
{
    const std::array<std::int64_t, 3> at = place(cell);
    const std::array<std::size_t, 3> stride = {static_cast<std::size_t>(n_[1] * n_[2]),
                                               static_cast<std::size_t>(n_[2]), 1};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const int rise = static_cast<int>(axis) != up_axis_ ? 0 : is_up_negative_ ? -1 : 1;
        if (at[axis] > 0) visit(cell - stride[axis], -rise);
        if (at[axis] + 1 < n_[axis]) visit(cell + stride[axis], rise);
    }
}

/// The height of a way is that of its highest cell; cells are taken in the order of the least.
void FluidWay::measure_heights()
{
    heights_.assign(steps_.size(), never);
    std::vector<Cells> todo(
        up_axis_ < 0 ? 1 : static_cast<std::size_t>(n_[static_cast<std::size_t>(up_axis_)]));
    for (std::size_t cell = 0; cell < steps_.size(); ++cell)
    {
        if (steps_[cell] != 0) continue;
        heights_[cell] = height(cell);
        top_ = std::max(top_, heights_[cell]);
        todo[heights_[cell]].push_back(cell);
    }
    for (std::size_t now = 0; now < todo.size(); ++now)
        while (!todo[now].empty())
        {
            const std::size_t cell = todo[now].back();
            todo[now].pop_back();
            if (heights_[cell] < now) continue;
            const int own = height(cell);
            for_each_beside(cell,
                            [&](std::size_t next, int rise)
                            {
                                const auto there = static_cast<std::uint16_t>(
                                    std::max(static_cast<int>(now), own + rise));
                                if (steps_[next] == blocked || heights_[next] <= there) return;
                                heights_[next] = there;
                                todo[there].push_back(next);
                            });
        }
}

void FluidWay::measure_lengths()
{
    Cells front;
    for (std::size_t cell = 0; cell < steps_.size(); ++cell)
        if (steps_[cell] == 0) front.push_back(cell);
    for (std::uint16_t step = 1; !front.empty() && step < blocked; ++step)
    {
        Cells next;
        for (const std::size_t cell : front)
            for_each_beside(cell,
                            [&](std::size_t there, int)
                            {
                                if (steps_[there] != never) return;
                                steps_[there] = step;
                                next.push_back(there);
                            });
        front.swap(next);
    }
}

/// From the open sides of the lattice, but the upper one and periodic ones, against the way that
/// water runs.
void FluidWay::find_what_runs_out(const LatticeGrid& grid)
{
    runs_out_.assign(steps_.size(), 0);
    Cells todo;
    const auto add = [&](std::size_t cell)
    {
        if (steps_[cell] == blocked || runs_out_[cell] != 0) return;
        runs_out_[cell] = 1;
        todo.push_back(cell);
    };
    for (std::size_t cell = 0; cell < steps_.size(); ++cell)
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (grid.is_periodic[axis] || (grid.is_2d && axis == 1)) continue;
            const bool has_up = static_cast<int>(axis) == up_axis_;
            const std::int64_t at = place(cell)[axis];
            if ((at == 0 && !(has_up && is_up_negative_)) ||
                (at == n_[axis] - 1 && !(has_up && !is_up_negative_)))
                add(cell);
        }
    while (!todo.empty())
    {
        const std::size_t cell = todo.back();
        todo.pop_back();
        for_each_beside(cell,
                        [&](std::size_t from, int rise)
                        {
                            if (rise >= 0) add(from);
                        });
    }
}

FluidWay::Way FluidWay::to(const Vec3& p) const
{
    std::array<std::int64_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<int>(axis);
        const double node = std::clamp((p[a] - grid_.origin[a]) / grid_.step(a), -1e9, 1e9) -
                            static_cast<double>(first_[axis]);
        at[axis] = std::llround(node / side_ - 0.5 * (1 - 1.0 / side_));
        // Surfaces go on beyond periodic limits, and those of a case in 2D across its plane.
        if (grid_.is_2d && axis == 1) at[axis] = 0;
        if (grid_.is_periodic[axis]) at[axis] = std::clamp<std::int64_t>(at[axis], 0, n_[axis] - 1);
    }
    std::uint16_t steps = never;
    std::uint16_t highest = never;
    Way out;
    for (std::int64_t x = at[0] - 1; x <= at[0] + 1; ++x)
        for (std::int64_t y = at[1] - 1; y <= at[1] + 1; ++y)
            for (std::int64_t z = at[2] - 1; z <= at[2] + 1; ++z)
            {
                if (x < 0 || y < 0 || z < 0 || x >= n_[0] || y >= n_[1] || z >= n_[2]) continue;
                const std::size_t cell = index(x, y, z);
                if (steps_[cell] == blocked) continue;
                out.is_free = true;
                if (steps_[cell] < blocked) steps = std::min(steps, steps_[cell]);
                if (heights_.empty()) continue;
                out.runs_out = out.runs_out || runs_out_[cell] != 0;
                highest = std::min(highest, heights_[cell]);
            }
    if (!has_fluid_) return out;
    out.length = steps == never ? std::numeric_limits<double>::infinity()
                                : static_cast<double>(side_) * steps;
    if (!heights_.empty() && highest > top_)
        out.rise = static_cast<double>(side_) * (highest - top_);
    return out;
}

} // namespace fppg
