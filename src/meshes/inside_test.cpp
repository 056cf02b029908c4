#include "meshes/inside_test.h"

#include <array>
#include <cmath>

namespace fppg
{

int InsideTest::winding(const Vec3& p) const
{
    std::array<int, 3> sums{};
    std::size_t n = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const LineSums line = query_.line_sums(p, axis);
        if (line.before + line.behind != 0) continue;
        for (std::size_t i = 0; i < n; ++i)
            if (sums[i] == line.before) return line.before;
        sums[n++] = line.before;
    }
    std::call_once(needs_tree_, [&] { tree_ = std::make_unique<WindingTree>(query_.soup()); });
    return static_cast<int>(std::lround(tree_->winding_number(p)));
}

} // namespace fppg
