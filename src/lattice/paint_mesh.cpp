// Mesh files on the lattice and off it.
#include "lattice/paint_mesh.h"

#include "fppg/domain_clip.h"
#include "fppg/error.h"
#include "fppg/shapes.h"

#include "core/parallel.h"
#include "lattice/depth_region.h"
#include "lattice/paint_off_lattice.h"
#include "meshes/mesh_library.h"
#include "meshes/repaired_solid.h"
#include "nodes/snap.h"
#include "scene/surfaces.h"
#include "shapes/file_polygons.h"
#include "shapes/off_lattice_parts.h"
#include "shapes/plane_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace fppg
{
namespace
{

constexpr std::size_t facets_per_chunk = 4096;

void note_use(Painting& painting, const SourceRef& source, const std::string& name,
              const std::string& path)
{
    std::vector<MeshFileUse>& uses = painting.report.mesh_files;
    const auto is_it = [&](const MeshFileUse& use) { return use.name == name; };
    if (name.empty() || std::any_of(uses.begin(), uses.end(), is_it)) return;
    uses.push_back({name, painting.scene.meshes->find(source, path), source.line});
}

const MeshFile& joined_file(Painting& painting, const Brush& brush, const MeshFileOp& op,
                            const std::string& other)
{
    MeshFileOp joined = op;
    joined.file = other;
    return mesh_of(painting, brush, joined);
}

/// A file drawn by its depth, with the others of its mesh. `moved` is its own surface.
void paint_by_depth(Painting& painting, const Brush& brush, const MeshFileOp& op,
                    TriangleSoup moved)
{
    const int threads = painting.canvas.threads();
    for (const std::string& other : op.joined)
    {
        const TriangleSoup more =
            moved_soup(joined_file(painting, brush, op, other).soup, op.transform, threads);
        moved.vertices.insert(moved.vertices.end(), more.vertices.begin(), more.vertices.end());
    }
    if (brush.state->normal_invert) turn_over(moved);
    painting.canvas.paint(brush, depth_region(moved, op, painting.grid(), threads));
}

/// A file as a solid, for fppg:fill and for what is said of advanced mode; nothing for other draws.
std::optional<SurfaceMesh> check_solid(Painting& painting, const Brush& brush, const MeshFileOp& op,
                                       const TriangleSoup& moved)
{
    MeshReport repairs;
    std::optional<SurfaceMesh> solid;
    if (op.fill_inside || op.advanced)
        solid = repaired_solid(moved, painting.grid().dp, painting.canvas.threads(), repairs);
    painting.checks.check_closed(*brush.source, op, moved, repairs);
    return solid;
}

/// The inside of a file as of a fitted body: of the repaired mesh (facets that face inwards, copies
/// and what lies inside another part count as there).
void paint_inside(Painting& painting, const Brush& brush, const std::optional<SurfaceMesh>& solid)
{
    if (solid)
        painting.canvas.paint(brush, region_of(inside_spans(soup_of(*solid), painting.grid(),
                                                            painting.canvas.threads())));
}

/// The sides of all triangles and quads, as lines; but the triangles of bent quads in
/// bathymetries are painted (GenCase v5.4.354: a peak on 3 x 3 quads, two random ones).
void paint_wire(Painting& painting, const Brush& brush, const MeshFileOp& op, const MeshFile& file)
{
    const LatticeGrid& grid = painting.grid();
    std::vector<std::pair<Node, Node>> segments;
    std::vector<SnappedTriangle> triangles;
    for_each_polygon(file, op, grid.dp,
                     [&](const std::vector<std::uint32_t>& corners)
                     {
                         std::vector<Node> nodes;
                         for (const std::uint32_t v : corners)
                             nodes.push_back(snap(op.transform(file.soup.vertices[v]), grid));
                         if (has_heights(op.reading.format) && nodes.size() == 3)
                             triangles.push_back({nodes[0], nodes[1], nodes[2]});
                         else
                             for (std::size_t i = 0; i < nodes.size(); ++i)
                                 segments.emplace_back(nodes[i], nodes[(i + 1) % nodes.size()]);
                     });
    if (!triangles.empty()) paint_triangles(painting, brush, std::move(triangles));
    painting.canvas.paint(brush, lines_region(segments, grid, brush.state->constants.line));
}

/// The triangles and quads of a file, or their sides, off the lattice.
void paint_off_lattice_mesh(Painting& painting, const Brush& brush, const MeshFileOp& op,
                            const MeshFile& file)
{
    PolyhedronOp polyhedron;
    polyhedron.vertices = moved_soup(file.soup, op.transform, painting.canvas.threads()).vertices;
    for_each_polygon(file, op, painting.grid().dp,
                     [&](std::vector<std::uint32_t> corners) {
                         polyhedron.faces.push_back({std::move(corners), true, {}, 0, {}});
                     });
    if (brush.state->mode == DrawMode::Wire)
        paint_off_lattice_wire(painting, brush, polyhedron);
    else
        // With the placement of the file, which is a part of the matrix then.
        paint_off_lattice_pieces(painting, brush,
                                 off_lattice_pieces(polyhedron, op.transform, painting.grid()));
}

std::vector<SnappedTriangle> snapped_facets(const Painting& painting, const MeshFileOp& op,
                                            const TriangleSoup& source)
{
    std::vector<SnappedTriangle> triangles(source.size());
    parallel_for(
        source.size(), painting.canvas.threads(),
        [&](std::size_t t)
        {
            const auto corner = [&](std::size_t i)
            { return snap(op.transform(source.vertices[3 * t + i]), painting.grid()); };
            triangles[t] = {corner(0), corner(1), corner(2)};
        },
        facets_per_chunk);
    return triangles;
}

/// A file off the lattice.
void paint_off_lattice_file(Painting& painting, const Brush& brush, const MeshFileOp& op,
                            const MeshFile& file)
{
    paint_off_lattice_mesh(painting, brush, op, file);
    const TriangleSoup moved = moved_soup(file.soup, op.transform, painting.canvas.threads());
    if (op.fill_inside) paint_inside(painting, brush, check_solid(painting, brush, op, moved));
    if (op.autofill) autofill(painting, brush, op, file, moved);
}

/// A file on the lattice.
void paint_on_lattice(Painting& painting, const Brush& brush, const MeshFileOp& op,
                      const MeshFile& file)
{
    const int threads = painting.canvas.threads();
    if (!op.advanced && !op.fill_inside && brush.state->mode == DrawMode::Wire)
    {
        paint_wire(painting, brush, op, file);
        if (op.autofill)
            autofill(painting, brush, op, file, moved_soup(file.soup, op.transform, threads));
        return;
    }
    // The corners themselves are needed for the inside only.
    TriangleSoup moved;
    std::optional<SurfaceMesh> solid;
    if (op.advanced || op.fill_inside || op.autofill)
    {
        moved = moved_soup(file.soup, op.transform, threads);
        solid = check_solid(painting, brush, op, moved);
    }
    if (op.advanced)
    {
        paint_by_depth(painting, brush, op, std::move(moved));
        return;
    }
    if (op.fill_inside) paint_inside(painting, brush, solid);
    paint_triangles(painting, brush, snapped_facets(painting, op, file.soup));
    if (op.autofill && !op.fill_inside) autofill(painting, brush, op, file, moved);
}

void paint_as_one(Painting& painting, const Brush& brush, const MeshFileOp& op,
                  const MeshFile& file)
{
    if (!op.advanced) paint_points_and_lines(painting, brush, file, op.transform);
    if (has_heights(op.reading.format) && brush.state->off_lattice)
        paint_off_lattice_heights(painting, brush, op, file);
    else if (!op.advanced && brush.state->off_lattice)
        paint_off_lattice_file(painting, brush, op, file);
    else
        paint_on_lattice(painting, brush, op, file);
}

/// Draws the parts of a mesh file under setmknextauto, which are those that reading the case
/// counts, and counts them too.
class PartPainter
{
public:
    PartPainter(Painting& painting, const Brush& brush, const MeshFileOp& op)
        : painting_(painting), brush_(brush), op_(op)
    {
    }

    void run(const MeshFile& file)
    {
        if (!op_.advanced) paint_points_and_lines_of(file);
        const TriangleSoup moved = moved_soup(file.soup, op_.transform, painting_.canvas.threads());
        for_each_polygon(file, op_, painting_.grid().dp,
                         [&](const std::vector<std::uint32_t>& corners)
                         {
                             if (op_.advanced)
                                 count(corners);
                             else
                                 paint_polygon(moved, corners);
                         });
        for (const std::string& other : op_.joined)
            for_each_polygon(joined_file(painting_, brush_, op_, other), op_, painting_.grid().dp,
                             [&](const std::vector<std::uint32_t>& corners) { count(corners); });
        if (op_.advanced || op_.autofill) check_solid(painting_, brush_, op_, moved);
        if (op_.advanced)
            paint_by_depth(painting_, brush_.of_part(part_), op_, moved);
        else if (op_.autofill)
            autofill(painting_, brush_.of_part(part_), op_, file, moved);
    }

private:
    bool is_wire() const { return brush_.state->mode == DrawMode::Wire; }

    void count(const std::vector<std::uint32_t>& corners)
    {
        part_ += is_wire() ? static_cast<std::uint32_t>(corners.size()) : 1;
    }

    void paint_side(const Vec3& from, const Vec3& to)
    {
        paint(painting_, brush_.of_part(part_++), LinesOp{{{from, to}}});
    }

    void paint_points_and_lines_of(const MeshFile& file)
    {
        MeshFile points;
        points.points = file.points;
        fppg::paint_points_and_lines(painting_, brush_, points, op_.transform);
        for (const std::vector<Vec3>& line : file.lines)
        {
            ++part_; // the first point, which the first segment draws again
            for (std::size_t i = 1; i < line.size(); ++i)
                paint_side(op_.transform(line[i - 1]), op_.transform(line[i]));
        }
    }

    void paint_polygon(const TriangleSoup& moved, const std::vector<std::uint32_t>& corners)
    {
        PolyhedronOp face;
        for (const std::uint32_t v : corners) face.vertices.push_back(moved.vertices[v]);
        if (is_wire())
        {
            for (std::size_t i = 0; i < corners.size(); ++i)
                paint_side(face.vertices[i], face.vertices[(i + 1) % corners.size()]);
            return;
        }
        face.faces.push_back({{0, 1, 2}, true, {}, 0, {}});
        if (corners.size() == 4) face.faces[0].vertices.push_back(3);
        paint(painting_, brush_.of_part(part_++), face);
    }

    Painting& painting_;
    const Brush& brush_;
    const MeshFileOp& op_;
    std::uint32_t part_ = 0;
};

void paint_file(Painting& painting, const Brush& brush, const MeshFileOp& op, const MeshFile& file)
{
    if (!brush.state->mk_next_auto)
        paint_as_one(painting, brush, op, file);
    else if (has_heights(op.reading.format))
        paint_heights_in_parts(painting, brush, op, file);
    else
        PartPainter(painting, brush, op).run(file);
}

[[noreturn]] void fail(const Painting& painting, const Brush& brush, const std::string& text)
{
    throw CaseError(painting.def.file, brush.source->line,
                    fmt::format("<{}>: {}", brush.source->command, text));
}

/// Draws what `<clipdomain>` leaves of a file: its triangles cut at the grown domain.
void paint_clipped(Painting& painting, const Brush& brush, const MeshFileOp& op)
{
    if (op.fill_inside)
        fail(painting, brush,
             "fppg:fill=\"inside\" is not possible together with <clipdomain>, which opens the "
             "surface");
    const CaseDef& def = painting.def;
    const Box3 box = clip_box(def.case_pos_min, def.case_pos_max, *op.clip_resize);
    for (int axis = 0; axis < 3; ++axis)
        if (box.min[axis] > box.max[axis])
            fail(painting, brush,
                 fmt::format("<clipdomain resize=\"{:g}\">: nothing is left of the domain along {}",
                             *op.clip_resize, "xyz"[axis]));
    // With advanced GenCase draws all of the file nevertheless; where nothing of a PLY file is
    // left it refuses many cases, but not all under a turn (3 of 6), so fppg refuses none.
    MeshFileOp whole = op;
    whole.reading = reading_to_clip(op.reading);
    const MeshFile& file = mesh_of(painting, brush, whole);
    if (op.advanced || is_within(file, op.transform, box))
    {
        paint_file(painting, brush, op, mesh_of(painting, brush, op));
        return;
    }
    const MeshFile cut = clip_to_box(file, op.transform, box, op.reading);
    // GenCase passes over this for the other formats.
    if (op.reading.format == MeshFormat::Ply && cut.soup.vertices.empty())
        fail(painting, brush,
             fmt::format("{}: <clipdomain> leaves nothing of it, expected that it reaches into the "
                         "domain",
                         op.file));
    paint_file(painting, brush, op, cut);
}

} // namespace

const MeshFile& mesh_of(Painting& painting, const Brush& brush, const MeshFileOp& op)
{
    const LibraryMesh& read =
        painting.scene.meshes->read(*brush.source, op.file, op.reading, painting.canvas.threads());
    if (painting.used.insert(&read.mesh).second)
    {
        note_use(painting, *brush.source, op.container, op.container);
        note_use(painting, *brush.source, op.file, read.path);
        for (const std::string& w : read.mesh.warnings)
            painting.report.warnings.push_back(
                fmt::format("{}: {}: {}", place_of(painting.def, *brush.source), read.path, w));
    }
    return read.mesh;
}

void check_mesh(Painting& painting, const DrawOp& draw, const MeshFile& file,
                const Transform& transform)
{
    Box3 bounds;
    for (const Vec3& p : file.points) bounds.add(transform(p));
    for (const std::vector<Vec3>& line : file.lines)
        for (const Vec3& p : line) bounds.add(transform(p));
    for (const Vec3& v : file.soup.vertices) bounds.add(transform(v));
    painting.checks.check_shape(draw, bounds);
}

TriangleSoup moved_soup(const TriangleSoup& source, const Transform& transform, int threads)
{
    TriangleSoup moved;
    moved.vertices.resize(source.vertices.size());
    parallel_for(
        moved.vertices.size(), threads,
        [&](std::size_t i) { moved.vertices[i] = transform(source.vertices[i]); },
        facets_per_chunk);
    return moved;
}

void turn_over(TriangleSoup& soup)
{
    for (std::size_t t = 0; t < soup.size(); ++t)
        std::swap(soup.vertices[3 * t + 1], soup.vertices[3 * t + 2]);
}

void paint_points_and_lines(Painting& painting, const Brush& brush, const MeshFile& file,
                            const Transform& transform)
{
    std::vector<Vec3> points;
    for (const Vec3& p : file.points) points.push_back(transform(p));
    if (!points.empty()) paint(painting, brush, PointsOp{std::move(points)});
    LinesOp lines;
    for (const std::vector<Vec3>& line : file.lines)
        for (std::size_t i = 1; i < line.size(); ++i)
            lines.segments.emplace_back(transform(line[i - 1]), transform(line[i]));
    if (!lines.segments.empty()) paint(painting, brush, lines);
}

void paint(Painting& painting, const Brush& brush, const MeshFileOp& op)
{
    if (op.is_drawn_before) return;
    if (op.clip_resize)
        paint_clipped(painting, brush, op);
    else
        paint_file(painting, brush, op, mesh_of(painting, brush, op));
}

} // namespace fppg
