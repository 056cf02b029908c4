#include "lattice/draw_pattern.h"

#include <algorithm>

namespace fppg
{
namespace
{

/// Where index n lies in the pattern along an axis: the cell, `size` on the border.
struct AxisPlace
{
    std::uint32_t cell = 0;
    std::uint32_t left = 0; ///< nodes from n on that lie in the same cell or border
};

AxisPlace place_of(const DrawPattern& pattern, std::size_t axis, std::uint32_t n)
{
    const std::uint32_t inner = pattern.size[axis] * pattern.scale[axis];
    const std::uint32_t extent = inner + pattern.border[axis];
    const std::uint32_t q = (n % extent + (extent - pattern.gap[axis])) % extent;
    if (q >= inner) return {pattern.size[axis], extent - q};
    const std::uint32_t cell = q / pattern.scale[axis];
    return {cell, (cell + 1) * pattern.scale[axis] - q};
}

void append(Spans& spans, const Span& s)
{
    if (!spans.empty() && spans.back().y == s.y && spans.back().z_end == s.z_begin)
        spans.back().z_end = s.z_end;
    else
        spans.push_back(s);
}

} // namespace

PatternSplit split_by_pattern(const DrawPattern& pattern, const Spans& spans, std::uint32_t x)
{
    PatternSplit out;
    const auto& [n_x, n_y, n_z] = pattern.size;
    const std::uint32_t cell_x = place_of(pattern, 0, x).cell;
    for (const Span& s : spans)
    {
        const std::uint32_t cell_y = place_of(pattern, 1, s.y).cell;
        const bool is_border = cell_x == n_x || cell_y == n_y;
        for (std::uint32_t z = s.z_begin; z < s.z_end;)
        {
            const AxisPlace place = place_of(pattern, 2, z);
            const std::uint32_t end = std::min(s.z_end, z + place.left);
            const bool is_drawn =
                !is_border && place.cell < n_z &&
                pattern.cells[cell_x + std::size_t{n_x} * (cell_y + std::size_t{n_y} * place.cell)];
            append(is_drawn ? out.drawn : out.left_out, {s.y, z, end});
            z = end;
        }
    }
    return out;
}

} // namespace fppg
