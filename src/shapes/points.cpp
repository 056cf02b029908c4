#include "shapes/kinds.h"

namespace fppg::kinds
{

Box3 bounds_of(const PointsOp& points, double)
{
    Box3 box;
    for (const Vec3& p : points.points) box.add(p);
    return box;
}

Box3 bounds_of(const LinesOp& lines, double)
{
    Box3 box;
    for (const auto& [from, to] : lines.segments)
    {
        box.add(from);
        box.add(to);
    }
    return box;
}

void add_cells(const LinesOp& lines, CellList& out)
{
    for (const auto& [from, to] : lines.segments)
        out.add_line(out.context.place(from), out.context.place(to));
}

} // namespace fppg::kinds
