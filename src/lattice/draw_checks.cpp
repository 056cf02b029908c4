#include "lattice/draw_checks.h"

#include "nodes/snap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace fppg
{
namespace
{

void add_ball(Box3& box, const Vec3& center, const Vec3& half)
{
    box.add(center - half);
    box.add(center + half);
}

/// The largest or smallest extent over the axes that count.
struct Extents
{
    double largest = 0;
    double smallest = std::numeric_limits<double>::infinity();
};

template <typename IsFlat>
Extents extents_of(const Vec3& low, const Vec3& high, const IsFlat& is_flat)
{
    Extents out;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (is_flat(axis)) continue;
        out.largest = std::max(out.largest, high[axis] - low[axis]);
        out.smallest = std::min(out.smallest, high[axis] - low[axis]);
    }
    return out;
}

bool is_body(const DrawOp& op)
{
    if (const auto* figure = shape_as<FigureOp>(op))
        return figure->solid != SolidKind::None && op.state->mode != DrawMode::Face;
    if (const auto* sphere = shape_as<SphereOp>(op)) return sphere->layers_dp.empty();
    if (const auto* cylinder = shape_as<CylinderOp>(op)) return cylinder->layers.empty();
    return shape_as<EllipsoidOp>(op) != nullptr || shape_as<MeshFileOp>(op) != nullptr;
}

} // namespace

std::uint64_t open_edge_count(const TriangleSoup& soup)
{
    Box3 box;
    for (const Vec3& v : soup.vertices) box.add(v);
    if (box.is_empty()) return 0;
    const Vec3 size = box.max - box.min;
    const double step = std::max({size.x, size.y, size.z, 1e-300}) * 1e-6;
    using Place = std::array<std::int64_t, 3>;
    std::vector<std::pair<Place, std::uint32_t>> places;
    places.reserve(soup.vertices.size());
    for (std::uint32_t i = 0; i < soup.vertices.size(); ++i)
    {
        Place p{};
        for (int axis = 0; axis < 3; ++axis)
            p[static_cast<std::size_t>(axis)] =
                std::llround((soup.vertices[i][axis] - box.min[axis]) / step);
        places.emplace_back(p, i);
    }
    std::sort(places.begin(), places.end());
    std::vector<std::uint32_t> corner(soup.vertices.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        corner[places[i].second] = i > 0 && places[i].first == places[i - 1].first
                                       ? corner[places[i - 1].second]
                                       : places[i].second;
    // Each side with its lower corner first, +1 or -1 for its way.
    std::vector<std::tuple<std::uint32_t, std::uint32_t, int>> sides;
    sides.reserve(soup.vertices.size());
    for (std::uint32_t i = 0; i < soup.vertices.size(); ++i)
    {
        const std::uint32_t a = corner[i];
        const std::uint32_t b = corner[i % 3 == 2 ? i - 2 : i + 1];
        if (a != b) sides.emplace_back(std::min(a, b), std::max(a, b), a < b ? 1 : -1);
    }
    std::sort(sides.begin(), sides.end());
    std::uint64_t open = 0;
    for (std::size_t i = 0; i < sides.size();)
    {
        int balance = 0;
        const auto [a, b, way] = sides[i];
        for (; i < sides.size() && std::get<0>(sides[i]) == a && std::get<1>(sides[i]) == b; ++i)
            balance += std::get<2>(sides[i]);
        open += balance != 0 ? 1U : 0U;
    }
    return open;
}

Box3 bounds_of(const DrawOp& op, double dp)
{
    Box3 box;
    const auto thickest = [&](const std::vector<double>& layers)
    { return layers.empty() ? 0 : *std::max_element(layers.begin(), layers.end()) * dp; };
    if (const auto* points = shape_as<PointsOp>(op))
        for (const Vec3& p : points->points) box.add(p);
    else if (const auto* lines = shape_as<LinesOp>(op))
        for (const auto& [from, to] : lines->segments)
        {
            box.add(from);
            box.add(to);
        }
    else if (const auto* figure = shape_as<FigureOp>(op))
        for (const FigureFace& face : figure->faces)
        {
            if (!face.is_visible) continue;
            for (const std::uint32_t v : face.vertices) box.add(figure->vertices[v]);
        }
    else if (const auto* sphere = shape_as<SphereOp>(op))
    {
        const double r = sphere->radius + thickest(sphere->layers_dp);
        add_ball(box, sphere->center, {r, r, r});
    }
    else if (const auto* cylinder = shape_as<CylinderOp>(op))
    {
        const Vec3 along = cylinder->p1 - cylinder->p0;
        const double length = norm(along);
        if (!(length > 0)) return box;
        double r = cylinder->radius;
        for (const CylinderLayer& layer : cylinder->layers) r = std::max(r, layer.radius);
        Vec3 half;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double u = along[axis] / length;
            half[axis] = r * std::sqrt(std::max(0.0, 1 - u * u));
        }
        add_ball(box, cylinder->p0, half);
        add_ball(box, cylinder->p1, half);
    }
    else if (const auto* ellipsoid = shape_as<EllipsoidOp>(op))
    {
        const Vec3 along = ellipsoid->focus1 - ellipsoid->focus0;
        const double a = ellipsoid->radius / 2;
        const double c = norm(along) / 2;
        if (!(a > c)) return box;
        Vec3 half;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double u = c > 0 ? along[axis] / (2 * c) : 0;
            half[axis] = std::sqrt(a * a - c * c * (1 - u * u));
        }
        add_ball(box, (ellipsoid->focus0 + ellipsoid->focus1) * 0.5, half);
    }
    return box;
}

