#include "fppg/features.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "fppg/error.h"
#include "meshes/point_grid.h"

namespace fppg
{

namespace
{

constexpr double degree = 3.14159265358979323846 / 180;
/// Between angles that are meant to be equal.
constexpr double spare_deg = 0.01;
/// No place of a line is farther from a particle, dp. At least_pair_dp, where lines crowd there
/// would be up to twice as many particles as elsewhere.
constexpr double line_reach_dp = 0.7;

bool is_feature(const SurfaceMesh& mesh, std::size_t e, double limit)
{
    const auto [f, g] = mesh.edge_facets[e];
    if (g == no_index || mesh.is_manifold[e] == 0) return true;
    return angle_between(mesh.normals[f], mesh.normals[g]) > limit;
}

/// The feature edges at each vertex, ascending.
struct Fans
{
    std::vector<std::uint32_t> begin; ///< vertex v has entries begin[v] to begin[v + 1]
    std::vector<std::uint32_t> edges;

    std::uint32_t count(std::size_t v) const { return begin[v + 1] - begin[v]; }
};

Fans collect_fans(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& edges)
{
    Fans fans;
    fans.begin.assign(mesh.vertices.size() + 1, 0);
    for (const std::uint32_t e : edges)
        for (const std::uint32_t v : mesh.edges[e]) ++fans.begin[v + 1];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) fans.begin[v + 1] += fans.begin[v];
    fans.edges.resize(fans.begin.back());
    std::vector<std::uint32_t> at(fans.begin.begin(), fans.begin.end() - 1);
    for (const std::uint32_t e : edges)
        for (const std::uint32_t v : mesh.edges[e]) fans.edges[at[v]++] = e;
    return fans;
}

std::uint32_t other_end(const SurfaceMesh& mesh, std::uint32_t e, std::uint32_t v)
{
    return mesh.edges[e][0] == v ? mesh.edges[e][1] : mesh.edges[e][0];
}

bool is_singular(const SurfaceMesh& mesh, const Fans& fans, std::uint32_t v, double limit)
{
    const std::uint32_t count = fans.count(v);
    if (count != 2) return count != 0;
    const std::uint32_t* edges = &fans.edges[fans.begin[v]];
    const Vec3 in = mesh.vertices[v] - mesh.vertices[other_end(mesh, edges[0], v)];
    const Vec3 out = mesh.vertices[other_end(mesh, edges[1], v)] - mesh.vertices[v];
    return angle_between(in, out) > limit;
}

} // namespace

Features find_features(const SurfaceMesh& mesh, const FeatureOptions& options,
                       const std::vector<std::uint32_t>& always, std::span<const float> bends)
{
    if (!(options.angle_deg >= 0 && options.angle_deg < 180))
        throw GeometryError(
            fmt::format("a feature angle of {} degrees, expected 0 or more and less than 180",
                        options.angle_deg));
    if (!(options.corner_angle_deg >= 0 && options.corner_angle_deg <= 180))
        throw GeometryError(fmt::format("a corner angle of {} degrees, expected 0 to 180",
                                        options.corner_angle_deg));
    Features features;
    features.is_feature_edge.assign(mesh.edges.size(), 0);
    for (const std::uint32_t e : always) features.is_feature_edge[e] = 1;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        const bool is_known = !bends.empty() && bends[e] >= 0;
        const bool bends_enough =
            is_known ? bends[e] > options.cad_angle_deg * degree
                     : is_feature(mesh, e, (options.angle_deg + spare_deg) * degree);
        if (features.is_feature_edge[e] == 0 && !bends_enough) continue;
        features.is_feature_edge[e] = 1;
        features.edges.push_back(static_cast<std::uint32_t>(e));
    }
    const Fans fans = collect_fans(mesh, features.edges);
    std::vector<char> ends_line(mesh.vertices.size(), 0);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    {
        if (!is_singular(mesh, fans, v, (options.corner_angle_deg + spare_deg) * degree)) continue;
        ends_line[v] = 1;
        features.singular.push_back(v);
    }

    std::vector<char> is_taken(mesh.edges.size(), 0);
    const auto walk = [&](std::uint32_t start, std::uint32_t e)
    {
        FeatureLine line;
        line.vertices.push_back(start);
        std::uint32_t v = start;
        while (true)
        {
            is_taken[e] = 1;
            line.edges.push_back(e);
            line.length += norm(mesh.vertices[mesh.edges[e][1]] - mesh.vertices[mesh.edges[e][0]]);
            v = other_end(mesh, e, v);
            line.is_closed = v == start && ends_line[v] == 0;
            if (!line.is_closed) line.vertices.push_back(v);
            if (line.is_closed || ends_line[v] != 0) break;
            const std::uint32_t* next = &fans.edges[fans.begin[v]];
            e = next[0] == e ? next[1] : next[0];
        }
        features.lines.push_back(std::move(line));
    };
    for (const std::uint32_t v : features.singular)
        for (std::uint32_t i = fans.begin[v]; i < fans.begin[v + 1]; ++i)
            if (is_taken[fans.edges[i]] == 0) walk(v, fans.edges[i]);
    for (const std::uint32_t e : features.edges)
        if (is_taken[e] == 0) walk(mesh.edges[e][0], e);
    return features;
}

