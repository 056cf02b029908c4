#include "meshes/near_tree.h"

#include "core/lanes.h"
#include "meshes/facet_distance.h"
#include "meshes/facet_tree.h"

#include <array>
#include <bit>
#include <vector>

namespace fppg
{
namespace
{

/// Facets that are gathered for many queries fill so many leaves at most.
constexpr std::size_t most_near_leaves = 8;

/// One search; see NearTree.
struct NearSearch
{
    const TriangleSoup* soup;
    Vec3 point;
    std::array<float, 3> at; ///< the point in the unit cube
    double per_metre;        ///< units of the cube
    double reach;            ///< what float rounding can change in a distance there
    float limit;             ///< squared, there: what is farther does not count
    ClosestPoint best;

    void set_limit(double distance)
    {
        const double most = distance * per_metre * (1 + float_room) + reach;
        limit = static_cast<float>(most * most * (1 + float_room));
    }

    void look_at(std::uint32_t facet)
    {
        if (facet == best.facet) return;
        const Vec3 candidate = closest_on_facet(point, &soup->vertices[3 * std::size_t{facet}]);
        const double distance = norm(candidate - point);
        if (!(distance < best.distance) && !(distance == best.distance && facet < best.facet))
            return;
        best = {candidate, facet, distance};
        set_limit(distance);
    }
};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr ClosestPoint no_point{
    {infinity, infinity, infinity}, std::numeric_limits<std::uint32_t>::max(), infinity};

/// Without a limit yet.
NearSearch search_from(const TriangleSoup& soup, const Vec3& centre, double scale,
                       const Vec3& point)
{
    const Vec3 unit = (point - centre) / scale;
    return {&soup,
            point,
            {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)},
            1 / scale,
            (1 + norm(unit)) * float_room,
            0,
            no_point};
}

/// What cannot be told counts as within.
FPPG_LANES unsigned lanes_within(const Lanes& squared, float limit, std::uint32_t count)
{
    return ~set_lanes(squared > limit) & ((1u << count) - 1);
}

FPPG_LANES Lanes above_plane(const LeafPlanes& plane, const std::array<float, 3>& at)
{
    return plane.x * at[0] + plane.y * at[1] + plane.z * at[2] - plane.at;
}

/// Squared: the distance to a facet is no less than that to its plane, and in that plane than that
/// beyond any of its sides.
FPPG_LANES Lanes least_distances(const TreeLeaf& leaf, const NearSearch& search)
{
    const Lanes height = above_plane(leaf.planes[0], search.at);
    const Lanes one = above_plane(leaf.planes[1], search.at);
    const Lanes two = above_plane(leaf.planes[2], search.at);
    const Lanes three = above_plane(leaf.planes[3], search.at);
    const Lanes beyond = larger(larger(one, two), larger(three, Lanes{}));
    return height * height + beyond * beyond;
}

FPPG_LANES void look_at_leaf(const TreeLeaf& leaf, NearSearch& search)
{
    const Lanes squared = least_distances(leaf, search);
    unsigned left = lanes_within(squared, search.limit, leaf.count);
    while (left != 0)
    {
        auto nearest = static_cast<std::size_t>(std::countr_zero(left));
        for (unsigned rest = left & (left - 1); rest != 0; rest &= rest - 1)
        {
            const auto other = static_cast<std::size_t>(std::countr_zero(rest));
            if (squared[other] < squared[nearest]) nearest = other;
        }
        search.look_at(leaf.facet[nearest]);
        left &= ~(1u << nearest);
        left &= lanes_within(squared, search.limit, leaf.count);
    }
}

struct StackEntry
{
    float squared;
    std::uint32_t child;
};
/// Of a tree over 2^31 leaves, with up to seven children of each level waiting.
constexpr std::size_t stack_size = 96;

/// Puts the children of a node that are near enough onto the stack, the nearest on top. Returns how
/// many the stack holds then.
FPPG_LANES std::size_t push_children(const TreeNode& node, const NearSearch& search,
                                     std::array<StackEntry, stack_size>& stack, std::size_t depth)
{
    Lanes squared{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const Lanes off = larger(larger(node.low[axis] - search.at[axis], Lanes{}),
                                 search.at[axis] - node.high[axis]);
        squared += off * off;
    }
    const std::size_t bottom = depth;
    for (unsigned set = lanes_within(squared, search.limit, node.count); set != 0; set &= set - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(set));
        const StackEntry entry{squared[lane], node.child[lane]};
        std::size_t place = depth++;
        for (; place > bottom && stack[place - 1].squared < entry.squared; --place)
            stack[place] = stack[place - 1];
        stack[place] = entry;
    }
    return depth;
}

FPPG_LANES void search_tree(const std::vector<TreeNode>& nodes, const RawArray<TreeLeaf>& leaves,
                            NearSearch& search)
{
    std::array<StackEntry, stack_size> stack;
    std::size_t depth = push_children(nodes.front(), search, stack, 0);
    while (depth > 0)
    {
        const StackEntry entry = stack[--depth];
        if (entry.squared > search.limit) continue;
        if ((entry.child & is_leaf) != 0)
            look_at_leaf(leaves[entry.child & ~is_leaf], search);
        else
            depth = push_children(nodes[entry.child], search, stack, depth);
    }
}

