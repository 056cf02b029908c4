#include "gaps/passages.h"

#include "core/even_places.h"
#include "core/parallel.h"
#include "fppg/scene.h"
#include "meshes/facing_distance.h"
#include "meshes/point_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace fppg
{

namespace
{

constexpr double most_nodes = 3e8;
constexpr double most_places = 3e6;

/// Where fluid of a case can flow, on its lattice.
class FluidReach
{
public:
    FluidReach(const CaseDef& def, int threads)
    {
        CaseDef on_lattice = def;
        on_lattice.fit = {};
        on_lattice.fluid_bands.clear();
        LatticeReport report;
        const RunField field = draw_on_lattice(make_scene(on_lattice), threads, {}, report);
        grid_ = field.grid;
        state_.assign(std::size_t{grid_.n[0]} * grid_.n[1] * grid_.n[2], free);
        std::vector<std::size_t> now;
        for (std::size_t x = 0; x < field.slabs.size(); ++x)
            for (const Run& run : field.slabs[x])
            {
                const std::size_t column = (x * grid_.n[1] + run.y) * grid_.n[2];
                const bool is_fluid = run.mk < def.mk_bound_first;
                for (std::uint32_t z = run.z_begin; z < run.z_end; ++z)
                {
                    state_[column + z] = is_fluid ? reached : wall;
                    if (is_fluid) now.push_back(column + z);
                }
            }
        has_fluid_ = !now.empty();
        flood(std::move(now));
    }

    bool has_fluid() const { return has_fluid_; }

    /// Whether a node within two steps of a place is reached.
    bool is_near(const Vec3& p) const
    {
        std::array<std::int64_t, 3> at{};
        for (int axis = 0; axis < 3; ++axis)
            at[static_cast<std::size_t>(axis)] =
                std::llround((p[axis] - grid_.origin[axis]) / grid_.step(axis));
        for (std::int64_t x = at[0] - 2; x <= at[0] + 2; ++x)
            for (std::int64_t y = at[1] - 2; y <= at[1] + 2; ++y)
                for (std::int64_t z = at[2] - 2; z <= at[2] + 2; ++z)
                    if (is_reached(x, y, z)) return true;
        return false;
    }

private:
    static constexpr std::uint8_t free = 0;
    static constexpr std::uint8_t wall = 1;
    static constexpr std::uint8_t reached = 2;

    bool is_reached(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        const std::array<std::int64_t, 3> at{x, y, z};
        std::size_t node = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (at[axis] < 0 || at[axis] >= std::int64_t{grid_.n[axis]}) return false;
            node = node * grid_.n[axis] + static_cast<std::size_t>(at[axis]);
        }
        return state_[node] == reached;
    }

    void flood(std::vector<std::size_t> now)
    {
        const std::size_t nz = grid_.n[2], slab = nz * grid_.n[1];
        const auto reach = [&](std::size_t node)
        {
            if (state_[node] != free) return;
            state_[node] = reached;
            now.push_back(node);
        };
        while (!now.empty())
        {
            const std::size_t node = now.back();
            now.pop_back();
            if (node >= slab) reach(node - slab);
            if (node + slab < state_.size()) reach(node + slab);
            if (node % slab >= nz) reach(node - nz);
            if (node % slab + nz < slab) reach(node + nz);
            if (node % nz > 0) reach(node - 1);
            if (node % nz + 1 < nz) reach(node + 1);
        }
    }

    LatticeGrid grid_;
    std::vector<std::uint8_t> state_;
    bool has_fluid_ = false;
};

/// All facets of the boundaries.
struct BoundaryFacets
{
    TriangleSoup soup;
    std::vector<Vec3> normals;
    std::vector<double> areas;
    std::vector<std::uint32_t> shape; ///< index into CaseSolids::shapes
};

BoundaryFacets boundary_facets(const CaseSolids& solids)
{
    BoundaryFacets out;
    for (std::uint32_t s = 0; s < solids.shapes.size(); ++s)
    {
        if (solids.shapes[s].kind != MkKind::Bound) continue;
        const TriangleSoup& soup = solids.shapes[s].solid->soup();
        for (std::size_t f = 0; f < soup.size(); ++f)
        {
            const Vec3* c = &soup.vertices[3 * f];
            const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
            const double length = norm(normal);
            if (!(length > 0)) continue;
            out.soup.vertices.insert(out.soup.vertices.end(), c, c + 3);
            out.normals.push_back(normal / length);
            out.areas.push_back(length / 2);
            out.shape.push_back(s);
        }
    }
    return out;
}

/// A place a dp^2, or more apart where they would be too many.
std::vector<FacetSpot> spread_places(const BoundaryFacets& facets, double area_of_each)
{
    std::vector<FacetSpot> out;
    double left = 0.5 * area_of_each;
    for (std::uint32_t f = 0; f < facets.areas.size(); ++f)
    {
        left += facets.areas[f];
        for (std::size_t i = out.size(); left >= area_of_each; ++i, left -= area_of_each)
        {
            const Vec3* c = &facets.soup.vertices[3 * std::size_t{f}];
            out.push_back({f, even_on_facet({c[0], c[1], c[2]}, static_cast<double>(i))});
        }
    }
    return out;
}

/// What is in front of a place.
struct Front
{
    bool is_free = false; ///< in no solid
    bool is_wet = false;  ///< and fluid comes there
    double gap_dp = 0;    ///< 0: none within reach
    Vec3 middle;          ///< between the place and what is in front of it
};

class PassageSearch
{
public:
    PassageSearch(const CaseSolids& solids, const FluidReach& reach, double dp, int threads)
        : solids_(solids),
          reach_(reach),
          dp_(dp),
          facets_(boundary_facets(solids)),
          query_(facets_.soup, threads)
    {
    }

    void run(int threads, MotionGaps& out)
    {
        double all = 0;
        for (const double area : facets_.areas) all += area;
        const double each = std::max(dp_ * dp_, all / most_places);
        const std::vector<FacetSpot> places = spread_places(facets_, each);
        std::vector<std::array<Front, 2>> fronts(places.size());
        parallel_for(
            places.size(), threads,
            [&](std::size_t i)
            {
                fronts[i][0] = look(places[i], FacetSide::Before);
                if (!solids_.shapes[facets_.shape[places[i].facet]].is_closed)
                    fronts[i][1] = look(places[i], FacetSide::Behind);
            },
            64);
        follow_passages(fronts, 2.2 * std::sqrt(each));
        for (std::size_t i = 0; i < places.size(); ++i)
            for (const Front& front : fronts[i]) count(places[i], front, each, out);
    }

private:
    Front look(const FacetSpot& from, FacetSide side) const
    {
        constexpr double reach_dp = MotionGaps::widths_dp.back();
        const Vec3 way = facets_.normals[from.facet] * (side == FacetSide::Before ? 1.0 : -1.0);
        const double found =
            facing_distance(facets_.normals, query_, from, side, reach_dp * dp_) / dp_;
        const double gap = std::isfinite(found) ? found : 0;
        const Vec3 middle = from.place + way * (dp_ * (gap > 0 ? gap / 2 : 1));
        Front out;
        if (gap > 0 && gap < touching_dp) return out;
        out.is_free = solids_.find(middle, {}) == CaseSolids::none;
        out.is_wet = out.is_free && reach_.is_near(middle);
        out.gap_dp = gap;
        out.middle = middle;
        return out;
    }

    /// Passages of less than two dp may have no node of the lattice in them: they are followed from
    /// their wet ends, from one middle to the next.
    void follow_passages(std::vector<std::array<Front, 2>>& fronts, double step) const
    {
        PointGrid middles(step, fronts.size());
        std::vector<Front*> narrow;
        std::vector<std::uint32_t> wet;
        for (std::array<Front, 2>& sides : fronts)
            for (Front& front : sides)
            {
                if (!front.is_free || !(front.gap_dp > 0)) continue;
                if (front.is_wet) wet.push_back(static_cast<std::uint32_t>(narrow.size()));
                narrow.push_back(&front);
                middles.add(front.middle);
            }
        while (!wet.empty())
        {
            const Vec3 from = narrow[wet.back()]->middle;
            wet.pop_back();
            middles.for_each_near(from, step,
                                  [&](std::uint32_t i, double)
                                  {
                                      if (narrow[i]->is_wet || !is_clear(from, narrow[i]->middle))
                                          return;
                                      narrow[i]->is_wet = true;
                                      wet.push_back(i);
                                  });
        }
    }

    /// Whether no surface is between two places, by steps as long as their distance to surfaces.
    bool is_clear(const Vec3& from, const Vec3& to) const
    {
        constexpr int most_steps = 200;
        const double length = norm(to - from);
        double at = 0;
        for (int k = 0; k < most_steps; ++k)
        {
            const double left = length - at;
            const Vec3 place = length > 0 ? from + (at / length) * (to - from) : from;
            const double free = query_.closest_point(place, left + dp_).distance;
            if (free >= left) return true;
            if (free < 1e-3 * dp_) return false;
            at += free;
        }
        return false;
    }

    void count(const FacetSpot& at, const Front& front, double area, MotionGaps& out) const
    {
        if (!front.is_wet) return;
        out.area += area;
        if (!(front.gap_dp > 0)) return;
        for (std::size_t w = 0; w < MotionGaps::widths_dp.size(); ++w)
            if (front.gap_dp < MotionGaps::widths_dp[w]) out.narrow_area[w] += area;
        const CaseShape& shape = solids_.shapes[facets_.shape[at.facet]];
        out.places.push_back({at.place, static_cast<float>(front.gap_dp), shape.mk});
        if (out.narrowest_dp > 0 && out.narrowest_dp <= front.gap_dp) return;
        out.narrowest_dp = front.gap_dp;
        out.narrowest_at = at.place;
    }

    const CaseSolids& solids_;
    const FluidReach& reach_;
    double dp_;
    BoundaryFacets facets_;
    MeshQuery query_;
};

} // namespace

