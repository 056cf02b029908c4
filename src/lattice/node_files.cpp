#include "lattice/node_files.h"

#include "fppg/fitted_walls.h"

#include "core/parallel.h"
#include "nodes/snap.h"
#include "nodes/spans.h"

#include <algorithm>
#include <tuple>

namespace fppg
{
namespace
{

Spans shifted(const Spans& spans, int rows)
{
    Spans out;
    for (Span s : spans)
    {
        if (rows < 0 && s.y == 0) continue;
        s.y = rows < 0 ? s.y - 1 : s.y + 1;
        out.push_back(s);
    }
    return out;
}

Spans shortened(const Spans& spans)
{
    Spans out;
    for (const Span& s : spans)
        if (s.z_end - s.z_begin > 2) out.push_back({s.y, s.z_begin + 1, s.z_end - 1});
    return out;
}

} // namespace

RunField plain_nodes(const RunField& field, int threads)
{
    RunField out;
    out.grid = field.grid;
    out.slabs.resize(field.slabs.size());
    parallel_for(
        field.slabs.size(), threads,
        [&](std::size_t x)
        {
            for (Run run : field.slabs[x])
            {
                run.is_covered = false;
                std::vector<Run>& runs = out.slabs[x];
                if (!runs.empty() && runs.back().y == run.y && runs.back().mk == run.mk &&
                    runs.back().z_end == run.z_begin)
                    runs.back().z_end = run.z_end;
                else
                    runs.push_back(run);
            }
        },
        16);
    return out;
}

std::vector<Vec3> border_nodes(const RunField& field, std::uint16_t mk)
{
    const RunField plain = plain_nodes(field, 1);
    std::vector<char> wanted(65536, 0);
    wanted[mk] = 1;
    std::vector<Spans> nodes;
    for (const std::vector<Run>& slab : plain.slabs)
        nodes.push_back(mk == 0 ? complement(occupied(slab), whole_lattice(field.grid))
                                : select(slab, wanted));
    std::vector<Node> found;
    const Spans none;
    for (std::size_t x = 0; x < nodes.size(); ++x)
    {
        Spans inner = shortened(nodes[x]);
        inner = intersect(inner, x > 0 ? nodes[x - 1] : none);
        inner = intersect(inner, x + 1 < nodes.size() ? nodes[x + 1] : none);
        if (!field.grid.is_2d)
        {
            inner = intersect(inner, shifted(nodes[x], 1));
            inner = intersect(inner, shifted(nodes[x], -1));
        }
        for (const Span& s : subtract(nodes[x], inner))
            for (std::uint32_t z = s.z_begin; z < s.z_end; ++z)
                found.push_back({static_cast<std::int64_t>(x), s.y, z});
    }
    std::sort(found.begin(), found.end(),
              [](const Node& a, const Node& b)
              { return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x); });
    std::vector<Vec3> out;
    out.reserve(found.size());
    for (const Node& n : found) out.push_back(position(n, field.grid));
    return out;
}

} // namespace fppg
