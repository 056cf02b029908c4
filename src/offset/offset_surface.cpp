#include "offset/offset_surface.h"

#include "core/parallel.h"
#include "meshes/connect_mesh.h"
#include "meshes/measure_facets.h"
#include "offset/creases.h"
#include "offset/dual_cells.h"
#include "offset/flat_patches.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{
namespace
{

/// A layer of a sheet ends so near to where the sheet ends, in cells.
constexpr double rim_reach = 2.5;

/// Joins the vertices of neighbouring cells to facets.
class FacetMaker
{
public:
    FacetMaker(const std::vector<DepthBrick>& bricks, const std::vector<DualBrick>& duals)
        : bricks_(bricks), duals_(duals)
    {
        for (std::size_t b = 0; b < bricks.size(); ++b)
        {
            first_.push_back(vertices_);
            vertices_ += duals[b].vertices.size();
        }
    }

    std::size_t vertices() const { return vertices_; }

    std::vector<std::array<std::uint32_t, 3>> facets_of(std::size_t b) const
    {
        std::vector<std::array<std::uint32_t, 3>> out;
        for (int i = 0; i < brick_cells; ++i)
            for (int j = 0; j < brick_cells; ++j)
                for (int k = 0; k < brick_cells; ++k)
                    for (int axis = 0; axis < 3; ++axis) add_quad(b, {i, j, k}, axis, out);
        return out;
    }

private:
    struct Corner
    {
        std::uint32_t vertex = no_index;
        const DualVertex* dual = nullptr;
    };

    /// The vertex of the sheet that crosses an edge, of one of the four cells around that.
    Corner corner_at(std::size_t b, std::array<int, 3> cell, int edge) const
    {
        std::array<std::int64_t, 3> first = bricks_[b].first;
        bool is_here = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (cell[axis] >= 0) continue;
            first[axis] -= brick_cells;
            cell[axis] += brick_cells;
            is_here = false;
        }
        if (!is_here)
        {
            const auto found = brick_at(first);
            if (found == bricks_.size()) return {};
            b = found;
        }
        const DualBrick& dual = duals_[b];
        const int number = (cell[0] * brick_cells + cell[1]) * brick_cells + cell[2];
        const std::int16_t at = dual.index[static_cast<std::size_t>(number)];
        if (at < 0) return {};
        const DualCell& of_cell = dual.cells[static_cast<std::size_t>(at)];
        const std::int8_t sheet = of_cell.vertex[static_cast<std::size_t>(edge)];
        if (sheet < 0) return {};
        const std::size_t vertex = of_cell.first + static_cast<std::uint8_t>(sheet);
        return {static_cast<std::uint32_t>(first_[b] + vertex), &dual.vertices[vertex]};
    }

    std::size_t brick_at(const std::array<std::int64_t, 3>& first) const
    {
        const auto found = std::lower_bound(bricks_.begin(), bricks_.end(), first,
                                            [](const DepthBrick& brick, const auto& value)
                                            { return brick.first < value; });
        return found != bricks_.end() && found->first == first
                   ? static_cast<std::size_t>(found - bricks_.begin())
                   : bricks_.size();
    }

