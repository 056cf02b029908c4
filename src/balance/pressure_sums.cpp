#include "balance/pressure_sums.h"

#include "core/lanes.h"

#include <cstring>

namespace fppg
{
namespace
{

static_assert(points_per_group == lane_count);

/// W and (dW/dq) / q over FluidAtRest::alpha(), at q = r / h.
struct WendlandLanes
{
    FPPG_LANES Lanes shape(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 1 - 0.5f * q);
        return s * s * s * s * (2 * q + 1);
    }
    FPPG_LANES Lanes slope(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 1 - 0.5f * q);
        return -5 * s * s * s;
    }
};

struct CubicLanes
{
    FPPG_LANES Lanes shape(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 2 - q);
        return q > 1.0f ? 0.25f * s * s * s : 1 - 1.5f * q * q + 0.75f * q * q * q;
    }
    FPPG_LANES Lanes slope(const Lanes& q) const
    {
        const Lanes s = larger(Lanes{}, 2 - q);
        return q > 1.0f ? -0.75f * s * s / q : 2.25f * q - 3;
    }
};

/// One of four numbers in all lanes.
template <int k>
FPPG_LANES Lanes spread(const PackedPoint& p)
{
    return __builtin_shufflevector(p, p, k, k, k, k, k, k, k, k);
}

/// The points of a group, a lane each.
struct GroupLanes
{
    Lanes x, y, z;

    FPPG_LANES GroupLanes(const PressureField& field, const PointGroup& group)
    {
        const LanePoints p = PackedGather{field.packed.data()}.eight(group.points.data());
        x = p.x;
        y = p.y;
        z = p.z;
    }
    /// The offsets from a neighbour to them.
    FPPG_LANES LaneOffsets from(const PackedPoint& neighbour) const
    {
        LaneOffsets o{x - spread<0>(neighbour), y - spread<1>(neighbour), z - spread<2>(neighbour),
                      Lanes{}, spread<3>(neighbour)};
        o.squared = o.x * o.x + o.y * o.y + o.z * o.z;
        return o;
    }
};

FPPG_LANES void store(const Lanes& from, std::array<float, lane_count>& to)
{
    std::memcpy(to.data(), &from, sizeof from);
}

template <bool pushes, typename Kernel>
FPPG_LANES void sum_up(const PressureField& field, const PointGroup& group, const PairShape& shape,
                       const Kernel& kernel, PressureSums& out)
{
    Lanes x{}, y{}, z{}, push_x{}, push_y{}, push_z{};
    const Lanes per_h = lanes_of(1 / shape.h_dp);
    const Lanes own = gathered(field.pressures.data(), group.points.data());
    const float least_squared = shape.least_pair * shape.least_pair;
    const GroupLanes points(field, group);
    for (const std::uint32_t j : group.near)
    {
        const LaneOffsets o = points.from(field.packed[j]);
        const Lanes distance = square_root(o.squared);
        const Lanes f =
            kernel.slope(distance * per_h) * o.fourth * (own + lanes_of(field.pressures[j]));
        x += f * o.x;
        y += f * o.y;
        z += f * o.z;
        if (!pushes) continue;
        const LaneMask is_close = (o.squared < least_squared) & (o.squared > 0.0f);
        if (set_lanes(is_close) == 0) continue;
        const Lanes push = is_close ? (shape.least_pair - distance) / distance : Lanes{};
        push_x += push * o.x;
        push_y += push * o.y;
        push_z += push * o.z;
    }
    store(x, out.x);
    store(y, out.y);
    store(z, out.z);
    store(push_x, out.push_x);
    store(push_y, out.push_y);
    store(push_z, out.push_z);
}

