#include "fppg/case_def.h"
#include "fppg/domain_clip.h"
#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/shapes.h"

#include "casedef/figures.h"
#include "casedef/file_polygons.h"
#include "casedef/free_parts.h"
#include "casedef/mesh_path.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "lattice/boolean_wall.h"
#include "lattice/cavity_fill.h"
#include "lattice/depth_region.h"
#include "lattice/draw_checks.h"
#include "lattice/draw_pattern.h"
#include "lattice/fill_level.h"
#include "lattice/flood.h"
#include "lattice/free_painter.h"
#include "lattice/free_points.h"
#include "lattice/node_files.h"
#include "lattice/plane_shapes.h"
#include "lattice/redraw.h"
#include "lattice/round_shapes.h"
#include "lattice/shape_mesh.h"
#include "lattice/solids.h"
#include "lattice/wall_painter.h"
#include "lattice/wave_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <deque>

namespace fppg
{
namespace
{

/// From the lowest y of some shapes to their highest, in dp from the plane of a 2D case.
std::pair<double, double> heights_over_plane(const std::vector<ShapeMesh>& shapes,
                                             const LatticeGrid& grid)
{
    Box3 bounds;
    for (const ShapeMesh& shape : shapes)
        for (const Vec3& v : shape.soup.vertices) bounds.add(v);
    return {(bounds.min.y - grid.origin.y) / grid.dp, (bounds.max.y - grid.origin.y) / grid.dp};
}

/// Rounding of the place of a shape, dp.
constexpr double plane_tolerance = 1e-9;

bool lies_in_plane(const std::vector<ShapeMesh>& shapes, const LatticeGrid& grid)
{
    if (!grid.is_2d) return false;
    const auto [low, high] = heights_over_plane(shapes, grid);
    return low >= -plane_tolerance && high <= plane_tolerance;
}

/// In 2D, whether shapes have no line in common with the plane of the particles though the lattice
/// has nodes for them: they lie in the plane, beside it by less than half a step, or touch it in
/// points.
bool lacks_section(const std::vector<ShapeMesh>& shapes, const std::vector<FittedDraw>& walls,
                   const LatticeGrid& grid)
{
    if (!grid.is_2d) return false;
    const bool is_empty = std::all_of(walls.begin(), walls.end(),
                                      [](const FittedDraw& wall)
                                      { return wall.particles.size() + wall.cut.size() == 0; });
    const auto [low, high] = heights_over_plane(shapes, grid);
    const bool is_beside = low > -0.5 && high < 0.5;
    const bool touches = low <= plane_tolerance && high >= -plane_tolerance;
    return is_empty && (is_beside || touches);
}

class Generator
{
public:
    Generator(const CaseDef& def, int threads, LatticeReport& report)
        : def_(def),
          threads_(threads),
          report_(report),
          checks_(def, report.warnings),
          walls_(field_, threads),
          free_(field_, threads)
    {
        field_.grid = def.grid;
        field_.slabs.resize(def.grid.n[0]);
    }

    /// Parts of booleans are drawn together, where the last of them stands.
    void run(std::size_t i)
    {
        bool is_part = false;
        for (const BooleanDef& boolean : def_.booleans)
        {
            if (!boolean.is_drawn) continue;
            std::size_t last = 0;
            bool is_its_part = false;
            for (const BooleanDef::Part& part : boolean.parts)
            {
                last = std::max(last, part.op);
                is_its_part = is_its_part || part.op == i;
            }
            is_part = is_part || is_its_part;
            if (last == i) draw_boolean(boolean);
        }
        if (!is_part) run(def_.ops[i]);
    }

    void run(const DrawOp& op)
    {
        op_ = &op;
        if (const auto* file = std::get_if<MeshFileOp>(&op.what))
            check_mesh(mesh(*file), file->transform);
        else if (def_.zone == 0) // the limits of other zones are meant to cut shapes
            checks_.check_shape(op, bounds_of(op, grid().dp));
        if (fits_walls_ && draw_fitted(op)) return;
        std::visit([this](const auto& what) { draw(what); }, op.what);
    }

    RunField take()
    {
        free_.finish();
        walls_.finish();
        return std::move(field_);
    }

private:
    const DrawState& state() const { return *op_->state; }
    const LatticeGrid& grid() const { return def_.grid; }

    std::string place() const
    {
        return fmt::format("{}:{}: <{}>", def_.file, op_->source.line, op_->source.command);
    }

    /// The spans of a region in one slab, clipped, sorted.
    Spans listed(const SlabRegion& region, std::uint32_t x, bool clips) const
    {
        Spans spans;
        if (x < region.x_begin || x >= region.x_end) return spans;
        region.emit(x, spans);
        if (clips)
            for (const ClipPlane& clip : state().clips) apply_clip(spans, x, clip, grid());
        sort_and_join(spans);
        return spans;
    }

    void paint_region(const SlabRegion& region, bool clips = true)
    {
        if (!state().draw_points || region.x_end <= region.x_begin) return;
        parallel_for(region.x_end - region.x_begin, threads_,
                     [&](std::size_t i)
                     {
                         const auto x = region.x_begin + static_cast<std::uint32_t>(i);
                         paint_slab(x, listed(region, x, clips));
                     });
    }

    void paint_nodes(const std::vector<Spans>& nodes)
    {
        if (!state().draw_points) return;
        parallel_for(nodes.size(), threads_, [&](std::size_t x) { paint_slab(x, nodes[x]); });
    }

    /// A redraw with a boundary mk: walls keep their place and take the new mk.
    void repaint_nodes(const std::vector<Spans>& nodes)
    {
        if (!state().draw_points) return;
        const bool keeps_walls = state().mk.kind == MkKind::Bound;
        parallel_for(nodes.size(), threads_,
                     [&](std::size_t x) { paint_slab(x, nodes[x], keeps_walls); });
    }

    /// Paints through the pattern.
    void paint_slab(std::size_t x, const Spans& spans, bool keeps_walls = false)
    {
        if (!state().pattern || std::holds_alternative<RedrawNearOp>(op_->what))
        {
            paint_slab(x, spans, state().mk, keeps_walls);
            return;
        }
        const PatternSplit split =
            split_by_pattern(*state().pattern, spans, static_cast<std::uint32_t>(x));
        paint_slab(x, split.drawn, state().mk, keeps_walls);
        const bool is_fill = std::holds_alternative<FillOp>(op_->what);
        if (state().mk_back || is_fill)
        {
            const MkValue back = state().mk_back.value_or(MkValue{});
            paint_slab(x, split.left_out, back, keeps_walls && back.kind == MkKind::Bound);
        }
    }

