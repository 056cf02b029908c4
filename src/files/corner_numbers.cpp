#include "files/corner_numbers.h"

#include <cassert>
#include <cstring>
#include <unordered_map>

namespace fppg
{
namespace
{

struct Corner
{
    std::uint32_t object_id;
    std::array<float, 3> place;

    bool operator==(const Corner&) const = default;
};

struct CornerHash
{
    std::size_t operator()(const Corner& c) const
    {
        std::uint64_t hash = c.object_id;
        for (const float coordinate : c.place)
        {
            // Adding zero makes one of the two zeros, which are equal.
            const float value = coordinate + 0.0F;
            std::uint32_t bits = 0;
            std::memcpy(&bits, &value, sizeof bits);
            hash = (hash ^ bits) * 0x9E3779B97F4A7C15U;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

} // namespace

CornerNumbers number_corners(const std::vector<ShapePolygons>& shapes)
{
    CornerNumbers out;
    constexpr std::uint32_t none = UINT32_MAX;
    for (const ShapePolygons& shape : shapes) out.numbers.emplace_back(shape.vertices.size(), none);
    std::unordered_map<Corner, std::uint32_t, CornerHash> known;
    const auto number_one = [&](std::size_t s, std::uint32_t v)
    {
        assert(v < shapes[s].vertices.size());
        std::uint32_t& number = out.numbers[s][v];
        if (number != none) return;
        const Vec3& p = shapes[s].vertices[v];
        const std::array<float, 3> place{static_cast<float>(p.x), static_cast<float>(p.y),
                                         static_cast<float>(p.z)};
        const auto next = static_cast<std::uint32_t>(out.places.size());
        const auto [known_one, is_new] = known.try_emplace({shapes[s].object_id, place}, next);
        number = known_one->second;
        if (is_new) out.places.push_back(place);
    };
    for (std::size_t kind = 0; kind < 3; ++kind)
        for (std::size_t s = 0; s < shapes.size(); ++s)
            for (const std::vector<std::uint32_t>& cell : shapes[s].polygons)
            {
                if (cell_kind(cell.size()) != kind) continue;
                for (const std::uint32_t v : cell) number_one(s, v);
            }
    return out;
}

} // namespace fppg