void find_passages(const CaseDef& def, const CaseSolids& solids, int threads, MotionGaps& out)
{
    const double nodes = static_cast<double>(def.grid.n[0]) * def.grid.n[1] * def.grid.n[2];
    if (nodes > most_nodes || def.grid.is_2d)
    {
        out.notes.push_back(def.grid.is_2d
                                ? "Passages are looked for in 3D cases only."
                                : fmt::format("The domain has {:.2g} nodes, more than {:.0e}: "
                                              "passages were not looked for; a larger --dp does.",
                                              nodes, most_nodes));
        return;
    }
    const FluidReach reach(def, threads);
    if (!reach.has_fluid())
    {
        out.notes.push_back("The case has no fluid: passages were not looked for.");
        return;
    }
    PassageSearch(solids, reach, def.grid.dp, threads).run(threads, out);
    for (NarrowPlace& place : out.places)
        place.mkbound = static_cast<std::uint16_t>(place.mkbound - def.mk_bound_first);
    if (out.places.empty()) return;
    std::vector<float> gaps;
    for (const NarrowPlace& place : out.places) gaps.push_back(place.gap_dp);
    const std::size_t tenth = gaps.size() / 10;
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(tenth), gaps.end());
    out.resolving_dp = std::min(1.0, gaps[tenth] / 4.0) * def.grid.dp;
}

} // namespace fppg
