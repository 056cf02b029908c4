#include "meshes/open_edges.h"

#include "fppg/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace fppg
{

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

} // namespace fppg