    /// Stops with a message where the machine would start to swap or kill the process.
    void paint_slab(std::size_t x, const Spans& spans, const MkValue& mk, bool keeps_walls)
    {
        std::vector<Run>& slab = field_.slabs[x];
        const std::size_t before = slab.size();
        const Spans zone = walls_.paint_over(x, spans, mk.mk, keeps_walls);
        paint(slab, spans, mk.mk);
        if (!zone.empty()) paint(slab, zone, mk.mk | wall_zone_bit);
        const std::uint64_t runs = runs_ += slab.size() - before; // wraps where runs were joined
        if (runs > run_limit_ && runs < UINT64_MAX / 2)
            throw CaseError(
                def_.file, op_->source.line,
                fmt::format(
                    "<{}>: the drawn regions need more memory than this machine has left: {} runs "
                    "of nodes so far; a larger dp or a smaller domain needs less",
                    op_->source.command, runs));
    }

    /// Draws a shape of a body-fitted mk by its true surface.
    ///
    /// returns  false for what stays on the lattice: other mks, points, lines, wires, fills, and in
    ///          2D what lies in the plane of the particles
    bool draw_fitted(const DrawOp& op)
    {
        const FitSettings* settings =
            state().mk.kind == MkKind::Bound ? fit_settings(def_.fit, state().mk.mk) : nullptr;
        if (settings == nullptr || state().mode == DrawMode::Wire) return false;
        const auto* file = std::get_if<MeshFileOp>(&op.what);
        if (std::holds_alternative<WaveOp>(op.what))
            throw GeometryError(
                fmt::format("{}: it has no surface for body-fitted particles; draw it "
                            "with a mk that is not body-fitted",
                            place()));
        if (file != nullptr && file->clip_resize && !file->advanced)
            throw GeometryError(fmt::format(
                "{}: <clipdomain> opens the surface, which body-fitted particles cannot "
                "follow; they end at the domain without it",
                place()));
        if (file != nullptr && mesh(*file).soup.vertices.empty()) return false;
        try
        {
            const std::vector<ShapeMesh> shapes =
                shape_meshes(op, file != nullptr ? &mesh(*file).soup : nullptr, grid().dp);
            if (shapes.empty()) return false;
            if (state().pattern && state().draw_points)
                throw GeometryError(
                    "setpattern leaves nodes of the lattice out, which body-fitted particles "
                    "cannot "
                    "follow; draw this shape with a mk that is not body-fitted, or without a "
                    "pattern");
            std::vector<FittedDraw> walls;
            if (state().draw_points && !lies_in_plane(shapes, grid()))
                for (const ShapeMesh& shape : shapes) walls.push_back(fit(shape, op, *settings));
            if (state().draw_points && lacks_section(shapes, walls, grid()))
            {
                report_.warnings.push_back(fmt::format(
                    "{}: the shape lies within dp/2 of the plane y = {:g} of this 2D case or only "
                    "touches it, so it has no section to put particles on; it is drawn on the "
                    "lattice, not body-fitted",
                    place(), grid().origin.y));
                return false;
            }
            for (FittedDraw& wall : walls) add_wall(std::move(wall), file);
            if (file != nullptr && !file->advanced)
                draw_points_and_lines(mesh(*file), file->transform);
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", place(), e.what()));
        }
        return true;
    }

    /// Draws the result of a combination: by its true surface, or the nodes of its parts by
    /// interval operations where they stay on the lattice.
    void draw_boolean(const BooleanDef& boolean)
    {
        const std::vector<char> stays = staying_parts(boolean.tree, boolean.parts.size());
        const auto first =
            static_cast<std::size_t>(std::find(stays.begin(), stays.end(), 1) - stays.begin());
        const DrawOp& leading = def_.ops[boolean.parts[first].op];
        // The result has the state of its first part, and stands where the boolean does.
        DrawState whole = *leading.state;
        whole.mk = mk_of(boolean, first);
        DrawOp op;
        op.source = {boolean.line, "boolean", boolean.name};
        op.state = std::make_shared<const DrawState>(whole);
        const FitSettings* settings =
            whole.mk.kind == MkKind::Bound ? fit_settings(def_.fit, whole.mk.mk) : nullptr;
        if (settings != nullptr)
            fit_parts(boolean, op, *settings);
        else
            paint_parts(boolean, op);
    }

    MkValue mk_of(const BooleanDef& boolean, std::size_t part) const
    {
        if (!boolean.mk) return def_.ops[boolean.parts[part].op].state->mk;
        return {MkKind::Bound, *boolean.mk,
                static_cast<std::uint16_t>(*boolean.mk - def_.mk_bound_first)};
    }

    void fit_parts(const BooleanDef& boolean, const DrawOp& whole, const FitSettings& settings)
    {
        std::vector<BooleanWallPart> parts;
        for (std::size_t p = 0; p < boolean.parts.size(); ++p)
        {
            const DrawOp& op = def_.ops[boolean.parts[p].op];
            op_ = &op;
            BooleanWallPart part;
            part.name = op.source.name.empty()
                            ? fmt::format("<{}> in line {}", op.source.command, op.source.line)
                            : op.source.name;
            part.mk = mk_of(boolean, p).mk;
            part.may_be_sheet = boolean.parts[p].is_sheet;
            const auto* file = std::get_if<MeshFileOp>(&op.what);
            const TriangleSoup* soup = file != nullptr ? &mesh(*file).soup : nullptr;
            try
            {
                if (soup == nullptr || !soup->vertices.empty())
                    for (const ShapeMesh& shape : shape_meshes(op, soup, grid().dp))
                    {
                        part.soup.vertices.insert(part.soup.vertices.end(),
                                                  shape.soup.vertices.begin(),
                                                  shape.soup.vertices.end());
                        part.is_solid = part.is_solid || shape.is_solid;
                    }
            }
            catch (const GeometryError& e)
            {
                throw GeometryError(fmt::format("{}: {}", place(), e.what()));
            }
            if (part.soup.vertices.empty())
                throw GeometryError(
                    fmt::format("{}: has no surface, so that it cannot be a part of "
                                "the <boolean> in line {}",
                                place(), boolean.line));
            parts.push_back(std::move(part));
        }
        op_ = &whole;
        if (!state().draw_points) return;
        try
        {
            FittedDraw draw =
                fit_boolean(parts, boolean.tree, settings, grid(), state().clips, threads_);
            draw.body.line = boolean.line;
            draw.body.name = boolean.name.empty() ? "boolean" : "boolean " + boolean.name;
            add_wall(std::move(draw), nullptr);
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", place(), e.what()));
        }
    }

    /// The nodes that the draw of a part takes on an empty lattice.
    SpanSet nodes_of(const DrawOp& op)
    {
        DrawOp alone = op;
        DrawState state_alone = *op.state;
        state_alone.mk = {MkKind::Bound, def_.mk_bound_first, 0};
        if (state_alone.mk.mk == 0) state_alone.mk.mk = 1;
        alone.state = std::make_shared<const DrawState>(state_alone);
        Generator generator(def_, threads_, report_);
        generator.fits_walls_ = false;
        generator.run(alone);
        const RunField field = generator.take();
        SpanSet out;
        out.slabs.resize(field.slabs.size());
        parallel_for(field.slabs.size(), threads_,
                     [&](std::size_t x) { out.slabs[x] = occupied(field.slabs[x]); });
        return out;
    }

