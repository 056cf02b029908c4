#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/scene.h"

#include "shapes/polyhedra.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

namespace fppg::test
{

/// A case of 41 nodes a side round the origin, or round it in the plane y = 0, whose boundary mks
/// are body-fitted. Its commands draw with mkbound 0 at first.
struct Drawing
{
    static constexpr double dp = 0.1;
    static constexpr std::uint16_t fluid_mk = 1;
    static constexpr std::uint16_t wall_mk = 10; ///< of mkbound 0

    explicit Drawing(bool is_2d = false)
    {
        def.grid.origin = {-2, is_2d ? 0.0 : -2.0, -2};
        def.grid.dp = dp;
        def.grid.n = {41, is_2d ? 1U : 41U, 41};
        def.grid.is_2d = is_2d;
        def.mk_bound_first = wall_mk;
        def.fit.all = FitSettings{};
        bound(0);
    }

    void bound(std::uint16_t mkbound)
    {
        state.mk = {MkKind::Bound, static_cast<std::uint16_t>(wall_mk + mkbound), mkbound};
    }
    void fluid() { state.mk = {MkKind::Fluid, fluid_mk, 0}; }
    void empty() { state.mk = {}; }

    void draw(Command what)
    {
        DrawOp op;
        op.source = {7, "test"};
        op.state = std::make_shared<const DrawState>(state);
        op.what = std::move(what);
        def.ops.push_back(std::move(op));
    }
    void box(const Vec3& low, const Vec3& size)
    {
        draw(make_box(low, size, {true, true, true, true, true, true}, true, {}, dp)[0]);
    }
    /// Fills what is void round a seed with fluid, up to a height if one is given.
    void fill(const Vec3& seed, std::optional<double> level = {})
    {
        fluid();
        FillOp op;
        op.seed = seed;
        op.filter.names[static_cast<std::size_t>(MkKind::Void)] = true;
        if (level) op.region = BoxRegion{{-3, -3, -3}, {3, 3, *level}};
        draw(op);
    }
    void fluid_band() { def.fluid_bands.emplace_back(); }

    RunField run(int threads = 1) const
    {
        LatticeReport report;
        return draw_scene(make_scene(def), threads, {}, report);
    }

    CaseDef def;
    DrawState state;
};

} // namespace fppg::test
