#include "check/fill_nodes.h"

#include "check/spilled_nodes.h"
#include "core/parallel.h"

#include <atomic>
#include <map>

namespace fppg
{

namespace
{

constexpr std::size_t marks_per_chunk = 4096;
constexpr double most_columns = 1U << 28U;
/// Nodes beyond the box, 4h: of 6 dp are 24 of them.
constexpr double most_beyond = 512;

/// Spans of nodes by columns, which may overlap.
struct NodeSpans
{
    std::vector<std::uint64_t> begins;
    std::vector<FillNodes::NodeRun> spans; ///< in a column by their begin
};

/// mark(i, emit) calls emit(column, first z, last z) for what particle i marks, twice the same.
template <typename Mark>
NodeSpans collect_spans(std::size_t columns, std::size_t count, int threads, const Mark& mark)
{
    std::vector<std::uint32_t> counts(columns, 0);
    parallel_for(
        count, threads,
        [&](std::size_t i)
        {
            mark(i,
                 [&](std::size_t column, std::int64_t z0, std::int64_t z1)
                 {
                     if (z0 <= z1)
                         std::atomic_ref(counts[column]).fetch_add(1, std::memory_order_relaxed);
                 });
        },
        marks_per_chunk);
    NodeSpans out;
    out.begins.assign(columns + 1, 0);
    for (std::size_t c = 0; c < columns; ++c) out.begins[c + 1] = out.begins[c] + counts[c];
    out.spans.resize(out.begins[columns]);
    parallel_for(
        count, threads,
        [&](std::size_t i)
        {
            mark(i,
                 [&](std::size_t column, std::int64_t z0, std::int64_t z1)
                 {
                     if (z0 > z1) return;
                     const std::uint32_t left =
                         std::atomic_ref(counts[column]).fetch_sub(1, std::memory_order_relaxed);
                     out.spans[out.begins[column] + left - 1] = {
                         static_cast<std::uint32_t>(z0), static_cast<std::uint32_t>(z1 + 1)};
                 });
        },
        marks_per_chunk);
    // What is marked does not depend on the order; the order is made one all the same.
    parallel_for(
        columns, threads,
        [&](std::size_t c)
        {
            std::sort(out.spans.begin() + static_cast<std::ptrdiff_t>(out.begins[c]),
                      out.spans.begin() + static_cast<std::ptrdiff_t>(out.begins[c + 1]),
                      [](const FillNodes::NodeRun& a, const FillNodes::NodeRun& b)
                      { return a.begin != b.begin ? a.begin < b.begin : a.end < b.end; });
        },
        marks_per_chunk);
    return out;
}

/// Calls keep(run) for what the spans leave of the runs of a column.
template <typename Keep>
void for_each_left(const FillNodes& nodes, const NodeSpans& spans, std::size_t column,
                   const Keep& keep)
{
    std::uint64_t s = spans.begins[column];
    for (std::uint64_t r = nodes.begins[column]; r < nodes.begins[column + 1]; ++r)
    {
        std::uint32_t begin = nodes.runs[r].begin;
        const std::uint32_t end = nodes.runs[r].end;
        for (; s < spans.begins[column + 1] && spans.spans[s].begin < end; ++s)
        {
            if (spans.spans[s].begin > begin) keep(FillNodes::NodeRun{begin, spans.spans[s].begin});
            begin = std::max(begin, spans.spans[s].end);
            if (begin >= end) break; // the span may reach into the next run
        }
        if (begin < end) keep(FillNodes::NodeRun{begin, end});
    }
}

void take_away(FillNodes& nodes, const NodeSpans& spans, int threads)
{
    const std::size_t columns = nodes.begins.size() - 1;
    std::vector<std::uint64_t> begins(columns + 1, 0);
    const auto for_columns = [&](const auto& body)
    { parallel_for(columns, threads, body, marks_per_chunk); };
    for_columns(
        [&](std::size_t c)
        { for_each_left(nodes, spans, c, [&](const FillNodes::NodeRun&) { ++begins[c + 1]; }); });
    for (std::size_t c = 0; c < columns; ++c) begins[c + 1] += begins[c];
    std::vector<FillNodes::NodeRun> runs(begins[columns]);
    for_columns(
        [&](std::size_t c)
        {
            std::uint64_t at = begins[c];
            for_each_left(nodes, spans, c,
                          [&](const FillNodes::NodeRun& run) { runs[at++] = run; });
        });
    nodes.begins = std::move(begins);
    nodes.runs = std::move(runs);
}

/// Nodes within `radius` of p, as spans.
template <typename Emit>
void emit_ball(const FillNodes& nodes, const Vec3& p, double radius, const Emit& emit)
{
    const std::int64_t x1 = nodes.last(p.x + radius, 0), y1 = nodes.last(p.y + radius, 1);
    for (std::int64_t x = nodes.first(p.x - radius, 0); x <= x1; ++x)
        for (std::int64_t y = nodes.first(p.y - radius, 1); y <= y1; ++y)
        {
            const double dx = nodes.origin.x + static_cast<double>(x) * nodes.dp - p.x;
            const double dy = nodes.origin.y + static_cast<double>(y) * nodes.dp - p.y;
            const double left = radius * radius - dx * dx - dy * dy;
            if (left < 0) continue;
            emit(static_cast<std::size_t>(x * nodes.n[1] + y),
                 nodes.first(p.z - std::sqrt(left), 2), nodes.last(p.z + std::sqrt(left), 2));
        }
}

/// Nodes in the cylinder around a normal, up to 0.5 dp beyond the surface.
template <typename Emit>
void emit_cylinder(const FillNodes& nodes, const Vec3& p, const Vec3& normal, const Emit& emit)
{
    const double radius = 0.7 * nodes.dp;
    const double length = norm(normal);
    const Vec3 axis = normal / length;
    const double top = length + 0.499 * nodes.dp;
    std::array<std::int64_t, 3> begin, end;
    for (int a = 0; a < 3; ++a)
    {
        const double reach = top * axis[a];
        begin[static_cast<std::size_t>(a)] = nodes.first(p[a] + std::min(0.0, reach) - radius, a);
        end[static_cast<std::size_t>(a)] = nodes.last(p[a] + std::max(0.0, reach) + radius, a);
    }
    // Nested because nodes have three indices.
    for (std::int64_t x = begin[0]; x <= end[0]; ++x)
        for (std::int64_t y = begin[1]; y <= end[1]; ++y)
            for (std::int64_t z = begin[2]; z <= end[2]; ++z)
            {
                const Vec3 way =
                    nodes.origin +
                    Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} *
                        nodes.dp -
                    p;
                const double along = dot(way, axis);
                const double across = dot(way, way) - along * along;
                if (along >= 0 && along < top && across <= radius * radius)
                    emit(static_cast<std::size_t>(x * nodes.n[1] + y), z, z);
            }
}

/// All nodes of a new lattice, those in the box and those beyond each side as runs of their own.
void add_all_runs(FillNodes& nodes)
{
    const auto begin = static_cast<std::uint32_t>(nodes.beyond[2]);
    const auto end = static_cast<std::uint32_t>(nodes.n[2] - nodes.beyond[2]);
    if (begin == end) return;
    const auto columns = static_cast<std::size_t>(nodes.n[0] * nodes.n[1]);
    nodes.begins.assign(columns + 1, 0);
    for (std::size_t c = 0; c < columns; ++c)
    {
        const auto [x, y] = nodes.xy_of(c);
        const bool is_beyond_x = x < nodes.beyond[0] || x >= nodes.n[0] - nodes.beyond[0];
        const bool is_beyond_y = y < nodes.beyond[1] || y >= nodes.n[1] - nodes.beyond[1];
        if (!is_beyond_x && !is_beyond_y && begin > 0) nodes.runs.push_back({0, begin});
        if (!(is_beyond_x && is_beyond_y)) nodes.runs.push_back({begin, end});
        if (!is_beyond_x && !is_beyond_y && begin > 0) nodes.runs.push_back({end, end + begin});
        nodes.begins[c + 1] = nodes.runs.size();
    }
}

/// How far most of some of the particles are from nodes at multiples of dp, along one axis.
double usual_phase(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& of,
                   int axis, double dp)
{
    std::map<long, std::pair<std::size_t, double>> votes;
    const std::size_t step = std::max<std::size_t>(1, of.size() / 2000);
    for (std::size_t k = 0; k < of.size(); k += step)
    {
        const double at = positions[of[k]][axis] / dp;
        const double phase = at - std::floor(at);
        auto& vote = votes[std::lround(100 * phase) % 100];
        if (vote.first++ == 0) vote.second = phase;
    }
    std::size_t most = 0;
    double phase = 0;
    for (const auto& [ignored, vote] : votes)
        if (vote.first > most)
        {
            most = vote.first;
            phase = vote.second;
        }
    return phase * dp;
}

/// A lattice over the box of all boundary particles, and slabs beyond its sides. Runs do not cross
/// the sides; edges and corners between slabs have none.
FillNodes whole_box(const CheckParticles& particles, const CheckSetup& setup,
                    const std::vector<std::uint32_t>& walls,
                    const std::vector<std::uint32_t>& fluid)
{
    FillNodes nodes;
    nodes.dp = setup.dp;
    Box3 box;
    for (const std::uint32_t i : walls) box.add(particles.positions[i]);
    const double beyond = std::ceil(4 * setup.h / setup.dp);
    if (box.is_empty() || !(beyond <= most_beyond)) return nodes;
    double columns = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double phase =
            usual_phase(particles.positions, fluid.empty() ? walls : fluid, axis, setup.dp);
        const double begin = std::ceil((box.min[axis] - phase) / setup.dp - 1e-6);
        const double end = std::floor((box.max[axis] - phase) / setup.dp + 1e-6);
        nodes.origin[axis] = phase + begin * setup.dp;
        const bool is_flat = setup.is_2d && axis == 1;
        const auto a = static_cast<std::size_t>(axis);
        if (!is_flat && !setup.is_periodic[a]) nodes.beyond[a] = static_cast<std::int64_t>(beyond);
        nodes.origin[axis] -= static_cast<double>(nodes.beyond[a]) * setup.dp;
        const double count = (is_flat ? 1 : std::max(0.0, end - begin + 1)) +
                             2 * static_cast<double>(nodes.beyond[a]);
        if (axis == 2 ? count > UINT32_MAX - 2.0 : (columns *= count) > most_columns)
        {
            nodes.n = {};
            return nodes;
        }
        nodes.n[a] = static_cast<std::int64_t>(count);
    }
    if (setup.is_2d) nodes.origin.y = box.min.y;
    add_all_runs(nodes);
    return nodes;
}