    void paint_parts(const BooleanDef& boolean, const DrawOp& whole)
    {
        std::vector<SpanSet> sets;
        for (const BooleanDef::Part& part : boolean.parts)
            sets.push_back(nodes_of(def_.ops[part.op]));
        const SpanSet nodes = boolean_spans(sets, boolean.tree, threads_);
        const std::vector<SpanSet> shares = share_out(nodes, sets, boolean.tree, threads_);
        for (std::size_t p = 0; p < shares.size(); ++p)
        {
            if (shares[p].slabs.empty()) continue;
            DrawState painted = *whole.state;
            painted.mk = mk_of(boolean, p);
            DrawOp op = whole;
            op.state = std::make_shared<const DrawState>(painted);
            op_ = &op;
            paint_region(region_of(shares[p]));
        }
        if (nodes.slabs.empty())
            report_.warnings.push_back(
                fmt::format("{}:{}: <boolean>: nothing is left of its parts on the lattice",
                            def_.file, boolean.line));
        op_ = nullptr;
    }

    FittedDraw fit(const ShapeMesh& shape, const DrawOp& op, const FitSettings& settings) const
    {
        FittedDraw draw = fit_shape(shape, settings, grid(), state().clips, threads_);
        draw.body.line = op.source.line;
        draw.body.name = op.source.command;
        draw.body.mk = state().mk.mk;
        return draw;
    }

    void add_wall(FittedDraw&& draw, const MeshFileOp* file)
    {
        report_.triangles += draw.body.report.facets_read;
        if (file != nullptr)
        {
            draw.body.name += " " + file->file;
            if (file->advanced) keep_depth(draw, *file);
        }
        // A tank drawn without its lid is open on purpose.
        if (file == nullptr && !draw.body.is_solid && draw.body.facet_mk.empty())
            draw.warnings.clear();
        for (const std::string& w : draw.warnings)
            report_.warnings.push_back(file != nullptr
                                           ? fmt::format("{}: {}: {}", place(), file->file, w)
                                           : fmt::format("{}: {}", place(), w));
        if (draw.particles.size() == 0)
            report_.warnings.push_back(fmt::format(
                "{}: no particle of the body-fitted wall lies inside the domain", place()));
        walls_.add(std::move(draw));
    }

    static void turn_over(TriangleSoup& soup)
    {
        for (std::size_t t = 0; t < soup.size(); ++t)
            std::swap(soup.vertices[3 * t + 1], soup.vertices[3 * t + 2]);
    }

    /// `advanced`: of the inside, the nodes whose depth is asked for.
    void keep_depth(FittedDraw& draw, const MeshFileOp& op)
    {
        TriangleSoup moved = moved_soup(mesh(op).soup, op.transform);
        if (state().normal_invert) turn_over(moved);
        if (!op.any_depth) draw.body.figures.filled = 0; // only a layer of it is
        const SlabRegion region = depth_region(moved, op, grid(), threads_);
        parallel_for(draw.volume.size(), threads_,
                     [&](std::size_t x)
                     {
                         draw.volume[x] = intersect(
                             draw.volume[x], listed(region, static_cast<std::uint32_t>(x), true));
                     });
    }

    bool is_off_lattice() const { return state().off_lattice; }

    /// Particles at their true places, for setfrdrawmode.
    template <typename MakePoints>
    void draw_free(const MakePoints& make_points)
    {
        if (!state().draw_points) return;
        std::vector<Vec3> points;
        try
        {
            points = make_points();
        }
        catch (const GeometryError& e)
        {
            throw CaseError(def_.file, op_->source.line,
                            fmt::format("<{}>: {}", op_->source.command, e.what()));
        }
        const std::vector<Spans> nodes = free_.draw(points, state().clips, state().mk.mk);
        parallel_for(nodes.size(), threads_,
                     [&](std::size_t x) { paint_slab(x, nodes[x], state().mk, false); });
    }

    void draw_free_lines(const std::vector<std::pair<Vec3, Vec3>>& segments)
    {
        draw_free(
            [&]
            {
                std::vector<Vec3> points;
                for (const auto& [from, to] : segments)
                {
                    const std::vector<Vec3> line = free_line(from, to, grid().dp);
                    points.insert(points.end(), line.begin(), line.end());
                }
                return points;
            });
    }

    void draw(const PointsOp& op)
    {
        if (is_off_lattice())
            draw_free([&] { return op.points; });
        else
        {
            // Clips keep or drop a point where it is, not its node (8 points at two planes, GenCase
            // v5.0).
            std::vector<Vec3> kept = op.points;
            for (const ClipPlane& plane : state().clips)
                std::erase_if(kept, [clip = Clip(plane)](const Vec3& p) { return !clip.keeps(p); });
            paint_region(points_region(kept, grid()), false);
        }
    }

    void draw(const LinesOp& op)
    {
        if (is_off_lattice())
        {
            draw_free_lines(op.segments);
            return;
        }
        std::vector<std::pair<Node, Node>> segments;
        for (const auto& [from, to] : op.segments)
            segments.emplace_back(snap(from, grid()), snap(to, grid()));
        paint_region(lines_region(segments, grid(), state().constants.line));
    }

    void draw_triangles(std::vector<SnappedTriangle> triangles)
    {
        report_.triangles += triangles.size();
        for (const SnappedTriangle& t : triangles)
            report_.triangles_ignored += t.a == t.b && t.b == t.c;
        paint_region(triangles_region(std::move(triangles), grid(),
                                      state().constants.triangle_weight,
                                      state().constants.triangle_limits));
    }

    /// A figure off the lattice, part by part; of solids but boxes the inside stands on the
    /// lattice.
    void draw_free_figure(const FigureOp& op)
    {
        if (op.solid == SolidKind::Box && !grid().is_2d)
        {
            const auto corner = [&](std::size_t i) { return op.vertices[op.solid_vertices[i]]; };
            draw_free(
                [&] {
                    return free_block(corner(0), {corner(1), corner(3), corner(4)}, grid().dp);
                });
            return;
        }
        std::vector<FreePart> parts = free_parts(op, state().mode, state().matrix, grid());
        if (op.part_count > 0) parts = {parts.at(op.part)};
        std::vector<SlabRegion> insides;
        for (const FreePart& part : parts)
        {
            if (!part.inside)
            {
                draw_free_pieces(part.pieces);
                continue;
            }
            if (insides.empty())
                insides = op.solid == SolidKind::Prism
                              ? solid_parts(op, grid(), state().constants.triangle_weight,
                                            state().constants.triangle_limits)
                              : std::vector<SlabRegion>{solid_of(op)};
            paint_region(insides.at(*part.inside));
        }
    }

