#include "shapes/shape.h"

#include "meshes/open_edges.h"
#include "nodes/snap.h"
#include "shapes/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fppg
{

Vec3 ShapeContext::place(const Vec3& p) const
{
    return snapped ? position(snap(p, grid), grid) : p;
}

double ShapeContext::rounded(double radius) const
{
    return snapped ? std::floor(radius / grid.dp + 0.5) * grid.dp : radius;
}

bool has_surface(const Shape& shape)
{
    return std::visit(
        [](const auto& kind)
        {
            return requires(const ShapeContext& c)
            {
                kinds::surfaces_of(kind, c);
            };
        },
        shape);
}

bool has_cells(const Shape& shape)
{
    return std::visit(
        [](const auto& kind)
        {
            return requires(kinds::CellList & out)
            {
                kinds::add_cells(kind, out);
            };
        },
        shape);
}

Box3 bounds_of(const Shape& shape, double dp)
{
    return std::visit([&](const auto& kind) { return kinds::bounds_of(kind, dp); }, shape);
}

bool is_body(const Shape& shape, DrawMode mode)
{
    return std::visit(
        [&](const auto& kind)
        {
            if constexpr (requires { kinds::is_body(kind, mode); })
                return kinds::is_body(kind, mode);
            else
                return false;
        },
        shape);
}

std::vector<ShapeMesh> surfaces_of(const Shape& shape, const ShapeContext& context)
{
    return std::visit(
        [&](const auto& kind) -> std::vector<ShapeMesh>
        {
            if constexpr (requires { kinds::surfaces_of(kind, context); })
                return kinds::surfaces_of(kind, context);
            else
                return {};
        },
        shape);
}

std::vector<ShapeCell> cells_of(const Shape& shape, const ShapeContext& context)
{
    kinds::CellList out{context};
    std::visit(
        [&](const auto& kind)
        {
            if constexpr (requires { kinds::add_cells(kind, out); }) kinds::add_cells(kind, out);
        },
        shape);
    return std::move(out.cells);
}

std::optional<ExactBody> body_of(const Shape& shape, const ShapeContext& context,
                                 std::string& why_not)
{
    return std::visit(
        [&](const auto& kind) -> std::optional<ExactBody>
        {
            if constexpr (requires { kinds::body_of(kind, context, why_not); })
                return kinds::body_of(kind, context, why_not);
            else
            {
                why_not = "it is drawn by points or lines";
                return std::nullopt;
            }
        },
        shape);
}

namespace kinds
{

void CellList::add_face(ShapeCell corners)
{
    if (context.state.normal_invert) std::reverse(corners.begin(), corners.end());
    cells.push_back(std::move(corners));
}

void CellList::add_round_face(ShapeCell corners)
{
    if (context.state.normal_invert) std::reverse(corners.begin() + 1, corners.end());
    cells.push_back(std::move(corners));
}

void CellList::add_flat_face(ShapeCell corners)
{
    if (context.is_wire())
        for (std::size_t i = 0; i < corners.size(); ++i)
            add_line(corners[i], corners[(i + 1) % corners.size()]);
    else if (!context.snapped || corners.size() > 3)
        add_face(std::move(corners));
    else if (corners[0] == corners[1] && corners[1] == corners[2])
        return;
    else if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
        add_line(corners[0], corners[0] == corners[1] ? corners[2] : corners[1]);
    else
        add_face(std::move(corners));
}

void flip(TriangleSoup& soup)
{
    for (std::size_t i = 0; i < soup.size(); ++i)
        std::swap(soup.vertices[3 * i + 1], soup.vertices[3 * i + 2]);
}

std::optional<ExactBody> body_of_closed(const TriangleSoup& soup, std::string& why_not)
{
    const std::uint64_t open = open_edge_count(soup);
    if (soup.size() == 0 || open > 0)
    {
        why_not = soup.size() == 0 ? "it is drawn by points or lines"
                                   : fmt::format("its surface has {} open edges", open);
        return std::nullopt;
    }
    const ExactBody body = body_of_facets(soup);
    if (body.volume > 0) return body;
    why_not = "its surface encloses nothing";
    return std::nullopt;
}

void add_ball(Box3& box, const Vec3& center, const Vec3& half)
{
    box.add(center - half);
    box.add(center + half);
}

} // namespace kinds
} // namespace fppg
