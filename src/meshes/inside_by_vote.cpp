#include "meshes/inside_by_vote.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/parallel.h"
#include "fppg/shapes.h"
#include "meshes/column_spans.h"
#include "meshes/winding_tree.h"

namespace fppg
{

namespace
{

/// A node of one slab as one number, ordered like spans: row first.
using Key = std::uint64_t;
/// A set of nodes of one slab as the sorted keys at which membership changes; every row has an
/// even number of them, so that the exclusive or of two sets is that of their keys.
using Toggles = std::vector<Key>;

Key key_of(std::uint64_t y, std::uint64_t z)
{
    return y << 32 | z;
}

void append_span(Toggles& toggles, Key begin, Key end)
{
    if (!toggles.empty() && toggles.back() == begin)
        toggles.back() = end;
    else
        toggles.insert(toggles.end(), {begin, end});
}

Toggles exclusive_or(const Toggles& a, const Toggles& b)
{
    Toggles result;
    result.reserve(a.size() + b.size());
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(),
                                  std::back_inserter(result));
    return result;
}

bool is_in(const Toggles& set, Key node)
{
    return (std::upper_bound(set.begin(), set.end(), node) - set.begin()) % 2 == 1;
}

/// Sorted nodes as a set.
Toggles set_of(const std::vector<Key>& nodes)
{
    Toggles set;
    for (const Key node : nodes) append_span(set, node, node + 1);
    return set;
}

/// Cuts along another axis by turning mesh and lattice so that it becomes z.
ColumnCuts cut_along(int axis, const TriangleSoup& soup, const LatticeGrid& grid, int threads)
{
    ColumnOptions options;
    options.measures_overlap = axis == 2;
    if (axis == 2) return cut_columns(soup, grid, options, threads);
    const auto turned = [axis](const Vec3& p) {
        return Vec3{p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]};
    };
    TriangleSoup other;
    other.vertices.reserve(soup.vertices.size());
    for (const Vec3& p : soup.vertices) other.vertices.push_back(turned(p));
    LatticeGrid lattice = grid;
    lattice.origin = turned(grid.origin);
    lattice.stretch = turned(grid.stretch);
    for (std::size_t k = 0; k < 3; ++k)
        lattice.n[k] = grid.n[(static_cast<std::size_t>(axis) + 1 + k) % 3];
    return cut_columns(other, lattice, options, threads);
}

/// The three opinions on every slab, in the same form.
struct Opinions
{
    std::vector<Toggles> by_axis[3]; ///< per slab
    /// Columns without a vote: along x the keys (y, z); along y per slab the z; along z per slab
    /// the y.
    std::vector<Key> mute_x;
    std::vector<std::vector<std::uint32_t>> mute_y, mute_z;
};

std::vector<Toggles> along_z(const SpanSet& set, std::size_t slabs, int threads)
{
    std::vector<Toggles> result(slabs);
    parallel_for(set.slabs.size(), threads,
                 [&](std::size_t i)
                 {
                     for (const Span& s : set.slabs[i])
                         append_span(result[set.x_begin + i], key_of(s.y, s.z_begin),
                                     key_of(s.y, s.z_end));
                 });
    return result;
}

/// From spans along x: slabs are y, rows z.
std::vector<Toggles> along_x(const SpanSet& set, std::size_t slabs)
{
    std::vector<std::vector<Key>> changes(slabs + 1);
    for (std::size_t i = 0; i < set.slabs.size(); ++i)
        for (const Span& s : set.slabs[i])
            for (const std::uint32_t x : {s.z_begin, s.z_end})
                changes[x].push_back(key_of(set.x_begin + i, s.y));
    std::vector<Toggles> result(slabs);
    Toggles now;
    for (std::size_t x = 0; x < slabs; ++x)
    {
        if (!changes[x].empty()) now = exclusive_or(now, set_of(changes[x]));
        result[x] = now;
    }
    return result;
}

