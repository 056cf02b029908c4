#include "fppg/section.h"

#include "fppg/error.h"

#include "fit/plane_cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fppg
{
namespace
{

/// A line of the section; segment k runs from point k to point k + 1, the last one of a closed
/// chain to point 0.
struct Chain
{
    std::vector<Vec3> points;
    std::vector<std::uint32_t> facets; ///< per segment
    bool is_closed = false;
    std::vector<double> arcs; ///< length up to the start of each segment, then the whole length

    double length() const { return arcs.back(); }
    const Vec3& end_of(std::size_t segment) const { return points[(segment + 1) % points.size()]; }
};

/// For every piece the one that follows it and the one before, or no_index. Where an edge has more
/// than two facets, pieces are paired in the order of their facets.
struct Links
{
    std::vector<std::uint32_t> next;
    std::vector<std::uint32_t> previous;

    explicit Links(const std::vector<PlanePiece>& pieces)
        : next(pieces.size(), no_index), previous(pieces.size(), no_index)
    {
        using Entry = std::pair<std::uint32_t, std::uint32_t>; // edge, piece
        std::vector<Entry> starts;
        std::vector<Entry> ends;
        for (std::uint32_t p = 0; p < pieces.size(); ++p)
        {
            starts.emplace_back(pieces[p].from_edge, p);
            ends.emplace_back(pieces[p].to_edge, p);
        }
        std::sort(starts.begin(), starts.end());
        std::sort(ends.begin(), ends.end());
        auto start = starts.begin();
        for (const auto& [edge, piece] : ends)
        {
            while (start != starts.end() && start->first < edge) ++start;
            if (start == starts.end() || start->first != edge) continue;
            next[piece] = start->second;
            previous[start->second] = piece;
            ++start;
        }
    }
};

class Section
{
public:
    Section(const SurfaceMesh& mesh, const SectionOptions& options) : mesh_(mesh), options_(options)
    {
    }

    SectionParticles run()
    {
        find_chains();
        double count = 0;
        for (const Chain& chain : chains_)
            count += static_cast<double>(chain.points.size()) + chain.length() / options_.dp;
        if (!(count < 4294967294.0))
            throw GeometryError(
                fmt::format("a particle distance of {:g} m needs {:g} particles on the section",
                            options_.dp, count));
        for (const Chain& chain : chains_)
        {
            measure(chain);
            place(chain);
        }
        SectionParticles& out = corners_;
        const auto append = [](auto& to, const auto& from)
        { to.insert(to.end(), from.begin(), from.end()); };
        append(out.positions, others_.positions);
        append(out.kinds, others_.kinds);
        append(out.normals, others_.normals);
        append(out.facets, others_.facets);
        return std::move(out);
    }

private:
    void find_chains()
    {
        const std::vector<PlanePiece> pieces = cut_with_plane(mesh_, options_.y);
        const Links links(pieces);
        std::vector<char> is_used(pieces.size(), 0);
        for (std::uint32_t p = 0; p < pieces.size(); ++p)
        {
            if (is_used[p] != 0) continue;
            std::uint32_t first = p;
            while (links.previous[first] != no_index && links.previous[first] != p)
                first = links.previous[first];
            const bool is_closed = links.previous[first] != no_index;
            if (is_closed) first = p;
            std::vector<PlanePiece> walked;
            for (std::uint32_t at = first; at != no_index && is_used[at] == 0; at = links.next[at])
            {
                is_used[at] = 1;
                walked.push_back(pieces[at]);
            }
            add_chain(walked, is_closed);
        }
    }

    /// Segments so short that their ways are rounding are joined to their neighbours.
    void add_chain(const std::vector<PlanePiece>& pieces, bool is_closed)
    {
        const double shortest = 1e-6 * options_.dp;
        Chain chain;
        chain.is_closed = is_closed;
        chain.points.push_back(plane_crossing(mesh_, pieces.front().from_edge, options_.y));
        for (const PlanePiece& piece : pieces)
        {
            const Vec3 p = plane_crossing(mesh_, piece.to_edge, options_.y);
            if (norm(p - chain.points.back()) <= shortest) continue;
            chain.points.push_back(p);
            chain.facets.push_back(piece.facet);
        }
        if (is_closed)
        {
            // The walk comes back to its first point, or so near that the last segment was joined.
            while (chain.points.size() > 1 &&
                   norm(chain.points.back() - chain.points.front()) <= shortest)
                chain.points.pop_back();
            chain.facets.resize(std::min(chain.facets.size(), chain.points.size()));
        }
        if (chain.facets.empty() || (is_closed && chain.points.size() < 2)) return;
        chain.arcs.push_back(0);
        for (std::size_t k = 0; k < chain.facets.size(); ++k)
            chain.arcs.push_back(chain.arcs.back() + norm(chain.end_of(k) - chain.points[k]));
        chains_.push_back(std::move(chain));
    }

    void measure(const Chain& chain)
    {
        corners_.length += chain.length();
        ++(chain.is_closed ? corners_.closed_chains : corners_.open_chains);
        if (!chain.is_closed) return;
        // With x to the right and z up, chains run clockwise around what they enclose.
        const Vec3& from = chain.points[0];
        for (std::size_t k = 0; k < chain.facets.size(); ++k)
        {
            const Vec3 a = chain.points[k] - from;
            const Vec3 b = chain.end_of(k) - from;
            corners_.area += 0.5 * (a.z * b.x - a.x * b.z);
        }
    }

    /// The normal within the plane.
    Vec3 normal_of(const Chain& chain, std::size_t segment) const
    {
        Vec3 normal = mesh_.normals[chain.facets[segment]];
        normal.y = 0;
        const double length = norm(normal);
        if (length > 1e-6) return normal / length;
        const Vec3 way = chain.end_of(segment) - chain.points[segment];
        return Vec3{-way.z, 0, way.x} / norm(way);
    }

    /// A chord of a round surface may turn sharply where the plane hardly cuts into it, so the
    /// surface must turn as well.
    bool is_corner(const Chain& chain, std::size_t before, std::size_t after) const
    {
        const double limit = (options_.feature_angle_deg + 0.01) * std::numbers::pi / 180;
        return angle_between(normal_of(chain, before), normal_of(chain, after)) > limit &&
               angle_between(mesh_.normals[chain.facets[before]],
                             mesh_.normals[chain.facets[after]]) > limit;
    }

    /// Indices of the points that are corners and keep their distance along the chain.
    std::vector<std::size_t> corners_of(const Chain& chain) const
    {
        const std::size_t segments = chain.facets.size();
        const double apart = least_pair_dp * options_.dp * (1 - 1e-12);
        std::vector<std::size_t> kept;
        for (std::size_t k = 0; k <= segments; ++k)
        {
            const bool is_end = k == 0 || k == segments;
            if (chain.is_closed
                    ? k == segments || !is_corner(chain, (k + segments - 1) % segments, k)
                    : !is_end && !is_corner(chain, k - 1, k))
                continue;
            if (!kept.empty() && chain.arcs[k] - chain.arcs[kept.back()] < apart) continue;
            const double rest = chain.length() - chain.arcs[k];
            const bool is_near_end = chain.is_closed
                                         ? !kept.empty() && rest + chain.arcs[kept[0]] < apart
                                         : k > 0 && k < segments && rest < apart;
            if (!is_near_end) kept.push_back(k);
        }
        return kept;
    }

    void place(const Chain& chain)
    {
        const std::vector<std::size_t> corners = corners_of(chain);
        for (const std::size_t k : corners) add_corner(chain, k);
        if (corners.empty())
        {
            add_stretch(chain, 0, chain.length(), true);
            return;
        }
        for (std::size_t i = 0; i + 1 < corners.size(); ++i)
            add_stretch(chain, chain.arcs[corners[i]], chain.arcs[corners[i + 1]], false);
        if (chain.is_closed)
            add_stretch(chain, chain.arcs[corners.back()],
                        chain.length() + chain.arcs[corners.front()], false);
    }

    void add_corner(const Chain& chain, std::size_t k)
    {
        const std::size_t segments = chain.facets.size();
        const bool has_before = chain.is_closed || k > 0;
        const bool has_after = chain.is_closed || k < segments;
        const std::size_t before = has_before ? (k + segments - 1) % segments : k;
        const std::size_t after = has_after ? k : before;
        const Vec3 one = normal_of(chain, after);
        const Vec3 sum = one + normal_of(chain, before);
        corners_.positions.push_back(chain.points[k]);
        corners_.kinds.push_back(FitKind::Corner);
        corners_.normals.push_back(norm(sum) > 1e-6 ? sum / norm(sum) : one);
        corners_.facets.push_back(chain.facets[after]);
    }

    /// Even particles between two places along the chain, and at the first one if it has none yet.
    /// Lengths are met to a millionth: those of turned shapes and of offsets are rounded.
    void add_stretch(const Chain& chain, double begin, double end, bool with_begin)
    {
        double parts = std::max(1.0, std::ceil((end - begin) / options_.dp * (1 - 1e-6)));
        if (parts == 2 && end - begin < 2 * least_pair_dp * options_.dp) parts = 1;
        for (double i = with_begin ? 0 : 1; i < parts; ++i)
        {
            double s = begin + (end - begin) * (i / parts);
            if (s >= chain.length() && chain.is_closed) s -= chain.length();
            const auto above = std::upper_bound(chain.arcs.begin() + 1, chain.arcs.end() - 1, s);
            const auto k = static_cast<std::size_t>(above - chain.arcs.begin()) - 1;
            const Vec3& a = chain.points[k];
            const Vec3& b = chain.end_of(k);
            const double share =
                std::clamp((s - chain.arcs[k]) / (chain.arcs[k + 1] - chain.arcs[k]), 0.0, 1.0);
            others_.positions.push_back(
                {a.x + (b.x - a.x) * share, options_.y, a.z + (b.z - a.z) * share});
            others_.kinds.push_back(FitKind::Surface);
            others_.normals.push_back(normal_of(chain, k));
            others_.facets.push_back(chain.facets[k]);
        }
    }

    const SurfaceMesh& mesh_;
    const SectionOptions& options_;
    std::vector<Chain> chains_;
    SectionParticles corners_;
    SectionParticles others_;
};

} // namespace

SectionParticles section_particles(const SurfaceMesh& mesh, const SectionOptions& options)
{
    if (!(options.dp > 0) || !std::isfinite(options.dp))
        throw GeometryError(
            fmt::format("a particle distance of {} m, expected more than 0", options.dp));
    if (!(options.feature_angle_deg >= 0) || !(options.feature_angle_deg < 180))
        throw GeometryError(fmt::format("a feature angle of {} degrees, expected 0 to below 180",
                                        options.feature_angle_deg));
    return Section(mesh, options).run();
}

} // namespace fppg
