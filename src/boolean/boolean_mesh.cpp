#include "fppg/boolean.h"

#include "boolean/arrangement.h"
#include "core/parallel.h"
#include "fit/closed_part.h"
#include "fppg/error.h"
#include "fppg/shapes.h"
#include "meshes/connect_mesh.h"
#include "meshes/inside_test.h"
#include "meshes/mesh_facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

namespace fppg
{
namespace
{

/// Three roundings of a coordinate in float32.
constexpr double default_merge = 2e-7;
/// Surfaces that meet at less than this are one; a flat seam is no line.
constexpr double flat_seam_deg = 0.5;
/// Facets of a patch that are asked where they are; they must agree.
constexpr std::size_t asked_facets = 7;
/// Facets lower than this many merge distances are slivers.
constexpr double sliver_height = 4;

/// Where a surface lies, seen from another part.
enum class Where : char
{
    Outside,
    Inside,
    OnSame,     ///< on its surface, facing the same way
    OnOpposite, ///< on its surface, facing the other way
};

/// A part made ready for questions about its inside.
class Solid
{
public:
    Solid(const BooleanPart& part, int threads) : closed_(find_closed_part(*part.mesh))
    {
        TriangleSoup soup = soup_of_closed_part(*part.mesh, closed_);
        has_inside_ = !part.is_surface && closed_.volume > 0 && soup.size() > 0;
        if (!has_inside_)
        {
            if (!part.may_be_sheet && !part.is_surface)
                throw GeometryError(fmt::format(
                    "the part '{}' bounds no volume, so that nothing is inside or outside it; "
                    "close its mesh, or say that it is a sheet",
                    part.name));
            return;
        }
        for (const Vec3& v : soup.vertices) bounds_.add(v);
        inside_ = std::make_unique<InsideTest>(std::move(soup), threads);
    }

    bool has_inside() const { return has_inside_; }
    bool is_sheet_facet(std::uint32_t f) const
    {
        return !has_inside_ || closed_.is_bounding[f] == 0;
    }

    Where where(const Vec3& p, const Vec3& normal, double merge_distance) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < bounds_.min[axis] - merge_distance ||
                p[axis] > bounds_.max[axis] + merge_distance)
                return Where::Outside;
        const ClosestPoint closest = inside_->query().closest_point(p);
        if (closest.distance < merge_distance)
        {
            const TriangleSoup& soup = inside_->query().soup();
            const Vec3* c = &soup.vertices[3 * static_cast<std::size_t>(closest.facet)];
            const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
            const double across = dot(n, normal) / norm(n);
            // A surface that only comes near at an angle is judged by what is behind it.
            if (std::abs(across) > 0.999) return across > 0 ? Where::OnSame : Where::OnOpposite;
        }
        return inside_->is_inside(p) ? Where::Inside : Where::Outside;
    }

    bool is_deeper(const Vec3& p, double depth) const
    {
        return bounds_.has(p, 0) && inside_->query().closest_point(p).distance > depth &&
               inside_->is_inside(p);
    }

private:
    ClosedPart closed_;
    Box3 bounds_;
    std::unique_ptr<InsideTest> inside_;
    bool has_inside_ = false;
};

void check_tree(const BooleanNode& node, std::size_t parts)
{
    if (node.op == BooleanOp::Part)
    {
        if (node.part >= parts)
            throw GeometryError(fmt::format("part {} of {} is not there", node.part + 1, parts));
        return;
    }
    if (node.operands.empty()) throw GeometryError("a combination without an operand");
    for (const BooleanNode& operand : node.operands) check_tree(operand, parts);
}

/// A side of a facet of the arrangement.
struct SideUse
{
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t facet = 0;
    bool operator<(const SideUse& o) const
    {
        if (low != o.low) return low < o.low;
        return high != o.high ? high < o.high : facet < o.facet;
    }
};