void DrawChecks::warn(const SourceRef& source, Kind kind, const std::string& text)
{
    if (!said_.insert({source.line, kind}).second) return;
    warnings_.push_back(
        fmt::format("{}:{}: <{}>: {}", def_.file, source.line, source.command, text));
}

void DrawChecks::check_shape(const DrawOp& op, const Box3& bounds)
{
    const DrawState& state = *op.state;
    if (bounds.is_empty() || !state.draw_points || state.mk.kind == MkKind::Void ||
        !state.clips.empty())
        return;
    const LatticeGrid& grid = def_.grid;
    const auto flat = [this](int axis) { return is_flat(axis); };
    const Extents size = extents_of(bounds.min, bounds.max, flat);
    const Extents domain = extents_of(def_.case_pos_min, def_.case_pos_max, flat);
    if (const auto* mesh = shape_as<MeshFileOp>(op))
    {
        const bool is_large = size.largest > 100 * domain.largest;
        if (is_large || (100 * size.largest < domain.largest && size.largest < 4 * grid.dp))
        {
            warn(op.source, Kind::Size,
                 fmt::format(
                     "{} is {:g} m wide in a domain of {:g} m with dp = {:g} m; if the file "
                     "is in other units (mm), <drawscale x=\"{}\" y=\"{}\" z=\"{}\" /> turns "
                     "them into metres",
                     mesh->file, size.largest, domain.largest, grid.dp, is_large ? "0.001" : "1000",
                     is_large ? "0.001" : "1000", is_large ? "0.001" : "1000"));
            return;
        }
    }
    if (is_body(op) && size.smallest > 0 && size.smallest < grid.dp * (1 - 1e-9))
        warn(
            op.source, Kind::Thin,
            fmt::format("the body is {:g} m thick, less than dp = {:g} m, so its particles are as "
                        "thick as one or two of them; a dp of {:g} or less resolves it, and size 0 "
                        "draws a single layer on purpose",
                        size.smallest, grid.dp, size.smallest / 2));
    for (int axis = 0; axis < 3; ++axis)
    {
        if (is_flat(axis)) continue;
        const std::int64_t last =
            static_cast<std::int64_t>(grid.n[static_cast<std::size_t>(axis)]) - 1;
        const std::int64_t low = snap(bounds.min[axis], grid.origin[axis], grid.dp);
        const std::int64_t high = snap(bounds.max[axis], grid.origin[axis], grid.dp);
        if (low >= 0 && high <= last) continue;
        warn(op.source, Kind::Lost,
             fmt::format("it reaches from {} = {:g} to {:g}, the nodes of the domain from {:g} to "
                         "{:g}: what lies beyond gives no particles; expected a <pointmin> and "
                         "<pointmax> around it (the node at pointmax is none of them)",
                         "xyz"[axis], bounds.min[axis], bounds.max[axis], grid.origin[axis],
                         grid.origin[axis] + static_cast<double>(last) * grid.dp));
        return;
    }
}

void DrawChecks::check_closed(const SourceRef& source, const MeshFileOp& op,
                              const TriangleSoup& soup)
{
    if (!op.autofill && !op.fill_inside && !op.advanced) return;
    const std::uint64_t open = open_edge_count(soup);
    if (open > 0)
        warn(source, Kind::Open,
             fmt::format("{} has {} open edges or edges between facets that look to different "
                         "sides, so its inside is not certain; close the mesh (fppg inspect shows "
                         "where) or draw it without autofill, advanced or fppg:fill",
                         op.file, open));
}

void DrawChecks::check_fill(const SourceRef& source, const DrawState& state,
                            const std::vector<std::vector<Span>>& nodes)
{
    if (!state.draw_points || state.mk.kind == MkKind::Void) return;
    const LatticeGrid& grid = def_.grid;
    std::string sides;
    const auto add = [&](bool is_there, const char* side)
    {
        if (is_there) sides += (sides.empty() ? "" : ", ") + std::string(side);
    };
    std::array<bool, 6> touches{};
    for (std::size_t x = 0; x < nodes.size(); ++x)
    {
        if (nodes[x].empty()) continue;
        touches[0] = touches[0] || x == 0;
        touches[1] = touches[1] || x + 1 == grid.n[0];
        for (const Span& s : nodes[x])
        {
            touches[2] = touches[2] || s.y == 0;
            touches[3] = touches[3] || s.y + 1 == grid.n[1];
            touches[4] = touches[4] || s.z_begin == 0;
            touches[5] = touches[5] || s.z_end == grid.n[2];
        }
    }
    constexpr std::array<const char*, 6> names{"lowest x",  "highest x", "lowest y",
                                               "highest y", "lowest z",  "highest z"};
    for (std::size_t i = 0; i < 6; ++i)
        add(touches[i] && !is_flat(static_cast<int>(i / 2)), names[i]);
    if (!sides.empty())
        warn(source, Kind::Leak,
             fmt::format("the fill reached the border of the domain ({}): expected walls around "
                         "its seed; close them, or limit the fill by <fillbox>",
                         sides));
}

} // namespace fppg
