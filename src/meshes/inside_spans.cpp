#include "fppg/shapes.h"

#include "meshes/column_spans.h"

namespace fppg
{

namespace
{

/// Six times the signed volume, about a corner of the mesh so that distance does not blur it.
double signed_volume(const TriangleSoup& soup)
{
    double sum = 0;
    for (std::size_t i = 0; i < soup.size(); ++i)
    {
        const Vec3 a = soup.vertices[3 * i] - soup.vertices[0];
        const Vec3 b = soup.vertices[3 * i + 1] - soup.vertices[0];
        const Vec3 c = soup.vertices[3 * i + 2] - soup.vertices[0];
        sum += dot(a, cross(b, c));
    }
    return sum;
}

} // namespace

SpanSet inside_spans(const TriangleSoup& soup, const LatticeGrid& grid, int threads)
{
    ColumnOptions options;
    options.flip = signed_volume(soup) < 0 ? -1 : 1;
    return cut_columns(soup, grid, options, threads).inside;
}

} // namespace fppg