/// Where fluid comes to a side of the box, a row of nodes along the side each: wet nodes and those
/// `spread` or fewer from them. Rows of the sides across x stand at y, those across y at x; those
/// across z are columns of the box, with a span of one node.
struct OpenSide
{
    std::vector<std::vector<FillNodes::NodeRun>> rows;

    void add(std::int64_t row, std::int64_t spread, const FillNodes::NodeRun& run)
    {
        const auto last = static_cast<std::int64_t>(rows.size()) - 1;
        const auto by = static_cast<std::uint32_t>(spread);
        for (std::int64_t r = std::max<std::int64_t>(0, row - spread);
             r <= std::min(last, row + spread); ++r)
            rows[static_cast<std::size_t>(r)].push_back(
                {run.begin > by ? run.begin - by : 0, run.end + by});
    }
};

/// The six sides in the order of side_of(). Rows of the sides across z stand at x, their spans are
/// along y.
std::array<OpenSide, 6> open_sides(const FillNodes& nodes, const std::vector<std::uint8_t>& wet,
                                   std::int64_t spread)
{
    std::array<OpenSide, 6> sides;
    for (std::size_t side = 0; side < 6; ++side)
        sides[side].rows.resize(static_cast<std::size_t>(nodes.n[side < 2 ? 1 : 0]));
    for (std::size_t c = 0; c + 1 < nodes.begins.size(); ++c)
        for (std::uint64_t r = nodes.begins[c]; r < nodes.begins[c + 1]; ++r)
        {
            const FillNodes::NodeRun run = nodes.runs[r];
            if (!wet[r] || nodes.side_of(c, run) >= 0) continue;
            const auto [x, y] = nodes.xy_of(c);
            const std::int64_t at[6] = {x, x + 1, y, y + 1, run.begin, run.end};
            const auto along_y = static_cast<std::uint32_t>(y);
            for (std::size_t side = 0; side < 6; ++side)
            {
                const std::size_t axis = side / 2;
                const std::int64_t limit =
                    side % 2 == 0 ? nodes.beyond[axis] : nodes.n[axis] - nodes.beyond[axis];
                if (nodes.beyond[axis] > 0 && at[side] == limit)
                    sides[side].add(side < 2 ? y : x, spread,
                                    side < 4 ? run : FillNodes::NodeRun{along_y, along_y + 1});
            }
        }
    for (OpenSide& side : sides)
        for (std::vector<FillNodes::NodeRun>& row : side.rows)
            std::sort(row.begin(), row.end(),
                      [](const FillNodes::NodeRun& a, const FillNodes::NodeRun& b)
                      { return a.begin != b.begin ? a.begin < b.begin : a.end < b.end; });
    return sides;
}

