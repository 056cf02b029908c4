#include "meshes/inside_test.h"

#include <array>
#include <cmath>

namespace fppg
{

std::optional<int> winding_by_lines(const MeshQuery& query, const Vec3& p,
                                    const std::function<bool(std::uint32_t)>& counts)
{
    std::array<int, 3> sums{};
    std::size_t n = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const LineSums line = query.line_sums(p, axis, counts);
        if (line.before + line.behind != 0) continue;
        for (std::size_t i = 0; i < n; ++i)
            if (sums[i] == line.before) return line.before;
        sums[n++] = line.before;
    }
    return {};
}

int InsideTest::winding(const Vec3& p) const
{
    if (const std::optional<int> winding = winding_by_lines(query_, p)) return *winding;
    std::call_once(needs_tree_, [&] { tree_ = std::make_unique<WindingTree>(query_.soup()); });
    return static_cast<int>(std::lround(tree_->winding_number(p)));
}

} // namespace fppg