/// From spans along y: slabs are z, rows x.
std::vector<Toggles> along_y(const SpanSet& set, std::size_t slabs, int threads)
{
    std::vector<std::vector<Key>> changes(slabs);
    for (std::size_t i = 0; i < set.slabs.size(); ++i)
        for (const Span& s : set.slabs[i])
            for (const std::uint32_t y : {s.z_begin, s.z_end})
                changes[s.y].push_back(key_of(y, set.x_begin + i));
    std::vector<Toggles> result(slabs);
    parallel_for(slabs, threads,
                 [&](std::size_t x)
                 {
                     std::vector<Key>& nodes = changes[x];
                     std::sort(nodes.begin(), nodes.end());
                     Toggles now; // of one row, with the key's row 0
                     std::size_t i = 0;
                     while (i < nodes.size())
                     {
                         const Key row = nodes[i] >> 32;
                         std::vector<Key> here;
                         for (; i < nodes.size() && nodes[i] >> 32 == row; ++i)
                             here.push_back(nodes[i] & 0xFFFFFFFF);
                         now = exclusive_or(now, set_of(here));
                         const Key next = i < nodes.size() ? nodes[i] >> 32 : row;
                         for (Key y = row; y < next; ++y)
                             for (const Key z : now) result[x].push_back(y << 32 | z);
                     }
                     nodes = {};
                 });
    return result;
}

void append_nodes(const Toggles& set, std::vector<Key>& nodes)
{
    for (std::size_t i = 0; i < set.size(); i += 2)
        for (Key node = set[i]; node < set[i + 1]; ++node) nodes.push_back(node);
}

struct NodeRange
{
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// Nodes between the ends of the mesh on one axis; a little more where rounding leaves it open.
NodeRange range_of(const Box3& bounds, const LatticeGrid& grid, int axis)
{
    const double n = grid.n[static_cast<std::size_t>(axis)];
    const double begin = std::floor((bounds.min[axis] - grid.origin[axis]) / grid.step(axis)) - 1;
    const double end = std::ceil((bounds.max[axis] - grid.origin[axis]) / grid.step(axis)) + 2;
    return {static_cast<std::uint32_t>(std::clamp(begin, 0.0, n)),
            static_cast<std::uint32_t>(std::clamp(end, 0.0, n))};
}

/// What lines along the three axes say about the nodes of all slabs.
Opinions ask_along_axes(const TriangleSoup& soup, const LatticeGrid& grid, int threads,
                        double& overlap)
{
    const std::size_t slabs = grid.n[0];
    Opinions opinions;
    opinions.mute_y.resize(slabs);
    opinions.mute_z.resize(slabs);
    {
        const ColumnCuts cuts = cut_along(2, soup, grid, threads);
        overlap = cuts.overlap;
        opinions.by_axis[2] = along_z(cuts.inside, slabs, threads);
        for (const auto& [x, y] : cuts.unbalanced) opinions.mute_z[x].push_back(y);
    }
    {
        const ColumnCuts cuts = cut_along(0, soup, grid, threads);
        opinions.by_axis[0] = along_x(cuts.inside, slabs);
        for (const auto& [y, z] : cuts.unbalanced) opinions.mute_x.push_back(key_of(y, z));
    }
    {
        const ColumnCuts cuts = cut_along(1, soup, grid, threads);
        opinions.by_axis[1] = along_y(cuts.inside, slabs, threads);
        for (const auto& [z, x] : cuts.unbalanced) opinions.mute_y[x].push_back(z);
    }
    return opinions;
}

/// The vote about the nodes of one slab.
class SlabVote
{
public:
    SlabVote(const Opinions& opinions, const WindingTree& tree, const LatticeGrid& grid,
             std::size_t x)
        : opinions_(opinions),
          tree_(tree),
          grid_(grid),
          x_(x),
          along_x_(opinions.by_axis[0][x]),
          along_y_(opinions.by_axis[1][x]),
          along_z_(opinions.by_axis[2][x])
    {
    }

    /// ranges  nodes along the axes beyond which nothing is inside
    /// returns the nodes that are inside
    Toggles run(const NodeRange* ranges)
    {
        std::vector<Key> changed;
        for (const Key node : open_nodes(ranges))
            if (is_inside(node) != is_in(along_z_, node)) changed.push_back(node);
        return exclusive_or(along_z_, set_of(changed));
    }