    void draw_free_pieces(const std::vector<std::vector<Vec3>>& pieces)
    {
        draw_free(
            [&]
            {
                std::vector<Vec3> points;
                for (const std::vector<Vec3>& corners : pieces)
                {
                    const std::vector<Vec3> more = free_polygon(corners, grid());
                    points.insert(points.end(), more.begin(), more.end());
                }
                return points;
            });
    }

    void draw_free_wire(const FigureOp& op)
    {
        std::vector<std::pair<Vec3, Vec3>> segments;
        const auto add_sides = [&](const auto& corners)
        {
            for (std::size_t i = 0; i < corners.size(); ++i)
                segments.emplace_back(op.vertices[corners[i]],
                                      op.vertices[corners[(i + 1) % corners.size()]]);
        };
        for (const FigureFace& face : op.faces)
        {
            if (!face.is_visible) continue;
            if (face.triangles.empty() && face.cut.empty())
                add_sides(face.vertices);
            else
                for (const auto& t : face_triangles(op, face)) add_sides(t);
        }
        if (op.part_count > 0) segments = {segments.at(op.part)};
        draw_free_lines(segments);
    }

    void draw(const FigureOp& op)
    {
        if (is_off_lattice())
        {
            if (state().mode == DrawMode::Wire && op.solid != SolidKind::Box)
                draw_free_wire(op);
            else
                draw_free_figure(op);
            return;
        }
        if (state().mode == DrawMode::Wire)
        {
            std::vector<std::pair<Node, Node>> segments = wire_of(op);
            if (op.part_count > 0) segments = {segments.at(op.part)};
            paint_region(lines_region(segments, grid(), state().constants.line));
            return;
        }
        if (op.part_count > 0)
        {
            draw_part(op);
            return;
        }
        const bool fills = state().mode != DrawMode::Face && op.solid != SolidKind::None;
        if (state().mode == DrawMode::Full || !fills)
            draw_triangles(snapped_triangles(op, grid(), true));
        if (fills) paint_region(solid_of(op));
    }

    /// The sides of the visible triangles and quads, in this order: so the wire of a solid box
    /// shows the cut between its two prisms (rule S4).
    std::vector<std::pair<Node, Node>> wire_of(const FigureOp& op) const
    {
        std::vector<std::pair<Node, Node>> segments;
        FigureOp one = op;
        for (const FigureFace& face : op.faces)
        {
            if (!face.is_visible) continue;
            if (face.triangles.empty() && face.cut.empty())
            {
                const std::vector<std::uint32_t>& v = face.vertices;
                for (std::size_t i = 0; i < v.size(); ++i)
                    segments.emplace_back(snap(op.vertices[v[i]], grid()),
                                          snap(op.vertices[v[(i + 1) % v.size()]], grid()));
                continue;
            }
            one.faces = {face};
            for (const SnappedTriangle& t : snapped_triangles(one, grid(), true))
                segments.insert(segments.end(), {{t.a, t.b}, {t.b, t.c}, {t.c, t.a}});
        }
        return segments;
    }

    /// One part of a figure, for setmknextauto.
    void draw_part(const FigureOp& op)
    {
        const DrawConstants& c = state().constants;
        const bool fills = state().mode != DrawMode::Face && op.solid != SolidKind::None;
        std::vector<SlabRegion> parts;
        // The inside of a <drawfigure> comes after its faces, that of other shapes before them.
        const bool fills_last = fills && op.solid == SolidKind::Faces;
        if (fills && !fills_last)
            parts = solid_parts(op, grid(), c.triangle_weight, c.triangle_limits);
        FigureOp face = op;
        const auto add = [&](std::vector<SnappedTriangle> triangles)
        {
            parts.push_back(triangles_region(std::move(triangles), grid(), c.triangle_weight,
                                             c.triangle_limits));
        };
        for (const FigureFace& f : op.faces)
        {
            if (!f.is_visible || (fills && state().mode == DrawMode::Solid)) continue;
            face.faces = {f};
            const std::vector<SnappedTriangle> triangles = snapped_triangles(face, grid(), true);
            if (f.triangles.empty() && f.cut.empty())
                add(triangles);
            else
                for (const SnappedTriangle& t : triangles) add({t});
        }
        if (fills_last)
            for (SlabRegion& inside : solid_parts(op, grid(), c.triangle_weight, c.triangle_limits))
                parts.push_back(std::move(inside));
        paint_region(parts.at(op.part));
    }

    SlabRegion solid_of(const FigureOp& op) const
    {
        return solid_region(op, grid(), state().constants.triangle_weight,
                            state().constants.triangle_limits);
    }

    void draw(const SphereOp& op)
    {
        if (is_off_lattice())
            draw_free_sphere(op);
        else
            paint_region(sphere_region(op, state(), grid()));
    }

    void draw_free_sphere(const SphereOp& op)
    {
        if (!grid().is_2d)
        {
            draw_free([&] { return free_sphere(op, state().matrix, state().mode, grid().dp); });
            return;
        }
        draw_free([&] { return free_disc(op, state().mode, grid().origin.y, grid().dp); });
    }

    void draw(const CylinderOp& op)
    {
        if (is_off_lattice())
        {
            if (state().draw_points && fills_free_cylinder(op, state().mode))
            {
                const std::vector<Spans> nodes =
                    emptied_by_cylinder(op, state().clips, grid(), threads_);
                parallel_for(nodes.size(), threads_,
                             [&](std::size_t x)
                             {
                                 // A pattern leaves nodes out here, though not of the particles.
                                 const auto slab = static_cast<std::uint32_t>(x);
                                 const Spans emptied =
                                     state().pattern
                                         ? split_by_pattern(*state().pattern, nodes[x], slab).drawn
                                         : nodes[x];
                                 paint_slab(x, emptied, MkValue{}, false);
                             });
            }
            draw_free([&] { return free_cylinder(op, state().mode, grid().dp); });
        }
        else
            paint_region(cylinder_region(op, state(), grid()));
    }
    void draw(const EllipsoidOp& op)
    {
        if (is_off_lattice())
            throw CaseError(def_.file, op_->source.line,
                            fmt::format("<{}>: an ellipsoid is not possible with setfrdrawmode "
                                        "(GenCase refuses it too)",
                                        op_->source.command));
        paint_region(ellipsoid_region(op, state(), grid()));
    }

    void draw(const WaveOp& op) { paint_region(wave_region(op, grid())); }

    const MeshFile& mesh(const MeshFileOp& op)
    {
        for (const ReadMesh& known : meshes_)
            if (known.name == op.file && known.reading == op.reading) return known.mesh;
        const std::string path = find_mesh_file(def_, op_->source, op.file);
        MeshFile read;
        try
        {
            read = read_mesh_file(path, op.reading, threads_);
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", place(), e.what()));
        }
        note_use(op.container, op.container);
        note_use(op.file, path);
        for (const std::string& w : read.warnings)
            report_.warnings.push_back(fmt::format("{}: {}: {}", place(), path, w));
        return meshes_.emplace_back(op.file, op.reading, std::move(read)).mesh;
    }