namespace
{

/// A line by arc length.
class LineWalk
{
public:
    LineWalk(const SurfaceMesh& mesh, const FeatureLine& line) : mesh_(mesh), line_(line)
    {
        from_.reserve(line.edges.size() + 1);
        from_.push_back(0);
        for (const std::uint32_t e : line.edges)
            from_.push_back(from_.back() + norm(mesh.vertices[mesh.edges[e][1]] -
                                                mesh.vertices[mesh.edges[e][0]]));
    }

    double length() const { return from_.back(); }
    std::size_t segments() const { return line_.edges.size(); }
    double start_of(std::size_t segment) const { return from_[segment]; }

    std::size_t segment_at(double s) const
    {
        const auto after = std::upper_bound(from_.begin() + 1, from_.end() - 1, s);
        return static_cast<std::size_t>(after - from_.begin()) - 1;
    }
    Vec3 point_at(std::size_t segment, double s) const
    {
        const Vec3& a = mesh_.vertices[line_.vertices[segment]];
        const Vec3& b = mesh_.vertices[line_.vertices[(segment + 1) % line_.vertices.size()]];
        const double length = from_[segment + 1] - from_[segment];
        return a + ((s - from_[segment]) / length) * (b - a);
    }
    std::uint32_t edge(std::size_t segment) const { return line_.edges[segment]; }

private:
    const SurfaceMesh& mesh_;
    const FeatureLine& line_;
    std::vector<double> from_;
};

/// A particle of a line at an arc length.
struct OnLine
{
    double s;
    std::size_t segment;
    Vec3 position;
};

class Placing
{
public:
    Placing(const SurfaceMesh& mesh, const Features& features, double dp)
        : mesh_(mesh),
          features_(features),
          dp_(dp),
          grid_(dp, expected_count()),
          has_particle_(mesh.vertices.size(), 0),
          on_line_(features.lines.size())
    {
    }

    std::vector<FeatureParticle> run()
    {
        keep_corners();
        std::vector<std::uint32_t> order(features_.lines.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
        std::sort(order.begin(), order.end(),
                  [this](std::uint32_t a, std::uint32_t b)
                  {
                      const double la = features_.lines[a].length, lb = features_.lines[b].length;
                      return la != lb ? la > lb : a < b;
                  });
        for (const std::uint32_t line : order) divide(line);
        for (const std::uint32_t line : order) fill(line);
        return collect();
    }

    const FeaturesLeftOut& left_out() const { return left_out_; }

private:
    /// A stretch of a line, from and to in arc length.
    using Stretch = std::array<double, 2>;

    std::size_t expected_count() const
    {
        double count = static_cast<double>(features_.singular.size());
        for (const FeatureLine& line : features_.lines) count += line.length / dp_ + 1;
        if (!(count < 0xFFFFFFFE))
        {
            const auto longest =
                std::max_element(features_.lines.begin(), features_.lines.end(),
                                 [](const auto& a, const auto& b) { return a.length < b.length; });
            const Vec3& at = mesh_.vertices[longest->vertices.front()];
            throw GeometryError(fmt::format(
                "the feature lines need {:.3g} particles at a particle distance of {} m, expected "
                "fewer than 4e9; the longest begins at ({:.6g}, {:.6g}, {:.6g}) and is {:.6g} m "
                "long: is a coordinate wrong, or the mesh in millimetres?",
                count, dp_, at.x, at.y, at.z, longest->length));
        }
        return static_cast<std::size_t>(count);
    }

    void keep_corners()
    {
        std::vector<std::uint32_t> lines_at(mesh_.vertices.size(), 0);
        for (const std::uint32_t e : features_.edges)
            for (const std::uint32_t v : mesh_.edges[e]) ++lines_at[v];
        std::vector<std::uint32_t> order = features_.singular;
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b)
                         { return lines_at[a] > lines_at[b]; });
        for (const std::uint32_t v : order)
        {
            if (grid_.has_nearer(mesh_.vertices[v], least_pair_dp * dp_))
            {
                ++left_out_.corners;
                continue;
            }
            grid_.add(mesh_.vertices[v]);
            has_particle_[v] = 1;
        }
    }

