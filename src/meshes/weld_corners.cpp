#include "meshes/weld_corners.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "meshes/mesh_facets.h"

namespace fppg
{

namespace
{

/// Numbers places in the order in which they come, equal ones by one number.
class PlaceNumbers
{
public:
    explicit PlaceNumbers(std::vector<Vec3>& places) : places_(places) {}

    std::uint32_t number_of(const Vec3& place)
    {
        if (2 * places_.size() >= slots_.size()) grow();
        // Zero has no sign then.
        const Vec3 p = place + Vec3{0.0, 0.0, 0.0};
        std::uint32_t& slot = slot_of(p);
        if (slot == no_index)
        {
            slot = static_cast<std::uint32_t>(places_.size());
            places_.push_back(p);
        }
        return slot;
    }

private:
    /// The number of a place that is here, or where that of a new one goes.
    std::uint32_t& slot_of(const Vec3& p)
    {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9E3779B97F4A7C15;
            hash ^= hash >> 32;
        }
        std::size_t at = hash & (slots_.size() - 1);
        while (slots_[at] != no_index && !is_at(slots_[at], p)) at = (at + 1) & (slots_.size() - 1);
        return slots_[at];
    }

    bool is_at(std::uint32_t number, const Vec3& p) const
    {
        const Vec3& there = places_[number];
        return there.x == p.x && there.y == p.y && there.z == p.z;
    }

    void grow()
    {
        slots_.assign(std::max<std::size_t>(2 * slots_.size(), 64), no_index);
        for (std::uint32_t i = 0; i < places_.size(); ++i) slot_of(places_[i]) = i;
    }

    std::vector<Vec3>& places_;
    std::vector<std::uint32_t> slots_; ///< a power of two, no more than half of them taken
};

} // namespace

void weld_equal(const TriangleSoup& soup, SurfaceMesh& mesh)
{
    PlaceNumbers numbers(mesh.vertices);
    mesh.facets.resize(soup.size());
    for (std::size_t i = 0; i < soup.vertices.size(); ++i)
        mesh.facets[i / 3][i % 3] = numbers.number_of(soup.vertices[i]);
}

void weld_near(double distance, const std::vector<char>& may_move, SurfaceMesh& mesh)
{
    const auto cell_of = [&](const Vec3& p, int axis)
    { return static_cast<std::int64_t>(std::floor(std::clamp(p[axis] / distance, -9e18, 9e18))); };
    const auto key_of = [](std::int64_t i, std::int64_t j, std::int64_t k)
    {
        return static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15 ^
               static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4F ^
               static_cast<std::uint64_t>(k) * 0x165667B19E3779F9;
    };
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> places;
    std::vector<std::uint32_t> index(mesh.vertices.size());
    std::vector<Vec3> kept;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    {
        const Vec3& p = mesh.vertices[v];
        if (!may_move.empty() && may_move[v] == 0)
        {
            index[v] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(p);
            continue;
        }
        const std::int64_t i = cell_of(p, 0), j = cell_of(p, 1), k = cell_of(p, 2);
        std::uint32_t best = no_index;
        double best_distance = distance;
        for (std::int64_t cell = 0; cell < 27; ++cell)
        {
            const auto found =
                places.find(key_of(i + cell % 3 - 1, j + cell / 3 % 3 - 1, k + cell / 9 - 1));
            if (found == places.end()) continue;
            for (const std::uint32_t other : found->second)
            {
                const double d = norm(kept[other] - p);
                if (d < best_distance || (d == best_distance && other < best))
                {
                    best = other;
                    best_distance = d;
                }
            }
        }
        if (best == no_index)
        {
            best = static_cast<std::uint32_t>(kept.size());
            places[key_of(i, j, k)].push_back(best);
            kept.push_back(p);
        }
        index[v] = best;
    }
    mesh.vertices = std::move(kept);
    for (Facet& facet : mesh.facets)
        for (std::uint32_t& corner : facet) corner = index[corner];
}

} // namespace fppg
