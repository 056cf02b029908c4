#include "meshes/mesh_builder.h"

#include "fppg/error.h"

#include "core/text.h"
#include "meshes/facet_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace fppg
{
namespace
{

Vec3 area_vector(std::span<const Vec3> corners)
{
    Vec3 area;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area = area + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return area;
}

class EarCutter
{
public:
    explicit EarCutter(std::span<const Vec3> corners)
        : corners_(corners), rest_(corners.size()), area_(area_vector(corners))
    {
        std::iota(rest_.begin(), rest_.end(), std::size_t{0});
        Box3 box;
        for (const Vec3& c : corners) box.add(c);
        const double size = norm(box.max - box.min);
        // What rounding to float32 and the products themselves may change.
        slack_ = 1e-7 * size * size * norm(area_);
        is_line_ = norm(area_) <= 1e-7 * size * size;
        for (std::size_t i = 0; i < corners.size(); ++i)
            for (std::size_t j = i + 1; j < corners.size(); ++j)
                has_copies_ = has_copies_ || corners[i] == corners[j];
    }

    std::vector<std::array<std::size_t, 3>> run()
    {
        std::vector<std::array<std::size_t, 3>> triangles;
        triangles.reserve(rest_.size() - 2);
        while (rest_.size() > 3)
        {
            const std::size_t k = next_corner();
            if (k == rest_.size()) return triangles;
            triangles.push_back({before(k), rest_[k], after(k)});
            rest_.erase(rest_.begin() + static_cast<std::ptrdiff_t>(k));
        }
        if (!has_copies_ || is_ear_among_copies(0))
            triangles.push_back({rest_[0], rest_[1], rest_[2]});
        return triangles;
    }

private:
    std::size_t before(std::size_t k) const { return rest_[(k + rest_.size() - 1) % rest_.size()]; }
    std::size_t after(std::size_t k) const { return rest_[(k + 1) % rest_.size()]; }

    /// Twice the signed area of a triangle seen against the polygon's normal, times its length.
    double side(const Vec3& a, const Vec3& b, const Vec3& p) const
    {
        return dot(cross(b - a, p - a), area_);
    }

    bool is_ear(std::size_t k) const
    {
        const Vec3& a = corners_[before(k)];
        const Vec3& b = corners_[rest_[k]];
        const Vec3& c = corners_[after(k)];
        if (side(a, b, c) <= slack_) return false;
        return std::none_of(rest_.begin(), rest_.end(),
                            [&](std::size_t i)
                            {
                                const Vec3& p = corners_[i];
                                return !(p == a || p == b || p == c) && side(a, b, p) >= -slack_ &&
                                       side(b, c, p) >= -slack_ && side(c, a, p) >= -slack_;
                            });
    }

    /// Where corners coincide an ear has three places, none of which another corner shares.
    bool is_ear_among_copies(std::size_t k) const
    {
        const Vec3& a = corners_[before(k)];
        const Vec3& b = corners_[rest_[k]];
        const Vec3& c = corners_[after(k)];
        if (a == b || b == c || a == c) return false;
        if (!is_line_ && side(a, b, c) <= slack_) return false;
        Box3 box;
        for (const Vec3& p : {a, b, c}) box.add(p);
        const auto is_in_box = [&](const Vec3& p)
        {
            for (int axis = 0; axis < 3; ++axis)
                if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) return false;
            return true;
        };
        for (const std::size_t i : rest_)
        {
            const Vec3& p = corners_[i];
            if (i == before(k) || i == rest_[k] || i == after(k)) continue;
            if (is_line_ ? is_in_box(p)
                         : side(a, b, p) >= -slack_ && side(b, c, p) >= -slack_ &&
                               side(c, a, p) >= -slack_)
                return false;
        }
        return true;
    }

    /// The corner to cut off; where no corner is an ear, the one of least perimeter, or none if
    /// corners coincide.
    std::size_t next_corner() const
    {
        for (const bool only_ears : {true, false})
        {
            if (!only_ears && has_copies_) return rest_.size();
            std::size_t best = rest_.size();
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < rest_.size(); ++k)
            {
                const Vec3& a = corners_[before(k)];
                const Vec3& b = corners_[rest_[k]];
                const Vec3& c = corners_[after(k)];
                const double perimeter = norm(a - b) + norm(b - c) + norm(a - c);
                if (perimeter < least &&
                    (!only_ears || (has_copies_ ? is_ear_among_copies(k) : is_ear(k))))
                {
                    least = perimeter;
                    best = k;
                }
            }
            if (best < rest_.size()) return best;
        }
        return 0;
    }

    std::span<const Vec3> corners_;
    std::vector<std::size_t> rest_;
    Vec3 area_;
    double slack_ = 0;
    bool is_line_ = false;
    bool has_copies_ = false; ///< two corners in one place
};

class MeshBuilder
{
public:
    MeshBuilder(IndexedMesh mesh, const ShapeSelection& selection, const std::string& path)
        : mesh_(std::move(mesh)), selection_(selection), path_(path)
    {
        is_point_finite_.resize(mesh_.points.size());
        for (std::size_t i = 0; i < mesh_.points.size(); ++i)
            is_point_finite_[i] = is_finite(mesh_.points[i]);
    }