    /// Of dp at most, but one rather than two that are too short.
    double parts_of(double length) const
    {
        // A line of exactly n dp is not cut into n + 1 parts because of rounding.
        const double parts = std::max(1.0, std::ceil(length / dp_ * (1 - 1e-12)));
        return parts == 2 && length < 2 * least_pair_dp * dp_ ? 1 : parts;
    }

    void divide(std::uint32_t index)
    {
        const FeatureLine& line = features_.lines[index];
        const LineWalk walk(mesh_, line);
        const double parts = parts_of(walk.length());
        const auto n = static_cast<std::size_t>(parts);
        std::size_t segment = 0;
        for (std::size_t i = line.is_closed ? 0 : 1; i < n; ++i)
        {
            const double s = walk.length() * static_cast<double>(i) / parts;
            while (segment + 1 < walk.segments() && walk.start_of(segment + 1) <= s) ++segment;
            const Vec3 p = walk.point_at(segment, s);
            if (grid_.has_nearer(p, least_pair_dp * dp_))
            {
                ++left_out_.edges;
                continue;
            }
            grid_.add(p);
            on_line_[index].push_back({s, segment, p});
        }
    }

    /// Adds the parts of [from, to], at most half a dp of one segment, that no particle reaches.
    void find_open(const LineWalk& walk, std::size_t segment, const Stretch& piece,
                   std::vector<Stretch>& open) const
    {
        const double reach = line_reach_dp * dp_ * (1 + 1e-6);
        const double half = 0.5 * (piece[1] - piece[0]);
        const double middle = piece[0] + half;
        const Vec3 at = walk.point_at(segment, middle);
        const Vec3 ahead = walk.point_at(segment, piece[1]) - at;
        const double ahead_length = norm(ahead);
        if (!(ahead_length > 0)) return;
        const Vec3 along = ahead / ahead_length;
        std::vector<Stretch> covered;
        grid_.for_each_near(at, reach + half,
                            [&](std::uint32_t other, double)
                            {
                                const Vec3 away = grid_.points()[other] - at;
                                const double foot = dot(away, along);
                                const Vec3 aside = away - foot * along;
                                const double room = reach * reach - dot(aside, aside);
                                if (room <= 0) return;
                                const double chord = std::sqrt(room);
                                covered.push_back({middle + foot - chord, middle + foot + chord});
                            });
        std::sort(covered.begin(), covered.end());
        double s = piece[0];
        for (const Stretch& c : covered)
        {
            if (c[0] > s) add_open({s, std::min(c[0], piece[1])}, open);
            s = std::max(s, c[1]);
            if (s >= piece[1]) return;
        }
        add_open({s, piece[1]}, open);
    }

    void add_open(const Stretch& stretch, std::vector<Stretch>& open) const
    {
        if (!(stretch[1] > stretch[0])) return;
        if (!open.empty() && stretch[0] <= open.back()[1])
            open.back()[1] = stretch[1];
        else
            open.push_back(stretch);
    }

