#include "meshes/near_tree.h"

#include "core/lanes.h"
#include "core/morton.h"
#include "core/parallel.h"
#include "core/raw_array.h"
#include "meshes/facet_distance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace fppg
{
namespace
{

/// Room for what float rounds away of coordinates between -1 and 1 and of sums of them.
constexpr double float_room = 1.0 / (1 << 20);
constexpr std::uint32_t is_leaf = 1u << 31;
/// Below so many parts one thread halves on.
constexpr std::size_t parts_per_task = 4096;

/// Boxes over more parts than this have no slab: facets turn too much within them.
constexpr std::size_t parts_in_slab = 512;

/// Eight boxes in a unit cube and where they lead. What is in a box lies between two planes across
/// the mean normal, too. From inside a ball of small facets all boxes within some distance are
/// about as near as the nearest facet; most of their slabs are not.
struct alignas(32) TreeNode
{
    std::array<Lanes, 3> low, high;
    std::array<Lanes, 3> normal{};                 ///< of the slab; 0: none
    Lanes slab_begin{}, slab_end{};                ///< of dot(normal, point)
    std::array<std::uint32_t, lane_count> child{}; ///< a node, or a leaf with is_leaf
    std::uint32_t count = 0;
};

/// A facet lies between planes: on that of its face, and behind those that stand on its sides and
/// look outwards. Facets without an area are taken for a line: behind planes at both ends.
struct LeafPlanes
{
    Lanes x, y, z, at; ///< unit normal and dot(normal, point of the plane)
};
constexpr std::size_t planes_of_facet = 4; ///< the first is that of the face

struct alignas(32) TreeLeaf
{
    std::array<LeafPlanes, planes_of_facet> planes;
    std::array<std::uint32_t, lane_count> facet{};
    std::uint32_t count = 0;
};

/// A facet, or one of the parts into which it is cut.
struct FacetPart
{
    Box3 box;
    std::uint32_t facet = 0;
};

/// The parts into which a facet is cut across its longest edge for its boxes: long and oblique, one
/// box of it would be large and empty, and near everything.
int parts_of_facet(const Vec3* corners)
{
    constexpr double most = 32;
    Box3 box;
    double longest = 0;
    for (int k = 0; k < 3; ++k)
    {
        box.add(corners[k]);
        longest = std::max(longest, norm(corners[(k + 1) % 3] - corners[k]));
    }
    const Vec3 size = box.max - box.min;
    const double middle =
        std::max(std::min(size.x, size.y), std::min(std::max(size.x, size.y), size.z));
    const double height =
        norm(cross(corners[1] - corners[0], corners[2] - corners[0])) / std::max(longest, 1e-300);
    if (middle <= 4 * height) return 1;
    return static_cast<int>(
        std::min(most, std::ceil(middle / std::max(2 * height, middle / most))));
}

/// The box of part k of n of a facet.
Box3 box_of_part(const Vec3* corners, int k, int n)
{
    Box3 box;
    if (n == 1)
    {
        for (int corner = 0; corner < 3; ++corner) box.add(corners[corner]);
        return box;
    }
    int first = 0;
    for (int edge = 1; edge < 3; ++edge)
        if (norm(corners[(edge + 1) % 3] - corners[edge]) >
            norm(corners[(first + 1) % 3] - corners[first]))
            first = edge;
    const Vec3& a = corners[first];
    const Vec3& b = corners[(first + 1) % 3];
    const Vec3& top = corners[(first + 2) % 3];
    const Vec3 along = b - a;
    const double at_top = std::clamp(dot(top - a, along) / dot(along, along), 0.0, 1.0);
    const double begin = static_cast<double>(k) / n;
    const double end = static_cast<double>(k + 1) / n;
    for (const double t : {begin, end})
    {
        box.add(a + t * along);
        // The point of the other two edges above it.
        if (t < at_top)
            box.add(a + (t / at_top) * (top - a));
        else
            box.add(at_top < 1 ? b + ((1 - t) / (1 - at_top)) * (top - b) : top);
    }
    if (begin <= at_top && at_top <= end) box.add(top);
    return box;
}

struct FacetPlane
{
    Vec3 normal;
    double at = 0;
};

/// Of a facet in the unit cube; zero normals, which exclude nothing, where it is but a point.
std::array<FacetPlane, planes_of_facet> planes_around(const std::array<Vec3, 3>& corners)
{
    std::array<FacetPlane, planes_of_facet> out;
    const auto set = [&](std::size_t plane, const Vec3& direction, const Vec3& through)
    {
        const double size = norm(direction);
        if (!(size > 0)) return;
        const Vec3 n = direction / size;
        out[plane] = {n, dot(n, through)};
    };
    std::size_t longest = 0;
    std::array<Vec3, 3> sides;
    for (std::size_t s = 0; s < 3; ++s)
    {
        sides[s] = corners[(s + 1) % 3] - corners[s];
        if (norm(sides[s]) > norm(sides[longest])) longest = s;
    }
    const Vec3 normal = cross(sides[0], sides[1]);
    const double length = norm(sides[longest]);
    if (norm(normal) > 1e-5 * length * length)
    {
        set(0, normal, corners[0]);
        for (std::size_t s = 0; s < 3; ++s) set(s + 1, cross(sides[s], normal), corners[s]);
        return out;
    }
    if (!(length > 0)) return out;
    // The ends of its longest side; what bounds it across need not be known where it bends a bit.
    const Vec3& along = sides[longest];
    set(1, along, corners[(longest + 1) % 3]);
    set(2, -1.0 * along, corners[longest]);
    if (norm(normal) > 0) return out;
    Vec3 axis;
    int least = 0;
    for (int a = 1; a < 3; ++a)
        if (std::fabs(along[a]) < std::fabs(along[least])) least = a;
    axis[least] = 1;
    set(0, cross(along, axis), corners[longest]);
    return out;
}

/// Cuts the order of facets along a Morton curve in halves; ranges that one thread takes are
/// ordered anew by the middles of their facets. Until eight are left.
class TreeMaker
{
public:
    TreeMaker(const TriangleSoup& soup, const Vec3& centre, double scale, int threads)
        : soup_(soup), centre_(centre), scale_(scale), threads_(threads)
    {
        make_parts();
        sort_parts();
    }

    void make(std::vector<TreeNode>& nodes, RawArray<TreeLeaf>& leaves)
    {
        const std::size_t count = (n_parts_ + lane_count - 1) / lane_count;
        nodes.resize(nodes_over({0, count}));
        leaves = RawArray<TreeLeaf>(count);
        // Nodes of one level on all threads.
        for (std::vector<Subtree> level{{0, {0, count}}}; !level.empty();)
        {
            std::vector<std::vector<Subtree>> below(level.size());
            parallel_for(level.size(), threads_,
                         [&](std::size_t i) { spread(level[i], nodes, below[i]); });
            level.clear();
            for (const auto& some : below) level.insert(level.end(), some.begin(), some.end());
        }
        std::vector<Box3> leaf_boxes(count);
        parallel_for(
            count, threads_, [&](std::size_t l) { leaf_boxes[l] = fill(l, leaves[l]); }, 64);
        std::vector<Box3> boxes(nodes.size());
        for (std::size_t n = nodes.size(); n-- > 0;)
            for (std::uint32_t c = 0; c < nodes[n].count; ++c)
            {
                const std::uint32_t child = nodes[n].child[c];
                const Box3& box =
                    (child & is_leaf) != 0 ? leaf_boxes[child & ~is_leaf] : boxes[child];
                boxes[n].add(box.min);
                boxes[n].add(box.max);
                set_box(nodes[n], c, box);
            }
    }

private:
    struct LeafRange
    {
        std::size_t begin = 0, end = 0;
        std::size_t size() const { return end - begin; }
    };
    struct Subtree
    {
        std::uint32_t node = 0;
        LeafRange leaves;
    };

    /// Halves a range so many times, and calls take(part) for what is left, in order.
    template <typename Halve, typename Take>
    static void split(const LeafRange& range, int times, const Halve& halve, const Take& take)
    {
        if (times == 0 || range.size() == 1)
        {
            take(range);
            return;
        }
        const std::size_t middle = range.begin + range.size() / 2;
        halve(range, middle);
        split({range.begin, middle}, times - 1, halve, take);
        split({middle, range.end}, times - 1, halve, take);
    }
    static constexpr int times_a_node = 3;

    static std::uint32_t nodes_over(const LeafRange& range)
    {
        std::uint32_t sum = 1;
        split(
            range, times_a_node, [](const LeafRange&, std::size_t) {},
            [&](const LeafRange& part) { sum += part.size() > 1 ? nodes_over(part) : 0; });
        return sum;
    }

    /// Makes the nodes over a range, each before those below it; subtrees over many parts are left
    /// for later.
    void spread(const Subtree& tree, std::vector<TreeNode>& nodes, std::vector<Subtree>& later)
    {
        TreeNode& node = nodes[tree.node];
        std::uint32_t next = tree.node + 1;
        split(
            tree.leaves, times_a_node,
            [&](const LeafRange& range, std::size_t middle) { halve(range, middle); },
            [&](const LeafRange& part)
            {
                node.child[node.count++] =
                    part.size() == 1 ? is_leaf | static_cast<std::uint32_t>(part.begin) : next;
                set_slab(node, node.count - 1, part);
                if (part.size() == 1) return;
                const Subtree below{next, part};
                next += nodes_over(part);
                if (lane_count * part.size() > parts_per_task)
                    later.push_back(below);
                else
                    spread(below, nodes, later);
            });
    }

    /// Orders the parts of a range so that those before the leaf `middle` have the smaller middles
    /// along the longest extent of all these. Long ranges stay along the Morton curve.
    void halve(const LeafRange& range, std::size_t middle)
    {
        if (lane_count * range.size() > parts_per_task) return;
        const auto at = [&](std::size_t leaf)
        { return parts_.data() + std::min(lane_count * leaf, n_parts_); };
        Box3 box;
        for (auto p = at(range.begin); p != at(range.end); ++p) box.add(p->box.min + p->box.max);
        const Vec3 size = box.max - box.min;
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        const auto key = [&](const FacetPart& p) { return p.box.min[axis] + p.box.max[axis]; };
        std::nth_element(at(range.begin), at(middle), at(range.end),
                         [&](const FacetPart& a, const FacetPart& b) { return key(a) < key(b); });
    }

    void make_parts()
    {
        std::vector<std::uint32_t> end(soup_.size());
        parallel_for(
            soup_.size(), threads_,
            [&](std::size_t f)
            { end[f] = static_cast<std::uint32_t>(parts_of_facet(&soup_.vertices[3 * f])); },
            1024);
        for (std::size_t f = 1; f < end.size(); ++f) end[f] += end[f - 1];
        n_parts_ = end.back();
        parts_ = RawArray<FacetPart>(n_parts_);
        parallel_for(
            soup_.size(), threads_,
            [&](std::size_t f)
            {
                const std::uint32_t begin = f == 0 ? 0 : end[f - 1];
                const auto n = static_cast<int>(end[f] - begin);
                for (int k = 0; k < n; ++k)
                    parts_[begin + static_cast<std::uint32_t>(k)] = {
                        box_of_part(&soup_.vertices[3 * f], k, n), static_cast<std::uint32_t>(f)};
            },
            1024);
    }

    /// Along the Morton curve of their middles, in 1024 cells along an axis.
    void sort_parts()
    {
        constexpr double cells = 1024;
        const auto cell_of = [&](const FacetPart& part, int axis)
        {
            const double at =
                (0.5 * (part.box.min[axis] + part.box.max[axis]) - centre_[axis]) / scale_;
            return static_cast<std::int64_t>(std::clamp(0.5 * cells * (1 + at), 0.0, cells - 1));
        };
        RawArray<Keyed> keys(n_parts_);
        parallel_for(
            n_parts_, threads_,
            [&](std::size_t p)
            {
                keys[p] = {
                    morton_key(cell_of(parts_[p], 0), cell_of(parts_[p], 1), cell_of(parts_[p], 2)),
                    static_cast<std::uint32_t>(p)};
            },
            1024);
        sort_by_key(keys, n_parts_, (1u << 30) - 1, threads_);
        RawArray<FacetPart> sorted(n_parts_);
        parallel_for(
            n_parts_, threads_, [&](std::size_t p) { sorted[p] = parts_[keys[p].index]; }, 1024);
        parts_.swap(sorted);
    }

    /// Returns the box of the leaf.
    Box3 fill(std::size_t l, TreeLeaf& leaf) const
    {
        Box3 box;
        const std::size_t begin = l * lane_count;
        leaf = {};
        leaf.count = static_cast<std::uint32_t>(std::min(n_parts_ - begin, lane_count));
        for (std::size_t c = 0; c < leaf.count; ++c)
        {
            const FacetPart& part = parts_[begin + c];
            leaf.facet[c] = part.facet;
            box.add(part.box.min);
            box.add(part.box.max);
            std::array<Vec3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) corners[k] = in_cube(part.facet, k);
            const auto planes = planes_around(corners);
            for (std::size_t p = 0; p < planes_of_facet; ++p)
            {
                leaf.planes[p].x[c] = static_cast<float>(planes[p].normal.x);
                leaf.planes[p].y[c] = static_cast<float>(planes[p].normal.y);
                leaf.planes[p].z[c] = static_cast<float>(planes[p].normal.z);
                leaf.planes[p].at[c] = static_cast<float>(planes[p].at);
            }
        }
        return box;
    }

    Vec3 in_cube(std::uint32_t facet, std::size_t corner) const
    {
        return (soup_.vertices[3 * std::size_t{facet} + corner] - centre_) / scale_;
    }

    void set_slab(TreeNode& node, std::uint32_t c, const LeafRange& range) const
    {
        const std::size_t begin = lane_count * range.begin;
        const std::size_t end = std::min(lane_count * range.end, n_parts_);
        if (end - begin > parts_in_slab) return;
        Vec3 sum;
        for (std::size_t p = begin; p < end; ++p)
        {
            const Vec3 corner = in_cube(parts_[p].facet, 0);
            sum = sum +
                  cross(in_cube(parts_[p].facet, 1) - corner, in_cube(parts_[p].facet, 2) - corner);
        }
        const double size = norm(sum);
        if (!(size > 0)) return;
        // As they are asked: rounded to float.
        std::array<float, 3> normal{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            normal[axis] = static_cast<float>(sum[static_cast<int>(axis)] / size);
            node.normal[axis][c] = normal[axis];
        }
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t k = 0; k < 3; ++k)
            {
                const double at =
                    dot(Vec3{normal[0], normal[1], normal[2]}, in_cube(parts_[p].facet, k));
                low = std::min(low, at);
                high = std::max(high, at);
            }
        node.slab_begin[c] = static_cast<float>(low - float_room);
        node.slab_end[c] = static_cast<float>(high + float_room);
    }

    void set_box(TreeNode& node, std::uint32_t c, const Box3& box) const
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto a = static_cast<std::size_t>(axis);
            node.low[a][c] =
                static_cast<float>((box.min[axis] - centre_[axis]) / scale_ - float_room);
            node.high[a][c] =
                static_cast<float>((box.max[axis] - centre_[axis]) / scale_ + float_room);
        }
    }

    const TriangleSoup& soup_;
    Vec3 centre_;
    double scale_;
    int threads_;
    RawArray<FacetPart> parts_;
    std::size_t n_parts_ = 0;
};

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

