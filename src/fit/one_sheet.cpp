#include "fppg/one_sheet.h"

#include "core/parallel.h"
#include "meshes/mesh_query.h"
#include "meshes/point_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace fppg
{
namespace
{

/// Two particles on either side of a plate lie up to this far apart, dp: its thickness and half a
/// spacing along it.
constexpr double sheet_reach_dp = 1.2;
/// A plate this much thinner than the thickness still has it: coordinates of files are rounded.
constexpr double rounding_of_thickness = 1e-4;
/// Tells the sides of a surface that faces itself; no plane of a drawing is likely to contain it.
constexpr Vec3 staying_side{0.36, 0.48, 0.8};
/// A corner of a plate lies this far from the nearest particle on its sides, dp.
constexpr double rim_reach_dp = 2;

/// Smooth parts of a surface: facets joined by edges that are no features.
struct SmoothParts
{
    std::vector<std::uint32_t> of_facet;
    std::vector<double> areas;
};

SmoothParts smooth_parts(const SurfaceMesh& mesh, const Features& features)
{
    SmoothParts parts;
    parts.of_facet.assign(mesh.facets.size(), no_index);
    std::vector<std::uint32_t> open;
    for (std::uint32_t first = 0; first < mesh.facets.size(); ++first)
    {
        if (parts.of_facet[first] != no_index) continue;
        const auto part = static_cast<std::uint32_t>(parts.areas.size());
        parts.areas.push_back(0);
        parts.of_facet[first] = part;
        open.push_back(first);
        while (!open.empty())
        {
            const std::uint32_t f = open.back();
            open.pop_back();
            parts.areas[part] += mesh.areas[f];
            for (std::size_t side = 0; side < 3; ++side)
            {
                const std::uint32_t next = mesh.neighbours[f][side];
                if (next == no_index || parts.of_facet[next] != no_index ||
                    features.is_feature_edge[mesh.facet_edges[f][side]])
                    continue;
                parts.of_facet[next] = part;
                open.push_back(next);
            }
        }
    }
    return parts;
}

/// Coarse cells with the directions of the surface in and around them. Where those of each part
/// are within 30 degrees of one, and these within 30 of the first, all are within 60 degrees of it:
/// no two face away from each other, and no sheet lies behind another.
class FacingCells
{
public:
    explicit FacingCells(double reach) : reach_(reach), side_(cell_reaches * reach) {}

    /// A surface with unit normal n at p, which counts in all cells within reach.
    void add(const Vec3& p, const Vec3& n)
    {
        // Neighbours follow one another, many of them on one facet.
        const std::array<std::int64_t, 6> range = cells_around(p);
        if (range == last_range_ && n == last_normal_) return;
        last_range_ = range;
        last_normal_ = n;
        for_each_cell(range,
                      [&](std::uint64_t key)
                      {
                          add(key, {n, false});
                          return false;
                      });
    }
    /// Those of another part of the surface.
    void add(const FacingCells& part)
    {
        for (const auto& [key, cell] : part.cells_) add(key, cell);
    }
    bool is_mixed_at(const Vec3& p) const
    {
        const auto cell = cells_.find(key_of(index(p.x), index(p.y), index(p.z)));
        return cell != cells_.end() && cell->second.is_mixed;
    }
    bool is_mixed_within_reach(const Vec3& p) const
    {
        return for_each_cell(cells_around(p),
                             [&](std::uint64_t key) { return cells_.at(key).is_mixed; });
    }

private:
    static constexpr double cell_reaches = 5;
    static constexpr double cos_of_axis = 0.8660254 + 1e-7; ///< of 30 degrees
    struct Cell
    {
        Vec3 axis;
        bool is_mixed = false;
    };

    void add(std::uint64_t key, const Cell& cell)
    {
        const auto [known, is_new] = cells_.try_emplace(key, cell);
        if (!is_new && (cell.is_mixed || !(dot(known->second.axis, cell.axis) > cos_of_axis)))
            known->second.is_mixed = true;
    }
    std::int64_t index(double c) const { return static_cast<std::int64_t>(std::floor(c / side_)); }
    /// From and to along each axis, of the cells within reach.
    std::array<std::int64_t, 6> cells_around(const Vec3& p) const
    {
        const Vec3 r{reach_, reach_, reach_};
        const Vec3 low = p - r, high = p + r;
        return {index(low.x),  index(high.x), index(low.y),
                index(high.y), index(low.z),  index(high.z)};
    }
    /// Far cells may share a key, which only makes more of them mixed.
    static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z)
    {
        constexpr std::uint64_t mask = (1U << 21U) - 1;
        return (static_cast<std::uint64_t>(x) & mask) |
               (static_cast<std::uint64_t>(y) & mask) << 21U |
               (static_cast<std::uint64_t>(z) & mask) << 42U;
    }
    /// Until `stops` is true for one; whether it was.
    template <typename Stops>
    static bool for_each_cell(const std::array<std::int64_t, 6>& range, const Stops& stops)
    {
        for (std::int64_t x = range[0]; x <= range[1]; ++x)
            for (std::int64_t y = range[2]; y <= range[3]; ++y)
                for (std::int64_t z = range[4]; z <= range[5]; ++z)
                    if (stops(key_of(x, y, z))) return true;
        return false;
    }

    double reach_;
    double side_;
    std::array<std::int64_t, 6> last_range_{};
    Vec3 last_normal_;
    std::unordered_map<std::uint64_t, Cell> cells_;
};

/// Finds the particles of the sheet that goes.
class SheetChoice
{
public:
    SheetChoice(const SurfaceMesh& mesh, const Features& features, const OneSheetOptions& options,
                const SurfaceParticles& particles, int threads)
        : mesh_(mesh),
          options_(options),
          particles_(particles),
          threads_(threads),
          parts_(smooth_parts(mesh, features)),
          is_taken_(particles.positions.size(), 0),
          winner_(particles.positions.size(), no_index)
    {
    }

    /// Per particle whether it goes.
    std::vector<char> run()
    {
        take_behind_others();
        std::vector<char> goes = find_rims();
        for (std::size_t i = 0; i < goes.size(); ++i) goes[i] = goes[i] || is_taken_[i];
        return goes;
    }

private:
    std::uint32_t part_of(std::size_t i) const { return parts_.of_facet[particles_.facets[i]]; }
    bool is_on_face(std::size_t i) const { return particles_.kinds[i] == FitKind::Surface; }
    const Vec3& normal_of(std::size_t i) const { return mesh_.normals[particles_.facets[i]]; }

    bool gives_way(std::size_t i, std::size_t j) const
    {
        const std::uint32_t a = part_of(i), b = part_of(j);
        if (a == b) return dot(normal_of(i), staying_side) < dot(normal_of(j), staying_side);
        return std::tuple(parts_.areas[a], b) < std::tuple(parts_.areas[b], a);
    }

    /// Whether j stands behind i, through the plate, and not farther than it is thick.
    bool is_behind(std::size_t i, std::uint32_t j, double squared) const
    {
        if (dot(normal_of(i), normal_of(j)) > -0.5) return false;
        const double dp = options_.dp;
        const double depth = dot(particles_.positions[i] - particles_.positions[j], normal_of(i));
        return depth > 0 && depth < (1 - rounding_of_thickness) * options_.thickness * dp &&
               squared - depth * depth <= dp * dp;
    }

    /// Calls body(chunk, particle) for the particles on faces, those of a chunk in their order.
    template <typename Body>
    void for_each_on_face(const Body& body) const
    {
        parallel_for(chunk_count(), threads_,
                     [&](std::size_t c)
                     {
                         const std::size_t end = std::min(is_taken_.size(), (c + 1) * in_chunk);
                         for (std::size_t i = c * in_chunk; i < end; ++i)
                             if (is_on_face(i)) body(c, static_cast<std::uint32_t>(i));
                     });
    }
    std::size_t chunk_count() const { return (is_taken_.size() + in_chunk - 1) / in_chunk; }

    FacingCells facing_cells(double reach) const
    {
        std::vector<FacingCells> chunks(chunk_count(), FacingCells(reach));
        for_each_on_face([&](std::size_t c, std::uint32_t i)
                         { chunks[c].add(particles_.positions[i], normal_of(i)); });
        FacingCells all(reach);
        for (const FacingCells& chunk : chunks) all.add(chunk);
        return all;
    }

    std::vector<std::uint32_t> particles_in_mixed(const FacingCells& facing) const
    {
        std::vector<std::vector<std::uint32_t>> chunks(chunk_count());
        for_each_on_face(
            [&](std::size_t c, std::uint32_t i)
            {
                if (facing.is_mixed_within_reach(particles_.positions[i])) chunks[c].push_back(i);
            });
        std::vector<std::uint32_t> all;
        for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
        return all;
    }

    void take_behind_others()
    {
        const double reach = sheet_reach_dp * options_.dp;
        const FacingCells facing = facing_cells(reach);
        const std::vector<std::uint32_t> near = particles_in_mixed(facing);
        if (near.empty()) return;
        PointGrid grid(reach, near.size());
        for (const std::uint32_t i : near) grid.add(particles_.positions[i]);
        parallel_for(
            near.size(), threads_,
            [&](std::size_t k)
            {
                const std::uint32_t i = near[k];
                if (!facing.is_mixed_at(particles_.positions[i])) return;
                grid.for_each_near(particles_.positions[i], reach,
                                   [&](std::uint32_t l, double squared)
                                   {
                                       const std::uint32_t j = near[l];
                                       if (!is_behind(i, j, squared) || !gives_way(i, j)) return;
                                       is_taken_[i] = 1;
                                       winner_[i] = std::min(winner_[i], part_of(j));
                                   });
            },
            1024);
    }

    /// Rims and narrow sides: what is near a taken particle and near the sheet that stays, but not
    /// on it.
    std::vector<char> find_rims() const
    {
        const std::size_t n = is_taken_.size();
        const double dp = options_.dp;
        std::vector<char> is_rim(n, 0);
        std::vector<char> is_winner(parts_.areas.size(), 0);
        PointGrid taken(rim_reach_dp * dp, 64);
        Box3 box;
        for (std::size_t i = 0; i < n; ++i)
        {
            if (!is_taken_[i]) continue;
            is_winner[winner_[i]] = 1;
            taken.add(particles_.positions[i]);
            box.add(particles_.positions[i]);
        }
        TriangleSoup sheet;
        for (std::size_t f = 0; f < mesh_.facets.size(); ++f)
            if (is_winner[parts_.of_facet[f]])
                for (const std::uint32_t v : mesh_.facets[f])
                    sheet.vertices.push_back(mesh_.vertices[v]);
        if (sheet.vertices.empty()) return is_rim;
        const MeshQuery query(std::move(sheet), threads_);
        parallel_for(
            n, threads_,
            [&](std::size_t i)
            {
                const Vec3& p = particles_.positions[i];
                if (is_taken_[i] || !box.has(p, rim_reach_dp * dp) ||
                    !taken.has_nearer(p, rim_reach_dp * dp))
                    return;
                const double distance = query.closest_point(p).distance;
                is_rim[i] = distance > 1e-6 * dp && distance < dp;
            },
            1024);
        return is_rim;
    }

    static constexpr std::size_t in_chunk = 65536;

    const SurfaceMesh& mesh_;
    const OneSheetOptions& options_;
    const SurfaceParticles& particles_;
    int threads_;
    SmoothParts parts_;
    std::vector<char> is_taken_;
    std::vector<std::uint32_t> winner_; ///< the part that a taken particle gave way to
};

} // namespace

SurfaceParticles keep_one_sheet(const SurfaceMesh& mesh, const Features& features,
                                const OneSheetOptions& options, SurfaceParticles& particles,
                                int threads)
{
    const std::vector<char> goes = SheetChoice(mesh, features, options, particles, threads).run();
    SurfaceParticles out;
    if (std::find(goes.begin(), goes.end(), 1) == goes.end()) return out;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < goes.size(); ++i)
    {
        if (goes[i])
        {
            out.positions.push_back(particles.positions[i]);
            out.kinds.push_back(particles.kinds[i]);
            out.facets.push_back(particles.facets[i]);
            continue;
        }
        particles.positions[kept] = particles.positions[i];
        particles.kinds[kept] = particles.kinds[i];
        particles.facets[kept] = particles.facets[i];
        ++kept;
    }
    particles.positions.resize(kept);
    particles.kinds.resize(kept);
    particles.facets.resize(kept);
    return out;
}

} // namespace fppg