/// Calls keep(run) for the parts of a run beyond a side that the fluid goes on to.
template <typename Keep>
void for_each_beyond(const FillNodes& nodes, const OpenSide& side, int number, std::size_t column,
                     const FillNodes::NodeRun& run, const Keep& keep)
{
    const auto [x, y] = nodes.xy_of(column);
    const auto& row = side.rows[static_cast<std::size_t>(number < 2 ? y : x)];
    if (number >= 4)
    {
        for (const FillNodes::NodeRun& open : row)
            if (open.begin <= y && y < open.end) return keep(run);
        return;
    }
    std::uint32_t from = run.begin;
    for (const FillNodes::NodeRun& open : row)
    {
        const std::uint32_t begin = std::max(from, open.begin);
        const std::uint32_t end = std::min(run.end, open.end);
        if (begin < end) keep(FillNodes::NodeRun{begin, end});
        from = std::max(from, end);
    }
}

/// Leaves out what is dry, and what of the runs beyond the sides the fluid does not go on to.
void keep_wet(FillNodes& nodes, const std::vector<std::uint8_t>& wet, std::int64_t spread)
{
    const std::array<OpenSide, 6> sides = open_sides(nodes, wet, spread);
    std::vector<std::uint64_t> begins(nodes.begins.size(), 0);
    std::vector<FillNodes::NodeRun> runs;
    for (std::size_t c = 0; c + 1 < nodes.begins.size(); ++c)
    {
        for (std::uint64_t r = nodes.begins[c]; r < nodes.begins[c + 1]; ++r)
        {
            const FillNodes::NodeRun run = nodes.runs[r];
            const int side = nodes.side_of(c, run);
            const auto keep = [&](const FillNodes::NodeRun& part) { runs.push_back(part); };
            if (side < 0 ? wet[r] != 0 : false) keep(run);
            if (side >= 0)
                for_each_beyond(nodes, sides[static_cast<std::size_t>(side)], side, c, run, keep);
        }
        begins[c + 1] = runs.size();
    }
    nodes.begins = std::move(begins);
    nodes.runs = std::move(runs);
}