FPPG_LANES void sum_either(const PressureField& field, const PointGroup& group,
                           const PairShape& shape, PressureSums& out)
{
    const bool pushes = shape.least_pair > 0;
    if (shape.is_cubic)
        pushes ? sum_up<true>(field, group, shape, CubicLanes{}, out)
               : sum_up<false>(field, group, shape, CubicLanes{}, out);
    else
        pushes ? sum_up<true>(field, group, shape, WendlandLanes{}, out)
               : sum_up<false>(field, group, shape, WendlandLanes{}, out);
}

void sum_plain(const PressureField& field, const PointGroup& group, const PairShape& shape,
               PressureSums& out)
{
    sum_either(field, group, shape, out);
}

FPPG_AVX2 void sum_avx2(const PressureField& field, const PointGroup& group, const PairShape& shape,
                        PressureSums& out)
{
    sum_either(field, group, shape, out);
}

using GroupDensities = std::array<DensitySums, lane_count>;

template <typename Kernel>
FPPG_LANES void sum_up_densities(const PressureField& field, const PointGroup& group,
                                 const PairShape& shape, const Kernel& kernel, GroupDensities& out)
{
    Lanes w{}, w_e{};
    std::array<Lanes, 3> w_r{}, s_r{}, s_e_r{};
    std::array<Lanes, 6> s_r_r{};
    const Lanes per_h = lanes_of(1 / shape.h_dp);
    const GroupLanes points(field, group);
    for (const std::uint32_t j : group.near)
    {
        const LaneOffsets o = points.from(field.packed[j]);
        const Lanes q = square_root(o.squared) * per_h;
        const Lanes of_w = kernel.shape(q) * o.fourth;
        const Lanes of_s = kernel.slope(q) * o.fourth;
        const Lanes e = lanes_of(field.pressures[j]);
        const std::array<Lanes, 3> r{o.x, o.y, o.z};
        w += of_w;
        w_e += of_w * e;
        std::size_t pair = 0;
        for (std::size_t a = 0; a < 3; ++a)
        {
            const Lanes along = of_s * r[a];
            w_r[a] += of_w * r[a];
            s_r[a] += along;
            s_e_r[a] += along * e;
            for (std::size_t b = a; b < 3; ++b) s_r_r[pair++] += along * r[b];
        }
    }
    for (std::size_t l = 0; l < lane_count; ++l)
    {
        DensitySums& sums = out[l];
        sums.w = w[l];
        sums.w_e = w_e[l];
        for (std::size_t a = 0; a < 3; ++a)
        {
            sums.w_r[a] = w_r[a][l];
            sums.s_r[a] = s_r[a][l];
            sums.s_e_r[a] = s_e_r[a][l];
        }
        for (std::size_t k = 0; k < s_r_r.size(); ++k) sums.s_r_r[k] = s_r_r[k][l];
    }
}

FPPG_LANES void densities_either(const PressureField& field, const PointGroup& group,
                                 const PairShape& shape, GroupDensities& out)
{
    if (shape.is_cubic)
        sum_up_densities(field, group, shape, CubicLanes{}, out);
    else
        sum_up_densities(field, group, shape, WendlandLanes{}, out);
}

void densities_plain(const PressureField& field, const PointGroup& group, const PairShape& shape,
                     GroupDensities& out)
{
    densities_either(field, group, shape, out);
}

FPPG_AVX2 void densities_avx2(const PressureField& field, const PointGroup& group,
                              const PairShape& shape, GroupDensities& out)
{
    densities_either(field, group, shape, out);
}

} // namespace

PressureSums pressure_sums(const PressureField& field, const PointGroup& group,
                           const PairShape& shape)
{
    PressureSums out;
    (is_avx2_there() ? sum_avx2 : sum_plain)(field, group, shape, out);
    return out;
}

std::array<DensitySums, lane_count> density_sums(const PressureField& field,
                                                 const PointGroup& group, const PairShape& shape)
{
    GroupDensities out;
    (is_avx2_there() ? densities_avx2 : densities_plain)(field, group, shape, out);
    return out;
}

} // namespace fppg