class Combiner
{
public:
    Combiner(const std::vector<BooleanPart>& parts, const BooleanNode& node,
             const BooleanOptions& options, int threads)
        : parts_(parts), node_(node), threads_(threads), merge_(options.merge_distance)
    {
        check_tree(node, parts.size());
        double largest = 0;
        for (const BooleanPart& part : parts)
            for (const Vec3& v : part.mesh->vertices)
                for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(v[axis]));
        if (!(merge_ > 0)) merge_ = std::min(default_merge * largest, widest_crack(options.dp));
        solids_.reserve(parts.size()); // a solid refers to itself
        for (const BooleanPart& part : parts) solids_.emplace_back(part, threads);
    }

    BooleanMesh run()
    {
        std::vector<const SurfaceMesh*> meshes;
        for (const BooleanPart& part : parts_) meshes.push_back(part.mesh);
        all_ = arrange(meshes, merge_, threads_);
        BooleanMesh out;
        out.crossing_pairs = all_.crossing_pairs;
        out.coplanar_pairs = all_.coplanar_pairs;
        find_copies();
        find_patches();
        out.patches = patches_.size();
        choose_facets();
        choose_slivers();
        gather(out);
        find_seams(out);
        judge(out);
        return out;
    }

private:
    Vec3 corner(std::uint32_t f, std::size_t k) const
    {
        return all_.vertices[all_.facets[f].corners[k]];
    }
    double area2(std::uint32_t f) const
    {
        return norm(cross(corner(f, 1) - corner(f, 0), corner(f, 2) - corner(f, 0)));
    }
    Vec3 middle(std::uint32_t f) const { return (corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3; }
    const Vec3& normal(std::uint32_t f) const
    {
        return parts_[all_.facets[f].part].mesh->normals[all_.facets[f].facet];
    }

    /// Facets with the same corners: the first of them, and whether they run the other way.
    void find_copies()
    {
        struct Key
        {
            std::array<std::uint32_t, 3> sorted;
            std::uint32_t facet;
        };
        std::vector<Key> keys(all_.facets.size());
        parallel_for(
            keys.size(), threads_,
            [&](std::size_t f)
            {
                keys[f] = {all_.facets[f].corners, static_cast<std::uint32_t>(f)};
                std::sort(keys[f].sorted.begin(), keys[f].sorted.end());
            },
            4096);
        std::sort(keys.begin(), keys.end(),
                  [](const Key& a, const Key& b)
                  { return a.sorted != b.sorted ? a.sorted < b.sorted : a.facet < b.facet; });
        first_copy_.resize(keys.size());
        copies_.clear();
        for (std::size_t i = 0; i < keys.size();)
        {
            std::size_t j = i;
            for (; j < keys.size() && keys[j].sorted == keys[i].sorted; ++j)
                first_copy_[keys[j].facet] = keys[i].facet;
            if (j - i > 1)
                for (std::size_t k = i; k < j; ++k)
                    copies_.emplace_back(keys[i].facet, keys[k].facet);
            i = j;
        }
        std::sort(copies_.begin(), copies_.end());
    }

    /// Whether the corners run round as their sorted order does.
    static bool rotation(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        return (a < b && b < c) || (b < c && c < a) || (c < a && a < b);
    }

    /// Facets of one part that are connected without passing a side of another part.
    void find_patches()
    {
        std::vector<SideUse> sides(3 * all_.facets.size());
        parallel_for(
            all_.facets.size(), threads_,
            [&](std::size_t f)
            {
                const auto& c = all_.facets[f].corners;
                for (std::size_t s = 0; s < 3; ++s)
                {
                    const auto [low, high] = std::minmax(c[s], c[(s + 1) % 3]);
                    sides[3 * f + s] = {low, high, static_cast<std::uint32_t>(f)};
                }
            },
            4096);
        std::sort(sides.begin(), sides.end());
        std::vector<std::uint32_t> above(all_.facets.size());
        std::iota(above.begin(), above.end(), 0U);
        const auto find = [&above](std::uint32_t i)
        {
            while (above[i] != i) i = above[i] = above[above[i]];
            return i;
        };
        for (std::size_t i = 0; i < sides.size();)
        {
            std::size_t j = i;
            bool is_shared = false;
            const std::uint32_t part = all_.facets[sides[i].facet].part;
            for (;
                 j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high;
                 ++j)
                is_shared = is_shared || all_.facets[sides[j].facet].part != part;
            for (std::size_t k = i + 1; k < j && !is_shared; ++k)
            {
                const std::uint32_t a = find(sides[i].facet), b = find(sides[k].facet);
                // Sheets of a part go by themselves.
                if (a != b && is_sheet(sides[i].facet) == is_sheet(sides[k].facet))
                    above[std::max(a, b)] = std::min(a, b);
            }
            i = j;
        }
        std::vector<std::uint32_t> index(all_.facets.size(), no_index);
        for (std::uint32_t f = 0; f < all_.facets.size(); ++f)
        {
            const std::uint32_t head = find(f);
            if (index[head] == no_index)
            {
                index[head] = static_cast<std::uint32_t>(patches_.size());
                patches_.emplace_back();
            }
            patches_[index[head]].push_back(f);
        }
    }

    bool is_sheet(std::uint32_t f) const
    {
        return solids_[all_.facets[f].part].is_sheet_facet(all_.facets[f].facet);
    }

    /// Where the facet lies, seen from every other part.
    std::vector<Where> places(std::uint32_t f) const
    {
        std::vector<Where> out(parts_.size(), Where::Outside);
        std::vector<char> is_known(parts_.size(), 0);
        is_known[all_.facets[f].part] = 1;
        for (auto it =
                 std::lower_bound(copies_.begin(), copies_.end(), std::pair(first_copy_[f], 0U));
             it != copies_.end() && it->first == first_copy_[f]; ++it)
        {
            const std::uint32_t g = it->second;
            const std::uint32_t part = all_.facets[g].part;
            if (is_known[part] != 0 || is_sheet(g) || asks_depth(f, part)) continue;
            is_known[part] = 1;
            out[part] = same_way(f, g) ? Where::OnSame : Where::OnOpposite;
        }
        const Vec3 p = middle(f);
        for (std::size_t part = 0; part < parts_.size(); ++part)
            if (is_known[part] == 0 && solids_[part].has_inside())
            {
                if (!asks_depth(f, static_cast<std::uint32_t>(part)))
                    out[part] = solids_[part].where(p, normal(f), merge_);
                else if (solids_[part].is_deeper(p, parts_[part].least_depth))
                    out[part] = Where::Inside;
            }
        return out;
    }

    bool asks_depth(std::uint32_t f, std::uint32_t part) const
    {
        return is_sheet(f) && parts_[part].least_depth > 0;
    }

    /// Where the facets asked of a patch lie. A patch of a sheet is on one side of every part as a
    /// whole, and as deep in it as its deepest place.
    std::vector<std::vector<Where>> places_in_patch(const std::vector<std::uint32_t>& asked) const
    {
        std::vector<std::vector<Where>> out;
        for (const std::uint32_t f : asked) out.push_back(places(f));
        for (std::uint32_t part = 0; part < parts_.size(); ++part)
        {
            if (!asks_depth(asked[0], part)) continue;
            const bool is_deep = std::any_of(out.begin(), out.end(),
                                             [&](const std::vector<Where>& where)
                                             { return where[part] == Where::Inside; });
            for (std::vector<Where>& where : out)
                where[part] = is_deep ? Where::Inside : Where::Outside;
        }
        return out;
    }

    bool same_way(std::uint32_t f, std::uint32_t g) const
    {
        const auto& a = all_.facets[f].corners;
        const auto& b = all_.facets[g].corners;
        return rotation(a[0], a[1], a[2]) == rotation(b[0], b[1], b[2]);
    }

    enum class Verdict : char
    {
        Drop,
        Keep,
        KeepTurned,
    };

    Verdict judge_facet(std::uint32_t f, const std::vector<Where>& where,
                        std::uint32_t& owner) const
    {
        const std::uint32_t own = all_.facets[f].part;
        std::vector<char> outer(parts_.size()), inner(parts_.size());
        for (std::size_t p = 0; p < parts_.size(); ++p)
        {
            outer[p] = where[p] == Where::Inside || where[p] == Where::OnOpposite;
            inner[p] = where[p] == Where::Inside || where[p] == Where::OnSame;
        }
        owner = own;
        if (is_sheet(f))
        {
            // Of a part with an inside, a sheet lies in the inside or out of it as its other
            // facets.
            outer[own] = 0;
            inner[own] = 1;
            for (std::size_t p = 0; p < parts_.size(); ++p)
                if (p != own)
                {
                    if (where[p] == Where::OnSame || where[p] == Where::OnOpposite)
                        return Verdict::Drop; // the solid has this surface already
                }
            return !evaluate(node_, outer) && evaluate(node_, inner) ? Verdict::Keep
                                                                     : Verdict::Drop;
        }
        outer[own] = 0;
        inner[own] = 1;
        const bool before = evaluate(node_, outer), behind = evaluate(node_, inner);
        if (before == behind) return Verdict::Drop;
        // Of surfaces in one place that of the first part stays.
        for (std::size_t p = 0; p < own; ++p)
            if (where[p] == Where::OnSame || where[p] == Where::OnOpposite) return Verdict::Drop;
        if (behind) return Verdict::Keep;
        for (std::uint32_t p = 0; p < parts_.size(); ++p)
            if (outer[p] != 0 && stays_[p] != 0)
            {
                owner = p;
                break;
            }
        return Verdict::KeepTurned;
    }

    /// The largest facets of a patch, so that none is a sliver along a seam.
    std::vector<std::uint32_t> largest_of(const std::vector<std::uint32_t>& patch) const
    {
        std::vector<std::pair<double, std::uint32_t>> by_area;
        by_area.reserve(patch.size());
        for (const std::uint32_t f : patch) by_area.emplace_back(-area2(f), f);
        const std::size_t n = std::min(asked_facets, by_area.size());
        std::partial_sort(by_area.begin(), by_area.begin() + static_cast<std::ptrdiff_t>(n),
                          by_area.end());
        std::vector<std::uint32_t> out;
        for (std::size_t i = 0; i < n; ++i) out.push_back(by_area[i].second);
        return out;
    }

    void choose_facets()
    {
        verdicts_.assign(all_.facets.size(), Verdict::Drop);
        owners_.assign(all_.facets.size(), 0);
        stays_ = staying_parts(node_, parts_.size());
        parallel_for(
            patches_.size(), threads_,
            [&](std::size_t i)
            {
                const std::vector<std::uint32_t>& patch = patches_[i];
                const std::vector<std::uint32_t> asked = largest_of(patch);
                const std::vector<std::vector<Where>> found = places_in_patch(asked);
                const std::vector<Where>& where = found[0];
                const bool is_whole =
                    std::all_of(found.begin() + 1, found.end(),
                                [&](const std::vector<Where>& other) { return other == where; });
                for (const std::uint32_t f : patch)
                    verdicts_[f] = judge_facet(f, is_whole ? where : places(f), owners_[f]);
            },
            1);
    }

    /// Whether the facet is no higher than what counts as touching: where it lies is chance.
    bool is_sliver(std::uint32_t f) const
    {
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, norm(corner(f, (k + 1) % 3) - corner(f, k)));
        return area2(f) < sliver_height * merge_ * longest;
    }

    static int balance_of(Verdict v)
    {
        return v == Verdict::Keep ? 1 : v == Verdict::KeepTurned ? -1 : 0;
    }

    /// Slivers are kept, turned or left out as it closes the surface around them.
    void choose_slivers()
    {
        std::vector<std::uint32_t> slivers;
        for (std::uint32_t f = 0; f < all_.facets.size(); ++f)
            if (is_sliver(f)) slivers.push_back(f);
        if (slivers.empty()) return;
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
        const auto for_each_side = [&](std::uint32_t f, const auto& visit)
        {
            const auto& c = all_.facets[f].corners;
            for (std::size_t s = 0; s < 3; ++s)
                visit(std::minmax(c[s], c[(s + 1) % 3]), c[s] < c[(s + 1) % 3] ? 1 : -1);
        };
        for (const std::uint32_t f : slivers)
            for_each_side(f, [&](const auto& side, int) { balance[side] = 0; });
        for (std::uint32_t f = 0; f < all_.facets.size(); ++f)
            if (verdicts_[f] != Verdict::Drop)
                for_each_side(f,
                              [&](const auto& side, int way)
                              {
                                  const auto at = balance.find(side);
                                  if (at != balance.end())
                                      at->second += way * balance_of(verdicts_[f]);
                              });
        bool has_changed = true;
        for (int pass = 0; pass < 4 && has_changed; ++pass)
        {
            has_changed = false;
            for (const std::uint32_t f : slivers)
            {
                const Verdict old = verdicts_[f];
                const auto cost = [&](Verdict v)
                {
                    int sum = 0;
                    for_each_side(f,
                                  [&](const auto& side, int way) {
                                      sum += std::abs(balance[side] +
                                                      way * (balance_of(v) - balance_of(old)));
                                  });
                    return sum;
                };
                Verdict best = old;
                for (const Verdict v : {Verdict::Drop, Verdict::Keep, Verdict::KeepTurned})
                    if (cost(v) < cost(best)) best = v;
                if (best == old) continue;
                for_each_side(f, [&](const auto& side, int way)
                              { balance[side] += way * (balance_of(best) - balance_of(old)); });
                verdicts_[f] = best;
                has_changed = true;
            }
        }
    }

    void gather(BooleanMesh& out)
    {
        std::vector<std::uint32_t> index(all_.vertices.size(), no_index);
        std::vector<Vec3> normals;
        for (std::uint32_t f = 0; f < all_.facets.size(); ++f)
        {
            if (verdicts_[f] == Verdict::Drop) continue;
            auto corners = all_.facets[f].corners;
            const bool is_turned = verdicts_[f] == Verdict::KeepTurned;
            if (is_turned) std::swap(corners[1], corners[2]);
            for (std::uint32_t& v : corners)
            {
                if (index[v] == no_index)
                {
                    index[v] = static_cast<std::uint32_t>(out.mesh.vertices.size());
                    out.mesh.vertices.push_back(all_.vertices[v]);
                }
                v = index[v];
            }
            out.mesh.facets.push_back(corners);
            out.parts.push_back(all_.facets[f].part);
            out.facets.push_back(all_.facets[f].facet);
            out.owners.push_back(owners_[f]);
            normals.push_back(is_turned ? -normal(f) : normal(f));
        }
        if (out.mesh.facets.empty()) return;
        connect_mesh(out.mesh, std::numeric_limits<double>::infinity(), threads_, out.report);
        // Slivers along a seam have the direction of the facet that they were cut from.
        out.mesh.normals = std::move(normals);
    }

    void find_seams(BooleanMesh& out) const
    {
        const SurfaceMesh& mesh = out.mesh;
        const double limit = flat_seam_deg * 3.14159265358979323846 / 180;
        for (std::uint32_t e = 0; e < mesh.edges.size(); ++e)
        {
            const auto [f, g] = mesh.edge_facets[e];
            if (g == no_index) continue;
            if (mesh.is_manifold[e] == 0)
            {
                out.seams.push_back(e);
                continue;
            }
            if (out.parts[f] == out.parts[g]) continue;
            if (angle_between(mesh.normals[f], mesh.normals[g]) > limit) out.seams.push_back(e);
        }
    }

    void judge(BooleanMesh& out) const
    {
        std::size_t open = 0;
        for (const BooleanPart& part : parts_)
            for (const auto& e : part.mesh->edge_facets) open += e[1] == no_index ? 1 : 0;
        if (open == 0 && out.report.open_edges > 0)
            out.warnings.push_back(fmt::format(
                "{} edges of the combined surface are open though its parts are closed: facets of "
                "the parts nearly touch there within {:.3g} m.",
                out.report.open_edges, merge_));
    }

    const std::vector<BooleanPart>& parts_;
    const BooleanNode& node_;
    int threads_;
    double merge_;
    std::vector<Solid> solids_;
    Arrangement all_;
    std::vector<std::uint32_t> first_copy_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> copies_; ///< first one, copy
    std::vector<std::vector<std::uint32_t>> patches_;
    std::vector<Verdict> verdicts_;
    std::vector<std::uint32_t> owners_;
    std::vector<char> stays_; ///< per part
};

} // namespace

BooleanMesh boolean_mesh(const std::vector<BooleanPart>& parts, const BooleanNode& node,
                         const BooleanOptions& options, int threads)
{
    return Combiner(parts, node, options, threads).run();
}

SpanSet solid_nodes(const SurfaceMesh& mesh, const LatticeGrid& grid, int threads)
{
    const ClosedPart closed = find_closed_part(mesh);
    const TriangleSoup soup = soup_of_closed_part(mesh, closed);
    if (!(closed.volume > 0) || soup.size() == 0) return {};
    if (closed.is_exact) return inside_spans(soup, grid, threads);
    std::uint64_t disputed = 0;
    return inside_by_vote(soup, grid, threads, disputed);
}

} // namespace fppg
