#include "fppg/shapes.h"

#include "core/parallel.h"
#include "lattice/fill_level.h"
#include "lattice/flood.h"
#include "lattice/limits.h"
#include "lattice/paint_mesh.h"
#include "scene/surfaces.h"
#include "shapes/polyhedra.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{
namespace
{

/// The limits of the flood: the strict interior of the box grown by dp, in float as in GenCase (70
/// boxes with a side on a snap tie: all upper limits and 67 lower ones are the same).
Box3 grown_box(const Box3& bounds, double wide, bool takes_limits_in)
{
    Box3 grown;
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto dp = static_cast<float>(wide);
        const float low = static_cast<float>(bounds.min[axis]) - dp;
        const float high = static_cast<float>(bounds.max[axis]) + dp;
        const float size = high - low;
        // As fill boxes, it takes in its limits with setboxlimitmode full.
        const double more = takes_limits_in ? wide : 0;
        grown.min[axis] = low - more;
        grown.max[axis] = static_cast<double>(low) + static_cast<double>(size) + more;
    }
    return grown;
}

/// Says where the flood differs from the inside of the surface.
void compare_with_inside(Painting& painting, const Brush& brush, const TriangleSoup& moved,
                         const std::vector<Spans>& filled)
{
    const Canvas& canvas = painting.canvas;
    const SpanSet inside = inside_spans(moved, painting.grid(), canvas.threads());
    std::vector<Spans> wrong(filled.size());
    std::vector<Spans> missing(filled.size());
    parallel_for(
        filled.size(), canvas.threads(),
        [&](std::size_t x)
        {
            const Spans empty;
            const bool has = x >= inside.x_begin && x < inside.x_begin + inside.slabs.size();
            const Spans& in = has ? inside.slabs[x - inside.x_begin] : empty;
            wrong[x] = subtract(filled[x], in);
            missing[x] = subtract(subtract(in, filled[x]), occupied(canvas.field().slabs[x]));
        });
    const std::uint64_t n_wrong = node_count(wrong);
    const std::uint64_t n_missing = node_count(missing);
    // Nodes near the surface may fall to either side.
    const std::uint64_t n_body = std::max(node_count(filled), node_count(inside.slabs));
    if (100 * (n_wrong + n_missing) <= n_body) return;
    painting.report.warnings.push_back(
        fmt::format("{}: autofill is a flood from the centre of the bounding box, as in "
                    "GenCase: it filled {} nodes that "
                    "lie outside the body and left out {} inside it. The attribute "
                    "fppg:fill=\"inside\" in place of "
                    "autofill fills the true inside.",
                    place_of(painting.def, *brush.source), n_wrong, n_missing));
}

} // namespace

void autofill(Painting& painting, const Brush& brush, const MeshFileOp& op, const MeshFile& file,
              const TriangleSoup& moved)
{
    Box3 bounds;
    for (const Vec3& p : file.points) bounds.add(p);
    for (const std::vector<Vec3>& line : file.lines)
        for (const Vec3& p : line) bounds.add(p);
    for (const Vec3& v : file.soup.vertices) bounds.add(v);
    if (bounds.is_empty()) return;
    // A file in one plane across an axis is not filled (GenCase v5.4.354: flat rings across x,
    // y and z, in 2D and 3D; one bent by 1e-9 m, or what a clipdomain leaves beyond the plane
    // of a 2D case by 1e-17 m, is).
    for (int axis = 0; axis < 3; ++axis)
        if (bounds.min[axis] == bounds.max[axis]) return;
    const LatticeGrid& grid = painting.grid();
    const Box3 grown = grown_box(bounds, grid.dp, brush.state->box_limit_full);
    Limits limits{whole_lattice(grid), {}};
    if (keeps_boxes(op.transform))
        limits.box = node_box({op.transform(grown.min), op.transform(grown.max)}, grid);
    else
        limits.mask = mask_of(painting, brush, turned_box(grown.min, grown.max, op.transform));
    const Node seed = snap(op.transform((bounds.min + bounds.max) * 0.5), grid);
    FillFilter filter;
    filter.names[static_cast<std::size_t>(MkKind::Void)] = true;
    const Canvas& canvas = painting.canvas;
    const std::vector<Spans> filled =
        flood(canvas.field(), seed, fillable_mks(filter, painting.def.mk_bound_first), limits.box,
              limits.mask_used(), canvas.threads());
    compare_with_inside(painting, brush, moved, filled);
    painting.canvas.paint(brush, filled);
}

} // namespace fppg