/// Which runs the fluid touches.
std::vector<std::uint8_t> wet_by_fluid(const FillNodes& nodes, const std::vector<Vec3>& positions,
                                       const std::vector<std::uint32_t>& fluid, double radius,
                                       int threads)
{
    std::vector<std::uint8_t> wet(nodes.runs.size(), 0);
    parallel_for(
        fluid.size(), threads,
        [&](std::size_t k)
        {
            emit_ball(
                nodes, positions[fluid[k]], radius,
                [&](std::size_t column, std::int64_t z0, std::int64_t z1)
                {
                    for (std::uint64_t r = nodes.run_from(column, z0);
                         z0 <= z1 && r < nodes.begins[column + 1] && nodes.runs[r].begin <= z1; ++r)
                        std::atomic_ref(wet[r]).store(1, std::memory_order_relaxed);
                });
        },
        marks_per_chunk);
    return wet;
}

/// A run and its column.
struct RunPlace
{
    std::uint64_t run = 0;
    std::size_t column = 0;
};

template <typename Visit>
void for_each_run(const FillNodes& nodes, const Visit& visit)
{
    for (std::size_t c = 0; c + 1 < nodes.begins.size(); ++c)
        for (std::uint64_t r = nodes.begins[c]; r < nodes.begins[c + 1]; ++r) visit(RunPlace{r, c});
}

/// Spreads what is wet from some runs to those in the box that touch them, which are appended.
void spread(const FillNodes& nodes, std::vector<RunPlace>& reached, std::vector<std::uint8_t>& wet)
{
    for (std::size_t i = 0; i < reached.size(); ++i)
    {
        const auto [run, column] = reached[i];
        const FillNodes::NodeRun of = nodes.runs[run];
        if (nodes.side_of(column, of) >= 0) continue;
        nodes.for_each_beside(column, of,
                              [&](std::uint64_t r, std::size_t beside)
                              {
                                  if (wet[r]) return;
                                  wet[r] = 1;
                                  reached.push_back({r, beside});
                              });
    }
}

