#include "meshes/facet_tree.h"

#include "core/morton.h"
#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace fppg
{
namespace
{

/// Below so many parts one thread halves on.
constexpr std::size_t parts_per_task = 4096;

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

    FacetTree make()
    {
        FacetTree out;
        std::vector<TreeNode>& nodes = out.nodes;
        RawArray<TreeLeaf>& leaves = out.leaves;
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
        return out;
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
                {
                    parts_[begin + static_cast<std::uint32_t>(k)] = {
                        box_of_part(&soup_.vertices[3 * f], k, n), static_cast<std::uint32_t>(f)};
                }
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
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = (soup_.vertices[3 * std::size_t{part.facet} + k] - centre_) / scale_;
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

} // namespace

FacetTree make_facet_tree(const TriangleSoup& soup, const Vec3& centre, double scale, int threads)
{
    return TreeMaker(soup, centre, scale, threads).make();
}

} // namespace fppg