    void note_use(const std::string& name, const std::string& path)
    {
        const auto is_it = [&](const MeshFileUse& use) { return use.name == name; };
        if (!name.empty() &&
            std::none_of(report_.mesh_files.begin(), report_.mesh_files.end(), is_it))
            report_.mesh_files.push_back(
                {name, find_mesh_file(def_, op_->source, path), op_->source.line});
    }

    /// Single points and lines of a mesh file; lines are those of drawline.
    void draw_points_and_lines(const MeshFile& file, const Transform& transform)
    {
        std::vector<Vec3> points;
        for (const Vec3& p : file.points) points.push_back(transform(p));
        if (!points.empty()) draw(PointsOp{std::move(points)});
        LinesOp lines;
        for (const std::vector<Vec3>& line : file.lines)
            for (std::size_t i = 1; i < line.size(); ++i)
                lines.segments.emplace_back(transform(line[i - 1]), transform(line[i]));
        if (!lines.segments.empty()) draw(lines);
    }

    TriangleSoup moved_soup(const TriangleSoup& source, const Transform& transform) const
    {
        TriangleSoup moved;
        moved.vertices.resize(source.vertices.size());
        parallel_for(
            moved.vertices.size(), threads_,
            [&](std::size_t i) { moved.vertices[i] = transform(source.vertices[i]); }, 4096);
        return moved;
    }

    /// The triangles and quads of a file, or their sides, off the lattice.
    void draw_free_mesh(const MeshFileOp& op, const MeshFile& file)
    {
        FigureOp figure;
        figure.vertices = moved_soup(file.soup, op.transform).vertices;
        for_each_polygon(file, op, grid().dp,
                         [&](std::vector<std::uint32_t> corners) {
                             figure.faces.push_back({std::move(corners), true, {}, 0, {}});
                         });
        if (state().mode == DrawMode::Wire)
            draw_free_wire(figure);
        else
            // With the placement of the file, which is a part of the matrix then.
            draw_free_pieces(free_pieces(figure, op.transform, grid()));
    }

    bool is_parallelogram(const TriangleSoup& soup, const std::vector<std::uint32_t>& quad) const
    {
        const auto corner = [&](std::size_t i) { return soup.vertices[quad[i]]; };
        return quad_kind({corner(0), corner(1), corner(2), corner(3)}, grid().dp) !=
               QuadKind::Other;
    }

    /// The triangles of one cell of a table of heights, on the lattice.
    void add_cell(const TriangleSoup& soup, const std::vector<std::uint32_t>& corners,
                  std::vector<SnappedTriangle>& triangles) const
    {
        const auto node = [&](std::size_t i) { return snap(soup.vertices[corners[i]], grid()); };
        for (std::size_t i = 2; i < corners.size(); ++i)
            triangles.push_back({node(0), node(i - 1), node(i)});
    }

    /// A table of heights off the lattice: the cells that are parallelograms within 0.1 dp (as
    /// trapezoids from 0.05 dp on), in wire mode the sides of all flat ones. The triangles of the
    /// others stand on the lattice. Each cell comes after the one before, which it may remove (24
    /// cells of GenCase v5.4.354 with one corner off by 0.04 to 0.4 dp, six saddles).
    void draw_free_heights(const MeshFileOp& op, const MeshFile& file)
    {
        const bool is_wire = state().mode == DrawMode::Wire;
        const TriangleSoup moved = moved_soup(file.soup, op.transform);
        FigureOp cells;
        cells.vertices = moved.vertices;
        std::vector<SnappedTriangle> others;
        const auto draw_cells = [&]
        {
            if (cells.faces.empty()) return;
            if (is_wire)
                draw_free_wire(cells);
            else
                draw_free_pieces(free_pieces(cells, state().matrix, grid()));
            cells.faces.clear();
        };
        const auto draw_others = [&]
        {
            if (!others.empty()) draw_triangles(std::move(others));
            others.clear();
        };
        for_each_polygon(
            file, op, grid().dp,
            [&](std::vector<std::uint32_t> corners)
            {
                if (corners.size() == 4 && (is_wire || is_parallelogram(moved, corners)))
                {
                    draw_others();
                    cells.faces.push_back({std::move(corners), true, {}, 0, {}});
                }
                else
                {
                    draw_cells();
                    add_cell(moved, corners, others);
                }
            });
        draw_cells();
        draw_others();
    }

    /// The cells of a table of heights under setmknextauto: every flat one is a part, in wire mode
    /// each of its sides. Bent ones get the mk that is next and leave it to the cell behind them.
    void draw_heights_in_parts(const MeshFileOp& op, const MeshFile& file)
    {
        const TriangleSoup moved = moved_soup(file.soup, op.transform);
        std::uint32_t part = 0;
        for_each_polygon(
            file, op, grid().dp,
            [&](const std::vector<std::uint32_t>& corners)
            {
                const bool is_bent = corners.size() == 3;
                if (state().mode == DrawMode::Wire && !is_bent)
                {
                    for (std::size_t i = 0; i < 4; ++i)
                        with_mk(part++,
                                [&] {
                                    draw(LinesOp{{{moved.vertices[corners[i]],
                                                   moved.vertices[corners[(i + 1) % 4]]}}});
                                });
                    return;
                }
                with_mk(is_bent ? part : part++,
                        [&]
                        {
                            FigureOp cell;
                            if (!is_bent && is_off_lattice() && is_parallelogram(moved, corners))
                            {
                                for (const std::uint32_t v : corners)
                                    cell.vertices.push_back(moved.vertices[v]);
                                cell.faces.push_back({{0, 1, 2, 3}, true, {}, 0, {}});
                                draw(cell);
                                return;
                            }
                            std::vector<SnappedTriangle> triangles;
                            add_cell(moved, corners, triangles);
                            draw_triangles(std::move(triangles));
                        });
            });
    }

    /// The sides of all triangles and quads, as lines; but the triangles of bent quads in
    /// bathymetries are painted (GenCase v5.4.354: a peak on 3 x 3 quads, two random ones).
    void draw_wire(const MeshFileOp& op, const MeshFile& file)
    {
        std::vector<std::pair<Node, Node>> segments;
        std::vector<SnappedTriangle> triangles;
        for_each_polygon(file, op, grid().dp,
                         [&](const std::vector<std::uint32_t>& corners)
                         {
                             std::vector<Node> nodes;
                             for (const std::uint32_t v : corners)
                                 nodes.push_back(snap(op.transform(file.soup.vertices[v]), grid()));
                             if (has_heights(op.reading.format) && nodes.size() == 3)
                                 triangles.push_back({nodes[0], nodes[1], nodes[2]});
                             else
                                 for (std::size_t i = 0; i < nodes.size(); ++i)
                                     segments.emplace_back(nodes[i], nodes[(i + 1) % nodes.size()]);
                         });
        if (!triangles.empty()) draw_triangles(std::move(triangles));
        paint_region(lines_region(segments, grid(), state().constants.line));
    }