/// What cannot be told counts as within.
FPPG_LANES unsigned lanes_within(const Lanes& squared, float limit, std::uint32_t count)
{
    return ~set_lanes(squared > limit) & ((1u << count) - 1);
}

FPPG_LANES Lanes above_plane(const LeafPlanes& plane, const std::array<float, 3>& at)
{
    return plane.x * at[0] + plane.y * at[1] + plane.z * at[2] - plane.at;
}

/// The distance to a facet is no less than that to its plane, and in that plane than that beyond
/// any of its sides.
FPPG_LANES void look_at_leaf(const TreeLeaf& leaf, NearSearch& search)
{
    const Lanes height = above_plane(leaf.planes[0], search.at);
    const Lanes one = above_plane(leaf.planes[1], search.at);
    const Lanes two = above_plane(leaf.planes[2], search.at);
    const Lanes three = above_plane(leaf.planes[3], search.at);
    const Lanes beyond = larger(larger(one, two), larger(three, Lanes{}));
    const Lanes squared = height * height + beyond * beyond;
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
    const Lanes along = node.normal[0] * search.at[0] + node.normal[1] * search.at[1] +
                        node.normal[2] * search.at[2];
    const Lanes off_slab = larger(larger(node.slab_begin - along, Lanes{}), along - node.slab_end);
    squared = larger(squared, off_slab * off_slab);
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

} // namespace

