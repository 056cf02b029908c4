#pragma once

#include "fppg/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace fppg
{

/// Momenta by trial.
inline constexpr double short_momentum = 0.85;
inline constexpr double long_momentum = 0.95;

/// What stays of a step v, metres, before the step that a force makes is added; the same for single
/// particles and for cells: `momentum` of it, half as much where it leads against the force.
Vec3 momentum_of(const Vec3& v, const Vec3& force, double momentum);

/// What steps of many particles have in common over cells of a few dp, carried on with a momentum
/// of its own. Each particle's momentum is lost with every change of the force on it, which comes
/// mostly from its neighbours; so whole columns of fluid that stand too high or too low, by a
/// hundredth of gravity, would take hundreds of steps.
class CoarseSteps
{
public:
    /// positions  where the particles start; they stay in their cells
    /// takes      bool(std::size_t): whether a particle's steps count, and are added to
    /// cell       metres
    CoarseSteps(std::span<const Vec3> positions, const std::function<bool(std::size_t)>& takes,
                double cell);

    /// Takes in the steps that forces alone would make.
    ///
    /// step  Vec3(std::size_t) of a particle that counts, metres
    void add(const std::function<Vec3(std::size_t)>& step, double momentum, int threads);

    /// What is added to the step of a particle, metres.
    Vec3 at(const Vec3& p) const;

private:
    std::size_t index(std::size_t x, std::size_t y, std::size_t z) const
    {
        return (x * n_[1] + y) * n_[2] + z;
    }

    Vec3 origin_; ///< the middle of the first cell
    double cell_;
    std::array<std::size_t, 3> n_{};
    std::vector<std::uint32_t> first_; ///< of the particles of each cell, and one past the end
    std::vector<std::uint32_t> members_;
    std::vector<Vec3> velocities_; ///< a cell
};

} // namespace fppg