    /// Under setmknextauto: calls body() for the draw with an mk that is so many further.
    template <typename Body>
    void with_mk(std::uint32_t steps, const Body& body)
    {
        const DrawOp* whole = op_;
        auto state = std::make_shared<DrawState>(*whole->state);
        if (state->mk.kind != MkKind::Void)
            state->mk.mk = static_cast<std::uint16_t>(state->mk.mk + steps);
        const DrawOp part{whole->source, std::move(state), whole->what};
        op_ = &part;
        body();
        op_ = whole;
    }

    /// The parts of a mesh file under setmknextauto, which are those that reading the case counts.
    void draw_in_parts(const MeshFileOp& op, const MeshFile& file)
    {
        std::uint32_t part = 0;
        const auto draw_sides = [&](const std::vector<Vec3>& corners, bool is_closed)
        {
            for (std::size_t i = 0; i + (is_closed ? 0 : 1) < corners.size(); ++i)
                with_mk(part++,
                        [&] {
                            draw(LinesOp{{{corners[i], corners[(i + 1) % corners.size()]}}});
                        });
        };
        if (!op.advanced)
        {
            MeshFile points;
            points.points = file.points;
            draw_points_and_lines(points, op.transform);
            for (const std::vector<Vec3>& line : file.lines)
            {
                ++part; // the first point, which the first segment draws again
                std::vector<Vec3> moved;
                for (const Vec3& p : line) moved.push_back(op.transform(p));
                draw_sides(moved, false);
            }
        }
        const TriangleSoup moved = moved_soup(file.soup, op.transform);
        const bool is_wire = state().mode == DrawMode::Wire;
        const auto count = [&](const std::vector<std::uint32_t>& corners)
        { part += is_wire ? static_cast<std::uint32_t>(corners.size()) : 1; };
        for_each_polygon(file, op, grid().dp,
                         [&](const std::vector<std::uint32_t>& corners)
                         {
                             FigureOp face;
                             for (const std::uint32_t v : corners)
                                 face.vertices.push_back(moved.vertices[v]);
                             if (op.advanced)
                                 count(corners);
                             else if (is_wire)
                                 draw_sides(face.vertices, true);
                             else
                             {
                                 face.faces.push_back({{0, 1, 2}, true, {}, 0, {}});
                                 if (corners.size() == 4) face.faces[0].vertices.push_back(3);
                                 with_mk(part++, [&] { draw(face); });
                             }
                         });
        for (const std::string& other : op.joined)
            for_each_polygon(joined_file(op, other), op, grid().dp, count);
        if (op.advanced || op.autofill) checks_.check_closed(*op_, moved);
        with_mk(part,
                [&]
                {
                    if (op.advanced)
                        draw_by_depth(op, moved);
                    else if (op.autofill)
                        autofill(moved, file.soup, file, op.transform);
                });
    }

    void draw(const MeshFileOp& op)
    {
        if (op.is_drawn_before) return;
        if (op.clip_resize)
            draw_clipped(op);
        else
            draw_file(op, mesh(op));
    }

    void draw_file(const MeshFileOp& op, const MeshFile& file)
    {
        if (!state().mk_next_auto)
            draw_mesh(op, file);
        else if (has_heights(op.reading.format))
            draw_heights_in_parts(op, file);
        else
            draw_in_parts(op, file);
    }

    /// Draws what `<clipdomain>` leaves of a file: its triangles cut at the grown domain.
    void draw_clipped(const MeshFileOp& op)
    {
        if (op.fill_inside)
            throw CaseError(def_.file, op_->source.line,
                            fmt::format("<{}>: fppg:fill=\"inside\" is not possible together with "
                                        "<clipdomain>, which opens the surface",
                                        op_->source.command));
        const Box3 box = clip_box(def_.case_pos_min, def_.case_pos_max, *op.clip_resize);
        for (int axis = 0; axis < 3; ++axis)
            if (box.min[axis] > box.max[axis])
                throw CaseError(
                    def_.file, op_->source.line,
                    fmt::format("<{}>: <clipdomain resize=\"{:g}\">: nothing is left of the domain "
                                "along {}",
                                op_->source.command, *op.clip_resize, "xyz"[axis]));
        // With advanced GenCase draws all of the file nevertheless; where nothing of a PLY file is
        // left it refuses many cases, but not all under a turn (3 of 6), so fppg refuses none.
        MeshFileOp whole = op;
        whole.reading = reading_to_clip(op.reading);
        const MeshFile& file = mesh(whole);
        if (op.advanced || is_within(file, op.transform, box))
        {
            draw_file(op, mesh(op));
            return;
        }
        const MeshFile cut = clip_to_box(file, op.transform, box, op.reading);
        // GenCase passes over this for the other formats.
        if (op.reading.format == MeshFormat::Ply && cut.soup.vertices.empty())
            throw CaseError(def_.file, op_->source.line,
                            fmt::format("<{}>: {}: <clipdomain> leaves nothing of it, expected "
                                        "that it reaches into the domain",
                                        op_->source.command, op.file));
        draw_file(op, cut);
    }

    /// A file drawn by its depth, with the others of its mesh. `moved` is its own surface.
    void draw_by_depth(const MeshFileOp& op, TriangleSoup moved)
    {
        for (const std::string& other : op.joined)
        {
            const TriangleSoup more = moved_soup(joined_file(op, other).soup, op.transform);
            moved.vertices.insert(moved.vertices.end(), more.vertices.begin(), more.vertices.end());
        }
        if (state().normal_invert) turn_over(moved);
        paint_region(depth_region(moved, op, grid(), threads_));
    }

    const MeshFile& joined_file(const MeshFileOp& op, const std::string& other)
    {
        MeshFileOp joined = op;
        joined.file = other;
        return mesh(joined);
    }