struct NearTree::Nodes
{
    std::vector<TreeNode> nodes; ///< the first is the root
    RawArray<TreeLeaf> leaves;
};

NearTree::NearTree(const TriangleSoup& soup, const Vec3& centre, double scale, int threads)
    : soup_(soup), centre_(centre), scale_(scale), nodes_(std::make_unique<Nodes>())
{
    TreeMaker(soup, centre, scale, threads).make(nodes_->nodes, nodes_->leaves);
}

NearTree::~NearTree() = default;

ClosestPoint NearTree::closest(const Vec3& point, double within) const
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const ClosestPoint none{
        {infinity, infinity, infinity}, std::numeric_limits<std::uint32_t>::max(), infinity};
    const Vec3 unit = (point - centre_) / scale_;
    NearSearch search{
        &soup_,
        point,
        {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)},
        1 / scale_,
        (1 + norm(unit)) * float_room,
        0,
        none};
    search.set_limit(within);
    // Points are mostly asked for one beside the other: the last answer is a good bound.
    thread_local std::uint32_t last = 0;
    if (last < soup_.size()) search.look_at(last);
    if (search.best.distance > within)
    {
        search.best = none;
        search.set_limit(within);
    }
    (is_avx2_there() ? search_avx2 : search_plain)(nodes_->nodes, nodes_->leaves, search);
    if (search.best.facet < soup_.size()) last = search.best.facet;
    // A point at the limit itself may be computed to be beyond it by a rounding.
    const double most = within * (1 + float_room) + search.reach * scale_;
    return search.best.distance <= most ? search.best : none;
}

} // namespace fppg