    /// The stretches of a line that no particle reaches.
    std::vector<Stretch> open_stretches(std::uint32_t index, const LineWalk& walk) const
    {
        const FeatureLine& line = features_.lines[index];
        const std::vector<OnLine>& own = on_line_[index];
        // Between two of the line's own particles, or its kept ends, so near to one another all is
        // near.
        const double nearest = 2 * line_reach_dp * dp_ * (1 + 1e-6);
        std::vector<double> stops;
        if (!line.is_closed && has_particle_[line.vertices.front()] != 0) stops.push_back(0);
        for (const OnLine& particle : own) stops.push_back(particle.s);
        if (!line.is_closed && has_particle_[line.vertices.back()] != 0)
            stops.push_back(walk.length());
        std::vector<Stretch> doubtful;
        double s = 0;
        bool is_stop = !stops.empty() && stops.front() == 0;
        for (const double stop : stops)
        {
            if (!is_stop || stop - s > nearest) doubtful.push_back({s, stop});
            s = stop;
            is_stop = true;
        }
        const bool wraps = line.is_closed && !stops.empty() && stops.front() == 0;
        if (s < walk.length() && (!wraps || walk.length() - s > nearest))
            doubtful.push_back({s, walk.length()});

        std::vector<Stretch> open;
        for (const Stretch& stretch : doubtful)
            for (std::size_t segment = walk.segment_at(stretch[0]);
                 segment < walk.segments() && walk.start_of(segment) < stretch[1]; ++segment)
            {
                const double from = std::max(stretch[0], walk.start_of(segment));
                const double to = std::min(stretch[1], walk.start_of(segment + 1));
                const double pieces = std::max(1.0, std::ceil((to - from) / (0.5 * dp_)));
                for (double i = 0; i < pieces; ++i)
                    find_open(
                        walk, segment,
                        {from + (to - from) * i / pieces, from + (to - from) * (i + 1) / pieces},
                        open);
            }
        return open;
    }

    void fill(std::uint32_t index)
    {
        const LineWalk walk(mesh_, features_.lines[index]);
        std::vector<OnLine>& own = on_line_[index];
        // Where a line folds within dp, a particle for one stretch may take the place of that for
        // another; what is then still open is found by the next round.
        for (int round = 0; round < 8; ++round)
        {
            bool has_added = false;
            for (const Stretch& open : open_stretches(index, walk))
            {
                const double length = open[1] - open[0];
                const double parts = parts_of(length);
                for (double i = 0; i < parts; ++i)
                {
                    const double s = open[0] + length * (i + 0.5) / parts;
                    const std::size_t segment = walk.segment_at(s);
                    const Vec3 p = walk.point_at(segment, s);
                    if (grid_.has_nearer(p, least_pair_dp * dp_)) continue;
                    grid_.add(p);
                    own.push_back({s, segment, p});
                    has_added = true;
                    if (left_out_.edges > 0) --left_out_.edges;
                }
            }
            if (!has_added) return;
            std::sort(own.begin(), own.end(),
                      [](const OnLine& a, const OnLine& b) { return a.s < b.s; });
        }
    }

    std::vector<FeatureParticle> collect() const
    {
        std::vector<FeatureParticle> particles;
        particles.reserve(grid_.points().size());
        for (const std::uint32_t v : features_.singular)
            if (has_particle_[v] != 0)
                particles.push_back({mesh_.vertices[v], true, no_index, v, no_index});
        for (std::uint32_t line = 0; line < on_line_.size(); ++line)
            for (const OnLine& particle : on_line_[line])
                particles.push_back({particle.position, false, line, no_index,
                                     features_.lines[line].edges[particle.segment]});
        return particles;
    }

    const SurfaceMesh& mesh_;
    const Features& features_;
    double dp_;
    PointGrid grid_;
    std::vector<char> has_particle_; ///< per vertex: a kept corner
    std::vector<std::vector<OnLine>> on_line_;
    FeaturesLeftOut left_out_;
};

} // namespace

std::vector<FeatureParticle> place_feature_particles(const SurfaceMesh& mesh,
                                                     const Features& features,
                                                     const FeatureOptions& options,
                                                     FeaturesLeftOut* left_out)
{
    if (!(options.dp > 0) || !std::isfinite(options.dp))
        throw GeometryError(
            fmt::format("a particle distance of {} m, expected more than 0", options.dp));
    Placing placing(mesh, features, options.dp);
    std::vector<FeatureParticle> particles = placing.run();
    if (left_out != nullptr) *left_out = placing.left_out();
    return particles;
}

} // namespace fppg