    void draw_mesh(const MeshFileOp& op, const MeshFile& file)
    {
        const TriangleSoup& source = file.soup;
        if (!op.advanced) draw_points_and_lines(file, op.transform);
        if (has_heights(op.reading.format) && is_off_lattice())
        {
            draw_free_heights(op, file);
            return;
        }
        if (!op.advanced && is_off_lattice())
        {
            draw_free_mesh(op, file);
            const TriangleSoup moved = moved_soup(source, op.transform);
            if (op.fill_inside) paint_region(region_of(inside_spans(moved, grid(), threads_)));
            if (op.autofill) autofill(moved, source, file, op.transform);
            return;
        }
        if (!op.advanced && !op.fill_inside && state().mode == DrawMode::Wire)
        {
            draw_wire(op, file);
            if (op.autofill) autofill(moved_soup(source, op.transform), source, file, op.transform);
            return;
        }
        std::vector<SnappedTriangle> triangles(source.size());
        parallel_for(
            source.size(), threads_,
            [&](std::size_t t)
            {
                const auto corner = [&](std::size_t i)
                { return snap(op.transform(source.vertices[3 * t + i]), grid()); };
                triangles[t] = {corner(0), corner(1), corner(2)};
            },
            4096);
        // The corners themselves are needed for the inside only.
        TriangleSoup moved;
        if (op.advanced || op.fill_inside || op.autofill)
        {
            moved = moved_soup(source, op.transform);
            checks_.check_closed(*op_, moved);
        }
        if (op.advanced)
        {
            draw_by_depth(op, std::move(moved));
            return;
        }
        if (op.fill_inside)
        {
            paint_region(region_of(inside_spans(moved, grid(), threads_)));
            draw_triangles(std::move(triangles));
            return;
        }
        draw_triangles(std::move(triangles));
        if (op.autofill) autofill(moved, source, file, op.transform);
    }

    void check_mesh(const MeshFile& file, const Transform& transform)
    {
        Box3 bounds;
        for (const Vec3& p : file.points) bounds.add(transform(p));
        for (const std::vector<Vec3>& line : file.lines)
            for (const Vec3& p : line) bounds.add(transform(p));
        for (const Vec3& v : file.soup.vertices) bounds.add(transform(v));
        checks_.check_shape(*op_, bounds);
    }

    static SlabRegion region_of(SpanSet set)
    {
        auto shared = std::make_shared<const SpanSet>(std::move(set));
        SlabRegion region;
        region.x_begin = shared->x_begin;
        region.x_end = shared->x_begin + static_cast<std::uint32_t>(shared->slabs.size());
        region.emit = [shared](std::uint32_t x, Spans& out)
        { out = shared->slabs[x - shared->x_begin]; };
        return region;
    }

    /// A flood over void nodes from the centre of the file's own box, inside that box grown by dp,
    /// both moved by `transform` (rule X2). It is no inside test: the notch of an L or the hole of
    /// a torus is filled. Says so.
    ///
    /// soup    the surface where it is drawn
    /// source  the surface in the coordinates of the box
    void autofill(const TriangleSoup& soup, const TriangleSoup& source, const MeshFile& file,
                  const Transform& transform)
    {
        Box3 bounds;
        for (const Vec3& p : file.points) bounds.add(p);
        for (const std::vector<Vec3>& line : file.lines)
            for (const Vec3& p : line) bounds.add(p);
        for (const Vec3& v : source.vertices) bounds.add(v);
        if (bounds.is_empty()) return;
        // A file in one plane across an axis is not filled (GenCase v5.4.354: flat rings across x,
        // y and z, in 2D and 3D; one bent by 1e-9 m, or what a clipdomain leaves beyond the plane
        // of a 2D case by 1e-17 m, is).
        for (int axis = 0; axis < 3; ++axis)
            if (bounds.min[axis] == bounds.max[axis]) return;
        // The limits are the strict interior of the box grown by dp, in float as in GenCase (70
        // boxes with a side on a snap tie: all upper limits and 67 lower ones are the same).
        Box3 grown;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto dp = static_cast<float>(grid().dp);
            const float low = static_cast<float>(bounds.min[axis]) - dp;
            const float high = static_cast<float>(bounds.max[axis]) + dp;
            const float size = high - low;
            // As fill boxes, it takes in its limits with setboxlimitmode full.
            const double more = state().box_limit_full ? grid().dp : 0;
            grown.min[axis] = low - more;
            grown.max[axis] = static_cast<double>(low) + static_cast<double>(size) + more;
        }
        NodeBox box = whole_lattice(grid());
        SpanSet mask;
        const bool is_box = keeps_boxes(transform);
        if (is_box)
            box = node_box({transform(grown.min), transform(grown.max)});
        else
            mask = mask_of(turned_box(grown.min, grown.max, transform));
        const Node seed = snap(transform((bounds.min + bounds.max) * 0.5), grid());
        FillFilter filter;
        filter.names[static_cast<std::size_t>(MkKind::Void)] = true;
        const std::vector<Spans> filled =
            flood(field_, seed, fillable(filter), box, is_box ? nullptr : &mask, threads_);

        const SpanSet inside = inside_spans(soup, grid(), threads_);
        std::vector<Spans> wrong(filled.size());
        std::vector<Spans> missing(filled.size());
        parallel_for(filled.size(), threads_,
                     [&](std::size_t x)
                     {
                         const Spans empty;
                         const bool has =
                             x >= inside.x_begin && x < inside.x_begin + inside.slabs.size();
                         const Spans& in = has ? inside.slabs[x - inside.x_begin] : empty;
                         wrong[x] = subtract(filled[x], in);
                         missing[x] = subtract(subtract(in, filled[x]), occupied(field_.slabs[x]));
                     });
        const std::uint64_t n_wrong = node_count(wrong);
        const std::uint64_t n_missing = node_count(missing);
        // Nodes near the surface may fall to either side.
        const std::uint64_t n_body = std::max(node_count(filled), node_count(inside.slabs));
        if (100 * (n_wrong + n_missing) > n_body)
            report_.warnings.push_back(
                fmt::format("{}: autofill is a flood from the centre of the bounding box, as in "
                            "GenCase: it filled {} nodes that "
                            "lie outside the body and left out {} inside it. The attribute "
                            "fppg:fill=\"inside\" in place of "
                            "autofill fills the true inside.",
                            place(), n_wrong, n_missing));
        paint_nodes(filled);
    }

    /// Nodes strictly inside a snapped box.
    NodeBox node_box(const BoxRegion& region) const
    {
        const Node a = snap(region.corner0, grid());
        const Node b = snap(region.corner1, grid());
        NodeBox box;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto k = static_cast<std::size_t>(axis);
            box.begin[k] = std::min(a[axis], b[axis]) + 1;
            box.end[k] = std::max(a[axis], b[axis]);
        }
        return intersect(box, whole_lattice(grid()));
    }

    /// The inside of a figure as one entry a slab of the lattice.
    SpanSet mask_of(const FigureOp& figure) const
    {
        SpanSet mask;
        mask.slabs.resize(grid().n[0]);
        const SlabRegion inside = solid_of(figure);
        for (std::uint32_t x = inside.x_begin; x < inside.x_end; ++x)
            mask.slabs[x] = listed(inside, x, false);
        return mask;
    }

    /// The nodes that a redraw may change: a box, and those of `mask` alone where there is one.
    struct Limits
    {
        NodeBox box;
        std::optional<SpanSet> mask;

        std::vector<Spans> kept(std::vector<Spans> nodes) const
        {
            if (mask)
                for (std::size_t x = 0; x < nodes.size(); ++x)
                    nodes[x] = intersect(nodes[x], mask->slabs[x]);
            return nodes;
        }
    };

