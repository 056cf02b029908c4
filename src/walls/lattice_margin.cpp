#include "walls/lattice_margin.h"

#include "fppg/error.h"

#include "scene/surfaces.h"
#include "walls/step_surfaces.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fppg
{
namespace
{

constexpr double rounding_dp = 1e-4;
/// What ends less beyond the last node is on that node by rounding, dp: the domain cuts nothing.
constexpr double on_last_node_dp = 0.49;
/// Cosine to an axis of facets whose layers go along it.
constexpr double least_along = 0.1;

/// How far the layers of a sheet go behind or before it, dp; 0: it has none.
double depth_of_layers(const FitSettings& settings)
{
    const std::vector<double>& own = settings.depths_dp;
    const std::vector<double>& of_sheets = settings.sheet_depths_dp;
    return std::max(own.empty() ? 0 : own.back(), of_sheets.empty() ? 0 : of_sheets.back());
}

class MarginFinder
{
public:
    MarginFinder(const Scene& scene, int threads)
        : scene_(scene), grid_(scene.def->grid), threads_(threads)
    {
    }

    LatticeMargin find()
    {
        for (const SceneStep& step : scene_.remaining())
        {
            if (step.shape() == nullptr && !step.combination) continue;
            const MkValue& mk = step.draw->state->mk;
            const FitSettings* settings =
                draws_bound(step) ? fit_settings(scene_.def->fit, mk.mk) : nullptr;
            for (const ShapeMesh& shape : surfaces_of(scene_, *step.draw, PartsAs::Drawn, threads_))
            {
                for (const Vec3& v : shape.soup.vertices) block_ends_before(v);
                if (settings != nullptr && !shape.is_solid)
                    add(shape.soup, depth_of_layers(*settings));
            }
        }
        LatticeMargin out;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto a = static_cast<std::size_t>(axis);
            if (grid_.is_periodic[a] || (grid_.is_2d && axis == 1)) continue;
            const auto nodes = [&](double needed)
            {
                return static_cast<std::uint32_t>(
                    std::max(0.0, std::ceil(needed / grid_.stretch[axis] - rounding_dp)));
            };
            if (!is_low_blocked_[a]) out.low[a] = nodes(low_[a]);
            if (!is_high_blocked_[a]) out.high[a] = nodes(high_[a]);
        }
        return out;
    }

private:
    double before_low(const Vec3& p, int axis) const
    {
        return (grid_.origin[axis] - p[axis]) / grid_.dp;
    }
    double beyond_high(const Vec3& p, int axis) const
    {
        const double last = grid_.n[static_cast<std::size_t>(axis)] - 1;
        return (p[axis] - grid_.origin[axis] - last * grid_.step(axis)) / grid_.dp;
    }

    void block_ends_before(const Vec3& p)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto a = static_cast<std::size_t>(axis);
            is_low_blocked_[a] = is_low_blocked_[a] || before_low(p, axis) > on_last_node_dp;
            is_high_blocked_[a] = is_high_blocked_[a] || beyond_high(p, axis) > on_last_node_dp;
        }
    }

    void add(const TriangleSoup& soup, double depth)
    {
        if (depth == 0) return;
        for (std::size_t f = 0; f < soup.size(); ++f)
        {
            const Vec3* c = &soup.vertices[3 * f];
            const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
            for (int axis = 0; axis < 3; ++axis)
            {
                const auto a = static_cast<std::size_t>(axis);
                if (std::abs(normal[axis]) < least_along * norm(normal)) continue;
                for (std::size_t k = 0; k < 3; ++k)
                {
                    low_[a] = std::max(low_[a], before_low(c[k], axis) + depth);
                    high_[a] = std::max(high_[a], beyond_high(c[k], axis) + depth);
                }
            }
        }
    }

    const Scene& scene_;
    const LatticeGrid& grid_;
    int threads_;
    std::array<double, 3> low_{}; ///< dp
    std::array<double, 3> high_{};
    std::array<bool, 3> is_low_blocked_{};
    std::array<bool, 3> is_high_blocked_{};
};

} // namespace

LatticeMargin margin_for_layers(const Scene& scene, int threads)
{
    const CaseDef& def = *scene.def;
    if (def.fit.is_empty() || def.vres.is_active()) return {};
    try
    {
        return MarginFinder(scene, threads).find();
    }
    catch (const Error&)
    {
        return {}; // drawing the walls says what is wrong
    }
}

void widen_lattice(const LatticeMargin& margin, LatticeGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto a = static_cast<std::size_t>(axis);
        grid.origin[axis] -= margin.low[a] * grid.step(axis);
        grid.n[a] += margin.low[a] + margin.high[a];
    }
}

} // namespace fppg