    void add_quad(std::size_t b, const std::array<int, 3>& at, int axis,
                  std::vector<std::array<std::uint32_t, 3>>& out) const
    {
        std::array<int, 3> end = at;
        ++end[static_cast<std::size_t>(axis)];
        const NodeSide low = duals_[b].side(at);
        const NodeSide high = duals_[b].side(end);
        if (low == NodeSide::Unknown || high == NodeSide::Unknown || low == high) return;
        constexpr std::array<std::array<int, 2>, 4> round{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        std::array<Corner, 4> corners;
        for (std::size_t c = 0; c < 4; ++c)
        {
            std::array<int, 3> cell = at;
            cell[static_cast<std::size_t>((axis + 1) % 3)] -= round[c][0];
            cell[static_cast<std::size_t>((axis + 2) % 3)] -= round[c][1];
            corners[c] = corner_at(b, cell, 4 * axis + 2 * round[c][0] + round[c][1]);
            if (corners[c].dual == nullptr) return;
        }
        if (low != NodeSide::Deep) std::swap(corners[1], corners[3]);
        split(corners, out);
    }

    /// Along the crease where the quad has one, else so that its halves turn least.
    static void split(const std::array<Corner, 4>& q,
                      std::vector<std::array<std::uint32_t, 3>>& out)
    {
        const auto crease = [&](std::size_t c) { return q[c].dual->is_on_crease; };
        bool by_first = false;
        const bool is_first = crease(0) && crease(2);
        const bool is_second = crease(1) && crease(3);
        if (is_first != is_second)
            by_first = is_first;
        else
            by_first = turn(q, 0) >= turn(q, 1);
        const std::size_t a = by_first ? 0 : 1;
        const auto id = [&](std::size_t c) { return q[(a + c) % 4].vertex; };
        out.push_back({id(0), id(1), id(2)});
        out.push_back({id(0), id(2), id(3)});
    }

    /// The cosine of the turn between the halves of a quad that is cut from corner a on.
    static double turn(const std::array<Corner, 4>& q, std::size_t a)
    {
        const auto at = [&](std::size_t c) { return q[(a + c) % 4].dual->position; };
        const Vec3 diagonal = at(2) - at(0);
        const Vec3 one = cross(at(1) - at(0), diagonal);
        const Vec3 two = cross(diagonal, at(3) - at(0));
        const double size = norm(one) * norm(two);
        return size > 0 ? dot(one, two) / size : -1;
    }

    const std::vector<DepthBrick>& bricks_;
    const std::vector<DualBrick>& duals_;
    std::vector<std::size_t> first_; ///< vertex of each brick
    std::size_t vertices_ = 0;
};

/// The rims of a sheet's layer, which end in the last whole cells, go to where the sheet ends.
///
/// returns  whether the sheet has any
bool move_to_rims(const WallDepth& wall, const OffsetOptions& options, int threads,
                  SurfaceMesh& mesh)
{
    const SurfaceMesh& sheet = wall.mesh();
    TriangleSoup rims;
    for (std::size_t e = 0; e < sheet.edges.size(); ++e)
    {
        if (sheet.edge_facets[e][1] != no_index) continue;
        const Vec3& end = sheet.vertices[sheet.edges[e][1]];
        rims.vertices.insert(rims.vertices.end(), {sheet.vertices[sheet.edges[e][0]], end, end});
    }
    if (rims.vertices.empty()) return false;
    const MeshQuery query(std::move(rims), threads);
    std::vector<char> is_at_rim(mesh.vertices.size(), 0);
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        if (mesh.edge_facets[e][1] == no_index)
            for (const std::uint32_t v : mesh.edges[e]) is_at_rim[v] = 1;
    const double reach = rim_reach * options.cell;
    parallel_for(
        mesh.vertices.size(), threads,
        [&](std::size_t v)
        {
            if (is_at_rim[v] == 0) return;
            const Vec3 nearest = wall.at(mesh.vertices[v]).nearest;
            const ClosestPoint rim = query.closest_point(nearest);
            if (rim.distance < reach) mesh.vertices[v] = mesh.vertices[v] + (rim.point - nearest);
        },
        64);
    return true;
}

} // namespace

OffsetSurface offset_surface(const WallDepth& wall, const OffsetOptions& options, int threads)
{
    const DepthGrid grid = depth_grid(wall, options);
    std::vector<DepthBrick> bricks = find_bricks(wall, grid, options, threads);
    std::sort(bricks.begin(), bricks.end(),
              [](const DepthBrick& a, const DepthBrick& b) { return a.first < b.first; });
    std::vector<DualBrick> duals(bricks.size());
    parallel_for(bricks.size(), threads,
                 [&](std::size_t b)
                 {
                     fill_brick(wall, grid, options.depth, bricks[b]);
                     duals[b] = make_dual_brick({wall, grid}, bricks[b], options.depth);
                     bricks[b].nodes = {};
                 });
    const FacetMaker maker(bricks, duals);
    PatchedMesh patched;
    patched.patches.resize(bricks.size());
    parallel_for(bricks.size(), threads,
                 [&](std::size_t b) { patched.patches[b] = maker.facets_of(b); });
    patched.vertices.reserve(maker.vertices());
    for (const DualBrick& dual : duals)
        for (const DualVertex& v : dual.vertices) patched.vertices.push_back(v.position);
    if (!options.plane_y && !options.keeps_facets)
        merge_flat_facets(options.cell, threads, patched);
    OffsetSurface out;
    SurfaceMesh& mesh = out.mesh;
    mesh.vertices = std::move(patched.vertices);
    for (const auto& of_brick : patched.patches)
        mesh.facets.insert(mesh.facets.end(), of_brick.begin(), of_brick.end());
    const std::size_t cut = mesh.facets.size();
    if (cut == 0) return out;
    const double own_above = high_where_exact * options.cell;
    connect_facets(mesh, own_above, threads);
    if (move_to_rims(wall, options, threads, mesh)) connect_facets(mesh, own_above, threads);
    sharpen_creases(wall, options, threads, out);
    finish_mesh(mesh, own_above, threads, out.report);
    out.report.facets_read = cut;
    return out;
}

} // namespace fppg