    MeshFile run(int threads)
    {
        check("vertex", mesh_.vertices);
        check("line", mesh_.lines);
        check("polygon", mesh_.polygons);
        check("triangle strip", mesh_.strips);
        if (mesh_.vertices.size() + mesh_.lines.size() + mesh_.polygons.size() +
                mesh_.strips.size() ==
            0)
            throw GeometryError(fmt::format(
                "{}: has no shape to draw: {} points, but no vertices, lines or polygons", path_,
                mesh_.points.size()));
        out_.warnings = std::move(mesh_.warnings);
        add_points();
        add_lines();
        add_polygons();
        add_strips();
        warn();
        if (out_.soup.size() > 0) check_facets(out_, path_, mesh_.has_float32, threads);
        return std::move(out_);
    }

private:
    void check(const char* kind, const CellLists& cells) const
    {
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (const std::uint64_t p : cells[i])
                if (p >= mesh_.points.size())
                    throw GeometryError(fmt::format(
                        "{}: {} {} of {} names point {}, expected a number from 0 to {}", path_,
                        kind, i, cells.size(), static_cast<std::int64_t>(p),
                        static_cast<std::int64_t>(mesh_.points.size()) - 1));
    }

    /// Whether the cell can be drawn; counts it if it cannot.
    bool is_usable(std::span<const std::uint64_t> cell, std::size_t at_least)
    {
        if (cell.size() < at_least)
        {
            ++too_short_;
            return false;
        }
        const bool is_good = std::all_of(cell.begin(), cell.end(),
                                         [this](std::uint64_t p) { return is_point_finite_[p]; });
        not_finite_ += is_good ? 0 : 1;
        return is_good;
    }

    void add_points()
    {
        if (!selection_.points) return;
        for (std::size_t i = 0; i < mesh_.vertices.size(); ++i)
            if (const auto cell = mesh_.vertices[i]; is_usable(cell, 1))
                for (const std::uint64_t p : cell) out_.points.push_back(mesh_.points[p]);
    }

    void add_lines()
    {
        if (!selection_.lines) return;
        for (std::size_t i = 0; i < mesh_.lines.size(); ++i)
            if (const auto cell = mesh_.lines[i]; is_usable(cell, 2))
            {
                std::vector<Vec3>& line = out_.lines.emplace_back();
                for (const std::uint64_t p : cell) line.push_back(mesh_.points[p]);
            }
    }

    void add_triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c)
    {
        for (const std::uint64_t p : {a, b, c}) out_.soup.vertices.push_back(mesh_.points[p]);
    }

    void add_polygons()
    {
        const bool takes_others =
            selection_.other_polygons && selection_.triangles && selection_.quads;
        std::vector<Vec3> corners;
        for (std::size_t i = 0; i < mesh_.polygons.size(); ++i)
        {
            const auto cell = mesh_.polygons[i];
            if (cell.size() == 3 && !selection_.triangles) continue;
            if (cell.size() == 4 && !selection_.quads) continue;
            if (cell.size() > 4 && !takes_others)
            {
                others_left_out_ += selection_.other_polygons ? 1 : 0;
                continue;
            }
            if (!is_usable(cell, 3)) continue;
            if (cell.size() == 4)
                out_.quads.push_back(static_cast<std::uint32_t>(out_.soup.size()));
            if (cell.size() <= 4)
            {
                for (std::size_t k = 2; k < cell.size(); ++k)
                    add_triangle(cell[0], cell[k - 1], cell[k]);
                continue;
            }
            corners.clear();
            for (const std::uint64_t p : cell) corners.push_back(mesh_.points[p]);
            out_.wide_polygons.push_back({static_cast<std::uint32_t>(out_.soup.size()), corners});
            for (const auto& [a, b, c] : cut_into_ears(corners))
                add_triangle(cell[a], cell[b], cell[c]);
        }
    }

    void add_strips()
    {
        if (!selection_.triangles) return;
        for (std::size_t i = 0; i < mesh_.strips.size(); ++i)
            if (const auto cell = mesh_.strips[i]; is_usable(cell, 3))
                for (std::size_t k = 2; k < cell.size(); ++k)
                {
                    const std::size_t turned = k % 2;
                    add_triangle(cell[k - 2], cell[k - 1 + turned], cell[k - turned]);
                }
    }

    void warn()
    {
        const auto say = [this](std::size_t count, const char* what)
        {
            if (count > 0)
                out_.warnings.push_back(
                    fmt::format("{} {}.", counted(count, "shape", "shapes"), what));
        };
        say(too_short_, "of too few points left out");
        say(not_finite_, "with a coordinate that is not finite left out");
        if (others_left_out_ > 0)
            out_.warnings.push_back(
                fmt::format("{} of more than four corners left out, as GenCase does unless "
                            "triangles, quads and "
                            "otherpolys are all named; polyselec \"polygons\" takes them.",
                            counted(others_left_out_, "polygon", "polygons")));
    }

    IndexedMesh mesh_;
    ShapeSelection selection_;
    const std::string& path_;
    std::vector<char> is_point_finite_;
    MeshFile out_;
    std::size_t too_short_ = 0;
    std::size_t not_finite_ = 0;
    std::size_t others_left_out_ = 0;
};

} // namespace

std::vector<std::array<std::size_t, 3>> cut_into_ears(std::span<const Vec3> corners)
{
    return EarCutter(corners).run();
}

MeshFile build_mesh(IndexedMesh mesh, const ShapeSelection& selection, const std::string& path,
                    int threads)
{
    return MeshBuilder(std::move(mesh), selection, path).run(threads);
}

} // namespace fppg
