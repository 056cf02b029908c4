#include "fit/crossed_cells.h"

#include "core/parallel.h"
#include "fppg/error.h"

#include <algorithm>

namespace fppg
{

namespace
{

using Cell = std::array<std::int32_t, 3>;

/// Whether the triangle reaches the unit cube around the origin, by one axis.
bool is_apart(const Vec3& axis, const std::array<Vec3, 3>& t)
{
    const double p0 = dot(axis, t[0]);
    const double p1 = dot(axis, t[1]);
    const double p2 = dot(axis, t[2]);
    const double half = 0.5 * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
    return std::min({p0, p1, p2}) > half || std::max({p0, p1, p2}) < -half;
}

bool overlaps_unit_cube(const std::array<Vec3, 3>& t)
{
    const std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const std::array<Vec3, 3> sides{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    for (const Vec3& axis : axes)
        if (is_apart(axis, t)) return false;
    if (is_apart(cross(sides[0], sides[1]), t)) return false;
    for (const Vec3& axis : axes)
        for (const Vec3& side : sides)
            if (is_apart(cross(axis, side), t)) return false;
    return true;
}

std::int32_t first_cell(double low)
{
    return static_cast<std::int32_t>(std::ceil(low - 0.5));
}
std::int32_t last_cell(double high)
{
    return static_cast<std::int32_t>(std::floor(high + 0.5));
}

/// t  corners in units of dp from the lattice's origin
void add_cells(const std::array<Vec3, 3>& t, const Vec3& normal, std::vector<Cell>& out)
{
    int w = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(normal[axis]) > std::abs(normal[w])) w = axis;
    const int u = (w + 1) % 3;
    const int v = (w + 2) % 3;
    const auto range = [&](int axis) { return std::minmax({t[0][axis], t[1][axis], t[2][axis]}); };
    const auto [u_low, u_high] = range(u);
    const auto [v_low, v_high] = range(v);
    const auto [w_low, w_high] = range(w);
    const double u_slope = -normal[u] / normal[w];
    const double v_slope = -normal[v] / normal[w];
    // The plane's rise over half a cell, with room for rounding; the exact test follows.
    const double rise = 0.5 * (std::abs(u_slope) + std::abs(v_slope)) + 1e-6;
    for (std::int32_t i = first_cell(u_low); i <= last_cell(u_high); ++i)
        for (std::int32_t j = first_cell(v_low); j <= last_cell(v_high); ++j)
        {
            const double height = t[0][w] + u_slope * (i - t[0][u]) + v_slope * (j - t[0][v]);
            const std::int32_t from = first_cell(std::max(w_low, height - rise));
            const std::int32_t to = last_cell(std::min(w_high, height + rise));
            for (std::int32_t k = from; k <= to; ++k)
            {
                Cell cell{};
                cell[static_cast<std::size_t>(u)] = i;
                cell[static_cast<std::size_t>(v)] = j;
                cell[static_cast<std::size_t>(w)] = k;
                const Vec3 middle{static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                                  static_cast<double>(cell[2])};
                if (overlaps_unit_cube({t[0] - middle, t[1] - middle, t[2] - middle}))
                    out.push_back(cell);
            }
        }
}

void sort_unique(std::vector<Cell>& cells)
{
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

} // namespace

std::vector<Cell> find_crossed_cells(const SurfaceMesh& mesh, const Vec3& origin, double dp,
                                     int threads)
{
    for (const Vec3& vertex : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs((vertex[axis] - origin[axis]) / dp) > 1073741824.0)
                throw GeometryError(
                    "a mesh vertex is more than 2^30 dp from the lattice's origin: "
                    "enlarge dp, or check the mesh's scale");
    constexpr std::size_t block = 512;
    const std::size_t n = (mesh.facets.size() + block - 1) / block;
    std::vector<std::vector<Cell>> parts(n);
    parallel_for(n, threads,
                 [&](std::size_t part)
                 {
                     const std::size_t end = std::min(mesh.facets.size(), (part + 1) * block);
                     for (std::size_t f = part * block; f < end; ++f)
                     {
                         std::array<Vec3, 3> corners;
                         for (std::size_t k = 0; k < 3; ++k)
                             corners[k] = (mesh.vertices[mesh.facets[f][k]] - origin) / dp;
                         add_cells(corners, mesh.normals[f], parts[part]);
                     }
                     sort_unique(parts[part]);
                 });
    std::vector<Cell> cells;
    for (auto& part : parts)
    {
        cells.insert(cells.end(), part.begin(), part.end());
        part = {};
    }
    sort_unique(cells);
    return cells;
}

} // namespace fppg
