#include "boolean/line_crossings.h"

#include "core/predicates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fppg
{
namespace
{

int turn(const LinesInPlane& in, std::uint32_t a, std::uint32_t b, std::uint32_t p)
{
    const auto& v = in.vertices;
    return orient2d(v[a][in.u], v[a][in.v], v[b][in.u], v[b][in.v], v[p][in.u], v[p][in.v]);
}

bool do_cross(const LinesInPlane& in, const Piece& a, const Piece& b)
{
    if (a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to) return false;
    return turn(in, a.from, a.to, b.from) * turn(in, a.from, a.to, b.to) < 0 &&
           turn(in, b.from, b.to, a.from) * turn(in, b.from, b.to, a.to) < 0;
}

Vec3 crossing_of(const LinesInPlane& in, const Piece& a, const Piece& b)
{
    const auto& v = in.vertices;
    const Vec3 along = v[a.to] - v[a.from], other = v[b.to] - v[b.from],
               away = v[b.from] - v[a.from];
    const double det = along[in.u] * other[in.v] - along[in.v] * other[in.u];
    const double t = (away[in.u] * other[in.v] - away[in.v] * other[in.u]) / det;
    return v[a.from] + std::clamp(std::isfinite(t) ? t : 0.5, 0.0, 1.0) * along;
}

struct Range
{
    double low_u, high_u, low_v, high_v;
    std::uint32_t piece;
};

} // namespace

std::vector<LineCrossing> find_crossings(const LinesInPlane& lines,
                                         const std::vector<std::uint32_t>& among)
{
    const int u = lines.u, v = lines.v;
    std::vector<Range> ranges;
    for (const std::uint32_t p : among)
    {
        const Vec3 &a = lines.vertices[lines.pieces[p].from],
                   &b = lines.vertices[lines.pieces[p].to];
        ranges.push_back({std::min(a[u], b[u]), std::max(a[u], b[u]), std::min(a[v], b[v]),
                          std::max(a[v], b[v]), p});
    }
    std::sort(ranges.begin(), ranges.end(),
              [](const Range& a, const Range& b)
              { return a.low_u != b.low_u ? a.low_u < b.low_u : a.piece < b.piece; });
    std::vector<LineCrossing> found;
    for (std::size_t i = 0; i < ranges.size(); ++i)
        for (std::size_t j = i + 1; j < ranges.size() && ranges[j].low_u <= ranges[i].high_u; ++j)
        {
            if (ranges[j].low_v > ranges[i].high_v || ranges[j].high_v < ranges[i].low_v) continue;
            const auto [a, b] = std::minmax(ranges[i].piece, ranges[j].piece);
            if (do_cross(lines, lines.pieces[a], lines.pieces[b]))
                found.push_back({a, b, crossing_of(lines, lines.pieces[a], lines.pieces[b])});
        }
    std::sort(found.begin(), found.end(),
              [](const LineCrossing& a, const LineCrossing& b)
              { return std::pair(a.a, a.b) < std::pair(b.a, b.b); });
    return found;
}

} // namespace fppg