FPPG_LANES void search_leaves(const std::vector<TreeLeaf>& leaves, NearSearch& search)
{
    for (const TreeLeaf& leaf : leaves) look_at_leaf(leaf, search);
}

/// Room for a facet behind the others.
void append_facet(const TreeLeaf& from, std::size_t lane, std::vector<TreeLeaf>& out)
{
    if (out.empty() || out.back().count == lane_count) out.emplace_back();
    TreeLeaf& leaf = out.back();
    const std::size_t at = leaf.count++;
    for (std::size_t p = 0; p < planes_of_facet; ++p)
    {
        leaf.planes[p].x[at] = from.planes[p].x[lane];
        leaf.planes[p].y[at] = from.planes[p].y[lane];
        leaf.planes[p].z[at] = from.planes[p].z[lane];
        leaf.planes[p].at[at] = from.planes[p].at[lane];
    }
    leaf.facet[at] = from.facet[lane];
}

/// Empty where facets within the limit are more than most_near_leaves hold.
FPPG_LANES void collect_facets(const std::vector<TreeNode>& nodes, const RawArray<TreeLeaf>& leaves,
                               const NearSearch& search, std::vector<TreeLeaf>& out)
{
    std::array<StackEntry, stack_size> stack;
    std::size_t depth = push_children(nodes.front(), search, stack, 0);
    while (depth > 0)
    {
        const StackEntry entry = stack[--depth];
        if ((entry.child & is_leaf) == 0)
        {
            depth = push_children(nodes[entry.child], search, stack, depth);
            continue;
        }
        const TreeLeaf& leaf = leaves[entry.child & ~is_leaf];
        for (unsigned set = lanes_within(least_distances(leaf, search), search.limit, leaf.count);
             set != 0; set &= set - 1)
            append_facet(leaf, static_cast<std::size_t>(std::countr_zero(set)), out);
        if (out.size() <= most_near_leaves) continue;
        out.clear();
        return;
    }
}

void search_plain(const std::vector<TreeNode>& nodes, const RawArray<TreeLeaf>& leaves,
                  NearSearch& search)
{
    search_tree(nodes, leaves, search);
}

FPPG_AVX2 void search_avx2(const std::vector<TreeNode>& nodes, const RawArray<TreeLeaf>& leaves,
                           NearSearch& search)
{
    search_tree(nodes, leaves, search);
}

void search_leaves_plain(const std::vector<TreeLeaf>& leaves, NearSearch& search)
{
    search_leaves(leaves, search);
}

FPPG_AVX2 void search_leaves_avx2(const std::vector<TreeLeaf>& leaves, NearSearch& search)
{
    search_leaves(leaves, search);
}

void collect_plain(const std::vector<TreeNode>& nodes, const RawArray<TreeLeaf>& leaves,
                   const NearSearch& search, std::vector<TreeLeaf>& out)
{
    collect_facets(nodes, leaves, search, out);
}

FPPG_AVX2 void collect_avx2(const std::vector<TreeNode>& nodes, const RawArray<TreeLeaf>& leaves,
                            const NearSearch& search, std::vector<TreeLeaf>& out)
{
    collect_facets(nodes, leaves, search, out);
}

} // namespace

struct NearFacets::Leaves
{
    std::vector<TreeLeaf> leaves;
};

NearFacets::NearFacets() : leaves_(std::make_unique<Leaves>()) {}
NearFacets::~NearFacets() = default;

NearTree::NearTree(const TriangleSoup& soup, const Vec3& centre, double scale, int threads)
    : soup_(soup),
      centre_(centre),
      scale_(scale),
      tree_(std::make_unique<FacetTree>(make_facet_tree(soup, centre, scale, threads)))
{
}

NearTree::~NearTree() = default;

void NearTree::collect(const Vec3& place, double reach, NearFacets& near) const
{
    NearSearch search = search_from(soup_, centre_, scale_, place);
    search.set_limit(reach);
    near.leaves_->leaves.clear();
    (is_avx2_there() ? collect_avx2 : collect_plain)(tree_->nodes, tree_->leaves, search,
                                                     near.leaves_->leaves);
}

ClosestPoint NearTree::closest(const Vec3& point, double within, const NearFacets* near) const
{
    NearSearch search = search_from(soup_, centre_, scale_, point);
    search.set_limit(within);
    // Points are mostly asked for one beside the other: the last answer is a good bound.
    thread_local std::uint32_t last = 0;
    if (last < soup_.size()) search.look_at(last);
    if (search.best.distance > within)
    {
        search.best = no_point;
        search.set_limit(within);
    }
    if (near != nullptr && !near->leaves_->leaves.empty())
        (is_avx2_there() ? search_leaves_avx2 : search_leaves_plain)(near->leaves_->leaves, search);
    else
        (is_avx2_there() ? search_avx2 : search_plain)(tree_->nodes, tree_->leaves, search);
    if (search.best.facet < soup_.size()) last = search.best.facet;
    // A point at the limit itself may be computed to be beyond it by a rounding.
    const double most = within * (1 + float_room) + search.reach * scale_;
    return search.best.distance <= most ? search.best : no_point;
}

} // namespace fppg
