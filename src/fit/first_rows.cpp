#include "fit/first_rows.h"

#include "core/parallel.h"

#include <algorithm>

namespace fppg
{

namespace
{

// Lengths in dp.
constexpr double row_distance = 0.93;
/// Along a row: a triangular lattice of one particle per dp^2 has rows 0.93 dp apart and particles
/// 1.075 dp apart in them. With the dp of the line's own particles, the front that goes on from the
/// row holds 7 % too many.
constexpr double row_spacing = 1.075;
/// Beside shorter lines the places between the line's own particles are better.
constexpr double shortest_row = 6;

/// The edges of one line in order, with the length of the line up to each.
struct Course
{
    std::vector<std::uint32_t> edges;
    std::vector<std::uint32_t> starts; ///< first vertex of each edge along the line
    std::vector<double> lengths;       ///< up to the start of each edge, and in all
};

std::uint32_t edge_between(const SurfaceMesh& mesh, std::uint32_t a, std::uint32_t b)
{
    const std::array<std::uint32_t, 2> wanted{std::min(a, b), std::max(a, b)};
    const auto at = std::lower_bound(mesh.edges.begin(), mesh.edges.end(), wanted);
    return static_cast<std::uint32_t>(at - mesh.edges.begin());
}

Course course_of(const SurfaceMesh& mesh, const FeatureLine& line)
{
    Course course;
    course.lengths.push_back(0);
    const std::size_t n = line.vertices.size();
    for (std::size_t i = 0; i + (line.is_closed ? 0 : 1) < n; ++i)
    {
        const std::uint32_t a = line.vertices[i];
        const std::uint32_t b = line.vertices[i + 1 == n ? 0 : i + 1];
        course.edges.push_back(edge_between(mesh, a, b));
        course.starts.push_back(a);
        course.lengths.push_back(course.lengths.back() + norm(mesh.vertices[b] - mesh.vertices[a]));
    }
    return course;
}

class RowLayer
{
public:
    RowLayer(const SurfaceMesh& mesh, const WorkMesh& work, double dp)
        : mesh_(mesh), work_(work), dp_(dp)
    {
    }

    /// places  lengths along the course of the particles on it, ascending
    void lay(const Course& course, const std::vector<double>& places, bool is_closed)
    {
        if (course.lengths.back() > shortest_row * dp_) return lay_evenly(course, is_closed);
        for (std::size_t i = 0; i + 1 < places.size(); ++i)
            lay_beside(course, 0.5 * (places[i] + places[i + 1]));
        if (!is_closed || places.empty()) return;
        const double whole = course.lengths.back();
        const double middle = 0.5 * (places.back() + places.front() + whole);
        lay_beside(course, middle < whole ? middle : middle - whole);
    }

    /// The first places of rows beside what was laid.
    std::vector<SurfaceRay> walk_away(int threads) const
    {
        std::vector<SurfaceRay> rows(starts_.size());
        parallel_for(
            rows.size(), threads, [&](std::size_t i) { rows[i] = first_place(starts_[i]); }, 64);
        std::erase_if(rows, [](const SurfaceRay& row) { return row.facet == no_index; });
        return rows;
    }

private:
    struct Start
    {
        std::uint32_t facet;
        std::uint32_t edge;
        Vec3 point;
    };

    /// A row of an open line ends one row away from the lines across its ends.
    void lay_evenly(const Course& course, bool is_closed)
    {
        const double away = is_closed ? 0 : row_distance * dp_;
        const double length = course.lengths.back() - 2 * away;
        // A gap rather too narrow than too wide: one too wide makes holes all along the front.
        const int gaps = static_cast<int>(length / (row_spacing * dp_) + 0.6);
        for (int i = 0; i < gaps + (is_closed ? 0 : 1); ++i)
            lay_beside(course, away + length * i / gaps);
    }

    void lay_beside(const Course& course, double length)
    {
        const auto after =
            std::upper_bound(course.lengths.begin(), course.lengths.end() - 1, length);
        const auto i = static_cast<std::size_t>(
            std::max<std::ptrdiff_t>(0, after - course.lengths.begin() - 1));
        const std::uint32_t edge = course.edges[i];
        const Vec3& a = mesh_.vertices[course.starts[i]];
        const auto& ends = mesh_.edges[edge];
        const Vec3& b = mesh_.vertices[ends[0] == course.starts[i] ? ends[1] : ends[0]];
        const double whole = course.lengths[i + 1] - course.lengths[i];
        const double t = whole > 0 ? (length - course.lengths[i]) / whole : 0.0;
        const Vec3 point = a + (b - a) * t;
        for (const std::uint32_t facet : mesh_.edge_facets[edge])
            if (facet != no_index) starts_.push_back({facet, edge, point});
    }

    SurfaceRay first_place(const Start& start) const
    {
        const auto [facet, edge, point] = start;
        std::size_t s = 0;
        while (s < 2 && mesh_.facet_edges[facet][s] != edge) ++s;
        const Vec3 side = mesh_.vertices[mesh_.facets[facet][(s + 1) % 3]] -
                          mesh_.vertices[mesh_.facets[facet][s]];
        const Vec3 along = side / norm(side);
        SurfaceRay ray{point, work_.locate(facet, point), cross(mesh_.normals[facet], along)};
        ray = walk(work_, ray, row_distance * dp_);
        // The front goes on along the row and at sixty degrees to it.
        if (ray.facet != no_index)
            ray.direction = cross(ray.direction, work_.facets[ray.facet].normal);
        return ray;
    }

    const SurfaceMesh& mesh_;
    const WorkMesh& work_;
    double dp_;
    std::vector<Start> starts_;
};

} // namespace

std::vector<SurfaceRay> lay_first_rows(const SurfaceMesh& mesh, const WorkMesh& work,
                                       const Features& features,
                                       const std::vector<FeatureParticle>& particles, double dp,
                                       int threads)
{
    std::vector<char> has_corner(mesh.vertices.size(), 0);
    std::vector<std::vector<std::uint32_t>> on_line(features.lines.size());
    for (std::uint32_t p = 0; p < particles.size(); ++p)
    {
        if (particles[p].vertex != no_index)
            has_corner[particles[p].vertex] = 1;
        else if (particles[p].line != no_index)
            on_line[particles[p].line].push_back(p);
    }
    RowLayer layer(mesh, work, dp);
    std::vector<std::uint32_t> slot(mesh.edges.size(), no_index);
    std::vector<double> places;
    for (std::size_t l = 0; l < features.lines.size(); ++l)
    {
        const FeatureLine& line = features.lines[l];
        const Course course = course_of(mesh, line);
        if (course.edges.empty()) continue;
        places.clear();
        for (std::size_t i = 0; i < course.edges.size(); ++i)
        {
            slot[course.edges[i]] = static_cast<std::uint32_t>(i);
            if (has_corner[course.starts[i]]) places.push_back(course.lengths[i]);
        }
        if (!line.is_closed && has_corner[line.vertices.back()])
            places.push_back(course.lengths.back());
        for (const std::uint32_t p : on_line[l])
        {
            const std::uint32_t i = slot[particles[p].edge];
            const Vec3& start = mesh.vertices[course.starts[i]];
            places.push_back(course.lengths[i] + norm(particles[p].position - start));
        }
        std::sort(places.begin(), places.end());
        layer.lay(course, places, line.is_closed);
    }
    return layer.walk_away(threads);
}

} // namespace fppg