    Limits limits_of(const std::optional<BoxLimits>& region) const
    {
        Limits limits{whole_lattice(grid()), {}};
        if (!region) return limits;
        if (const auto* box = std::get_if<BoxRegion>(&*region))
            limits.box = node_box(*box);
        else
            limits.mask = mask_of(std::get<FigureOp>(*region));
        return limits;
    }

    /// An index of all columns of a fill's box is kept while it runs.
    void check_columns(const NodeBox& box) const
    {
        if (box.is_empty()) return;
        const double columns = static_cast<double>(box.end[0] - box.begin[0]) *
                               static_cast<double>(box.end[1] - box.begin[1]);
        if (columns * 40 > static_cast<double>(memory_))
            throw CaseError(
                def_.file, op_->source.line,
                fmt::format(
                    "<{}>: the fill reaches over {:g} columns of nodes, more than fit into this "
                    "machine's memory; <fillbox> limits it",
                    op_->source.command, columns));
    }

    std::vector<char> fillable(const FillFilter& filter) const
    {
        std::vector<char> mks = fillable_mks(filter, def_.mk_bound_first);
        if (walls_.has_walls()) count_wall_zones(mks);
        return mks;
    }

    void draw(const FillOp& op)
    {
        NodeBox box = whole_lattice(grid());
        SpanSet mask;
        const SpanSet* mask_used = nullptr;
        if (const auto* region = std::get_if<BoxRegion>(&op.region))
            box = node_box(*region);
        else if (const auto* figure = std::get_if<FigureOp>(&op.region))
        {
            mask = mask_of(*figure);
            mask_used = &mask;
        }
        check_columns(box);
        const Node seed = snap(op.seed, grid());
        const std::vector<Spans> nodes =
            flood(field_, seed, fillable(op.filter), box, mask_used, threads_);
        if (state().draw_points && node_count(nodes) == 0)
            report_.warnings.push_back(fmt::format(
                "{}: the fill added no node: its seed ({:g}, {:g}, {:g}) {}", place(), op.seed.x,
                op.seed.y, op.seed.z, why_nothing_is_filled(seed, box, mask_used)));
        checks_.check_fill(*op_, nodes);
        paint_nodes(nodes);
    }

    std::string why_nothing_is_filled(const Node& seed, const NodeBox& box,
                                      const SpanSet* mask) const
    {
        if (!is_inside(seed, grid()))
            return "is outside the domain; expected a place between <pointmin> and <pointmax>";
        const auto y = static_cast<std::uint32_t>(seed.y);
        const auto z = static_cast<std::uint32_t>(seed.z);
        const auto holds = [&](const auto& s) { return s.y == y && s.z_begin <= z && z < s.z_end; };
        const auto x = static_cast<std::size_t>(seed.x);
        const auto is_in_box = [&](int axis)
        {
            const auto k = static_cast<std::size_t>(axis);
            return box.begin[k] <= seed[axis] && seed[axis] < box.end[k];
        };
        if (!is_in_box(0) || !is_in_box(1) || !is_in_box(2) ||
            (mask != nullptr && std::none_of(mask->slabs[x].begin(), mask->slabs[x].end(), holds)))
            return "is outside the region that limits the fill; expected a place strictly inside "
                   "it";
        const auto run = std::find_if(field_.slabs[x].begin(), field_.slabs[x].end(), holds);
        if (run == field_.slabs[x].end())
            return "is on a node where nothing is drawn, which <modefill> does not name; add void "
                   "there";
        const int mk = run->mk & ~wall_zone_bit;
        const bool is_bound = mk >= def_.mk_bound_first;
        return fmt::format(
            "lies in {} {}, which <modefill> does not name; expected a place in the "
            "empty space to be filled",
            is_bound ? "the solid of mkbound" : "mkfluid",
            mk - (is_bound ? def_.mk_bound_first : def_.mk_fluid_first));
    }

    void draw(const CavityFillOp& op)
    {
        CavityFillReport said;
        try
        {
            const std::vector<Spans> nodes = fill_cavity(field_, op, threads_, said);
            for (const std::string& line : said.log)
                report_.log.push_back(fmt::format("{}: {}", place(), line));
            for (const std::string& w : said.warnings)
                report_.warnings.push_back(fmt::format("{}: {}", place(), w));
            paint_nodes(nodes);
        }
        catch (const GeometryError& e)
        {
            throw GeometryError(fmt::format("{}: {}", place(), e.what()));
        }
    }

    void draw(const RedrawOp& op)
    {
        const Limits limits = limits_of(op.region);
        repaint_nodes(
            limits.kept(redraw_nodes(field_, op, limits.box, def_.mk_bound_first, threads_)));
    }

    void draw(const RedrawNearOp& op)
    {
        const Limits limits = limits_of(op.region);
        for (int i = 0; i < op.times; ++i)
            repaint_nodes(redraw_near_nodes(field_, op, limits.box,
                                            limits.mask ? &*limits.mask : nullptr,
                                            def_.mk_bound_first, threads_));
    }

    void draw(const ResetOp&)
    {
        for (auto& slab : field_.slabs) slab.clear();
        walls_.reset();
        free_.reset();
    }

    void draw(const ShapeOutOp&) {}

    void draw(const CellsOutOp& op)
    {
        NodeFile file;
        file.name = "_" + op.file + "_MkCells" + op.suffix + ".vtk";
        file.is_cells = true;
        file.cells = plain_nodes(field_, threads_);
        file.mk = op.mk;
        keep(std::move(file));
    }

    void draw(const PointsMkOutOp& op)
    {
        NodeFile file;
        file.name = fmt::format("_{}_mk{}.vtk", op.file, state().mk.mk);
        file.points = border_nodes(field_, state().mk.mk);
        keep(std::move(file));
    }

    void keep(NodeFile file)
    {
        std::erase_if(report_.node_files, [&](const NodeFile& f) { return f.name == file.name; });
        report_.node_files.push_back(std::move(file));
    }

    const CaseDef& def_;
    int threads_;
    LatticeReport& report_;
    DrawChecks checks_;
    RunField field_;
    WallPainter walls_;
    FreePainter free_;
    const DrawOp* op_ = nullptr;
    bool fits_walls_ = true;
    std::atomic<std::uint64_t> runs_ = 0;
    std::uint64_t memory_ = available_memory();
    std::uint64_t run_limit_ = memory_ / 5 * 4 / sizeof(Run);
    struct ReadMesh
    {
        std::string name;
        MeshReading reading;
        MeshFile mesh;
    };
    std::deque<ReadMesh> meshes_;
};

} // namespace

RunField generate_lattice(const CaseDef& def, int threads, const LatticeProgress& progress,
                          LatticeReport& report)
{
    Generator generator(def, threads, report);
    for (std::size_t i = 0; i < def.ops.size(); ++i)
    {
        if (progress) progress(i, def.ops.size());
        generator.run(i);
    }
    return generator.take();
}

} // namespace fppg