    std::uint64_t disputed() const { return disputed_; }

private:
    /// Nodes about which the lines may not agree, or one of them says nothing.
    std::vector<Key> open_nodes(const NodeRange* ranges) const
    {
        std::vector<Key> nodes;
        append_nodes(exclusive_or(along_x_, along_y_), nodes);
        append_nodes(exclusive_or(along_x_, along_z_), nodes);
        if (x_ >= ranges[0].begin && x_ < ranges[0].end)
        {
            nodes.insert(nodes.end(), opinions_.mute_x.begin(), opinions_.mute_x.end());
            for (const std::uint32_t z : opinions_.mute_y[x_])
                for (std::uint32_t y = ranges[1].begin; y < ranges[1].end; ++y)
                    nodes.push_back(key_of(y, z));
            for (const std::uint32_t y : opinions_.mute_z[x_])
                for (std::uint32_t z = ranges[2].begin; z < ranges[2].end; ++z)
                    nodes.push_back(key_of(y, z));
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        return nodes;
    }

    bool is_inside(Key node)
    {
        const auto y = static_cast<std::uint32_t>(node >> 32);
        const auto z = static_cast<std::uint32_t>(node);
        const auto& mute_x = opinions_.mute_x;
        const auto& mute_y = opinions_.mute_y[x_];
        const auto& mute_z = opinions_.mute_z[x_];
        int votes = 0, ayes = 0;
        const auto count = [&](bool is_mute, bool says_inside)
        {
            if (is_mute) return;
            ++votes;
            ayes += says_inside ? 1 : 0;
        };
        count(std::binary_search(mute_x.begin(), mute_x.end(), node), is_in(along_x_, node));
        count(std::binary_search(mute_y.begin(), mute_y.end(), z), is_in(along_y_, node));
        count(std::binary_search(mute_z.begin(), mute_z.end(), y), is_in(along_z_, node));
        if (votes >= 2 && (ayes == 0 || ayes == votes)) return ayes > 0;
        ++disputed_;
        const Vec3 at = grid_.place(static_cast<double>(x_), y, z);
        return tree_.winding_number(at) > 0.5;
    }

    const Opinions& opinions_;
    const WindingTree& tree_;
    const LatticeGrid& grid_;
    std::size_t x_;
    const Toggles& along_x_;
    const Toggles& along_y_;
    const Toggles& along_z_;
    std::uint64_t disputed_ = 0;
};

} // namespace

InsideVote vote_inside(const TriangleSoup& soup, const LatticeGrid& grid, int threads)
{
    InsideVote vote;
    const std::size_t slabs = grid.n[0];
    Box3 bounds;
    for (const Vec3& p : soup.vertices) bounds.add(p);
    if (bounds.is_empty()) return vote;
    NodeRange ranges[3];
    for (int axis = 0; axis < 3; ++axis) ranges[axis] = range_of(bounds, grid, axis);
    Opinions opinions = ask_along_axes(soup, grid, threads, vote.overlap);
    const WindingTree tree(soup);
    vote.inside.slabs.resize(slabs);
    std::vector<std::uint64_t> disputed(slabs, 0);
    parallel_for(
        slabs, threads,
        [&](std::size_t x)
        {
            SlabVote slab(opinions, tree, grid, x);
            const Toggles inside = slab.run(ranges);
            disputed[x] = slab.disputed();
            for (std::size_t i = 0; i < inside.size(); i += 2)
                vote.inside.slabs[x].push_back({static_cast<std::uint32_t>(inside[i] >> 32),
                                                static_cast<std::uint32_t>(inside[i]),
                                                static_cast<std::uint32_t>(inside[i + 1])});
            opinions.by_axis[2][x] = {};
        });
    for (const std::uint64_t count : disputed) vote.disputed += count;
    return vote;
}

SpanSet inside_by_vote(const TriangleSoup& soup, const LatticeGrid& grid, int threads,
                       std::uint64_t& disputed)
{
    InsideVote vote = vote_inside(soup, grid, threads);
    disputed = vote.disputed;
    return std::move(vote.inside);
}

} // namespace fppg