/// Without fluid, all that is no gap between particles inside a wall: spaces of some nodes.
std::vector<std::uint8_t> wet_spaces(const FillNodes& nodes)
{
    constexpr std::uint64_t least_nodes = 8;
    constexpr std::uint8_t is_gap = 2;
    std::vector<std::uint8_t> wet(nodes.runs.size(), 0);
    std::vector<RunPlace> space;
    for_each_run(nodes,
                 [&](const RunPlace& first)
                 {
                     if (wet[first.run]) return;
                     wet[first.run] = 1;
                     space.assign(1, first);
                     spread(nodes, space, wet);
                     std::uint64_t size = 0;
                     for (const RunPlace& p : space)
                         size += nodes.runs[p.run].end - nodes.runs[p.run].begin;
                     if (size >= least_nodes) return;
                     for (const RunPlace& p : space) wet[p.run] = is_gap;
                 });
    std::replace(wet.begin(), wet.end(), is_gap, std::uint8_t{0});
    return wet;
}

std::int64_t nodes_in(double length, double dp)
{
    return static_cast<std::int64_t>(std::ceil(length / dp));
}

/// All that the fluid of the case can come to, but not over a rim and away.
std::vector<std::uint8_t> wet_from_fluid(FillNodes& nodes, const std::vector<Vec3>& positions,
                                         const std::vector<std::uint32_t>& fluid,
                                         const CheckSetup& setup, int threads)
{
    const double beside = 0.87 * setup.dp;
    FluidAtStart start;
    start.is_beside = wet_by_fluid(nodes, positions, fluid, beside, threads);
    std::vector<std::uint8_t> wet = start.is_beside;
    std::vector<RunPlace> reached;
    for_each_run(nodes,
                 [&](const RunPlace& p)
                 {
                     if (wet[p.run]) reached.push_back(p);
                 });
    spread(nodes, reached, wet);
    const Vec3& g = setup.gravity;
    if (g.x != 0 || g.y != 0 || !(g.z < 0) || setup.is_periodic[2]) return wet;
    double top = positions[fluid.front()].z;
    for (const std::uint32_t i : fluid) top = std::max(top, positions[i].z);
    start.top = static_cast<std::uint32_t>(
        std::max<std::int64_t>(nodes.beyond[2], nodes.last(top + beside, 2)));
    leave_out_spilled(nodes, start, static_cast<std::uint32_t>(nodes_in(2 * setup.h, setup.dp)),
                      wet);
    return wet;
}

} // namespace

FillNodes fill_cavity(const CheckParticles& particles, const CheckSetup& setup,
                      const std::vector<std::uint32_t>& walls,
                      const std::vector<std::uint32_t>& fluid, int threads)
{
    FillNodes nodes = whole_box(particles, setup, walls, fluid);
    if (nodes.runs.empty()) return nodes;
    const std::size_t columns = nodes.begins.size() - 1;
    const std::vector<Vec3>& positions = particles.positions;
    const double seal = (setup.is_2d ? 0.75 : 0.87) * setup.dp;
    const double longest = 2 * setup.h;
    take_away(nodes,
              collect_spans(columns, walls.size(), threads,
                            [&](std::size_t k, const auto& emit)
                            {
                                const std::uint32_t i = walls[k];
                                emit_ball(nodes, positions[i], seal * (1 - 1e-6), emit);
                                if (i >= particles.normals.size()) return;
                                const auto& n = particles.normals[i];
                                const Vec3 normal{n[0], n[1], n[2]};
                                const double length = norm(normal);
                                if (length > 0 && length <= longest)
                                    emit_cylinder(nodes, positions[i], normal, emit);
                            }),
              threads);
    const std::vector<std::uint8_t> wet =
        fluid.empty() ? wet_spaces(nodes) : wet_from_fluid(nodes, positions, fluid, setup, threads);
    keep_wet(nodes, wet, nodes_in(longest, setup.dp));
    if (!nodes.runs.empty())
        take_away(nodes,
                  collect_spans(columns, fluid.size(), threads,
                                [&](std::size_t k, const auto& emit)
                                { emit_ball(nodes, positions[fluid[k]], 0.75 * setup.dp, emit); }),
                  threads);
    return nodes;
}

} // namespace fppg
