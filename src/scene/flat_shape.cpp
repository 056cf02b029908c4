#include "scene/flat_shape.h"

#include "fppg/surface_mesh.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace fppg
{
namespace
{

/// Rounding of the place of a shape, dp.
constexpr double plane_tolerance = 1e-9;
/// From the plane to where a shape drawn out ends, dp: farther than layers and fluid look.
constexpr double half_width_dp = 16;
/// Facets whose height is less than this share of their longest side have no area.
constexpr double least_height = 1e-9;

/// A place in the plane: x and z.
using Place = std::pair<double, double>;
using Side = std::pair<Place, Place>;

Place place_of(const Vec3& p)
{
    return {p.x, p.z};
}

bool is_flat(const TriangleSoup& soup, const LatticeGrid& grid)
{
    if (soup.vertices.empty()) return false;
    const auto [low, high] =
        std::minmax_element(soup.vertices.begin(), soup.vertices.end(),
                            [](const Vec3& a, const Vec3& b) { return a.y < b.y; });
    const double from_plane = (low->y - grid.origin.y) / grid.step(1);
    return high->y - low->y <= plane_tolerance * grid.dp && from_plane > -0.5 && from_plane < 0.5;
}

using Facets = std::vector<std::array<Place, 3>>;

/// The facets of a shape, those with an area counter-clockwise seen along -y.
struct FlatFacets
{
    Facets above;            ///< those that were drawn so
    Facets below;            ///< those that were drawn clockwise
    std::vector<Side> lines; ///< the longest sides of facets without an area; each once
};

FlatFacets facets_of(const TriangleSoup& soup)
{
    FlatFacets out;
    std::set<Side> known;
    for (std::size_t i = 0; i + 2 < soup.vertices.size(); i += 3)
    {
        const std::array<Vec3, 3> t{soup.vertices[i], soup.vertices[i + 1], soup.vertices[i + 2]};
        const std::array<Place, 3> p{place_of(t[0]), place_of(t[1]), place_of(t[2])};
        const double turn = cross(t[1] - t[0], t[2] - t[0]).y;
        std::size_t longest = 0;
        const auto length = [&](std::size_t k) { return norm(t[(k + 1) % 3] - t[k]); };
        for (std::size_t k = 1; k < 3; ++k)
            if (length(k) > length(longest)) longest = k;
        const Place& a = p[longest];
        const Place& b = p[(longest + 1) % 3];
        if (std::abs(turn) > least_height * length(longest) * length(longest))
            turn > 0 ? out.above.push_back(p) : out.below.push_back({p[0], p[2], p[1]});
        else if (a != b && known.insert(std::minmax(a, b)).second)
            out.lines.emplace_back(a, b);
    }
    return out;
}

/// Sides of facets that have no other one beside them.
std::set<Side> outline_of(const Facets& facets)
{
    std::set<Side> all;
    for (const auto& t : facets)
        for (std::size_t k = 0; k < 3; ++k) all.emplace(t[k], t[(k + 1) % 3]);
    std::set<Side> out;
    for (const auto& [a, b] : all)
        if (all.count({b, a}) == 0) out.emplace(a, b);
    return out;
}

/// The front and the back of a body without a width cover the same.
Facets areas_of(FlatFacets& facets)
{
    if (outline_of(facets.above) != outline_of(facets.below))
        facets.above.insert(facets.above.end(), facets.below.begin(), facets.below.end());
    return std::move(facets.above);
}

class DrawnOut
{
public:
    explicit DrawnOut(const LatticeGrid& grid)
        : low_(grid.origin.y - half_width_dp * grid.dp),
          high_(grid.origin.y + half_width_dp * grid.dp)
    {
    }

    /// Looks to the right of a to b, seen along -y with x to the right and z down.
    void add_side(const Place& a, const Place& b)
    {
        add({at(a, low_), at(b, low_), at(b, high_)});
        add({at(a, low_), at(b, high_), at(a, high_)});
    }

    void add_covers(const std::array<Place, 3>& t)
    {
        add({at(t[0], high_), at(t[1], high_), at(t[2], high_)});
        add({at(t[0], low_), at(t[2], low_), at(t[1], low_)});
    }

    TriangleSoup soup{};

private:
    static Vec3 at(const Place& p, double y) { return {p.first, y, p.second}; }
    void add(const std::array<Vec3, 3>& t)
    {
        soup.vertices.insert(soup.vertices.end(), t.begin(), t.end());
    }

    double low_ = 0;
    double high_ = 0;
};

TriangleSoup solid_over(const Facets& areas, const LatticeGrid& grid)
{
    DrawnOut out(grid);
    for (const auto& t : areas) out.add_covers(t);
    for (const auto& [a, b] : outline_of(areas)) out.add_side(a, b);
    return std::move(out.soup);
}

TriangleSoup sheets_over(const std::vector<Side>& lines, const TriangleSoup& drawn,
                         const LatticeGrid& grid)
{
    Box3 bounds;
    for (const Vec3& v : drawn.vertices) bounds.add(v);
    const Vec3 middle = 0.5 * (bounds.min + bounds.max);
    DrawnOut out(grid);
    for (const auto& [a, b] : lines)
    {
        // (b - a) x y is where the sheet looks.
        const double outwards = (b.first - a.first) * (a.second - middle.z) -
                                (b.second - a.second) * (a.first - middle.x);
        if (outwards < 0)
            out.add_side(b, a);
        else
            out.add_side(a, b);
    }
    return std::move(out.soup);
}

} // namespace

void give_section(std::vector<ShapeMesh>& shapes, const LatticeGrid& grid)
{
    if (!grid.is_2d) return;
    for (ShapeMesh& shape : shapes)
    {
        if (!is_flat(shape.soup, grid)) continue;
        FlatFacets facets = facets_of(shape.soup);
        const Facets areas = areas_of(facets);
        shape.is_solid = !areas.empty();
        shape.soup =
            shape.is_solid ? solid_over(areas, grid) : sheets_over(facets.lines, shape.soup, grid);
    }
}

} // namespace fppg
