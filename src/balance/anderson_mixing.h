#pragma once

#include "fppg/vec.h"

#include "core/raw_array.h"

#include <array>
#include <cstddef>
#include <span>

namespace fppg
{

/// Steps to places where forces vanish, by Anderson's mixing.
///
/// Of the last iterations it keeps how places and forces changed, finds the shares of these changes
/// that leave the least force, and steps by these shares and along what is left. Fluid beside
/// walls has stiff pairs of neighbours and columns that hardly resist: after 20 iterations in a
/// sphere under DBC 0.0034 g are left, with momentum 0.0063; after 50 both have 0.0018, later
/// momentum leaves less.
///
/// source  D. G. Anderson, J. ACM 12 (1965) 547; H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49
///         (2011) 1715, type II
class AndersonMixing
{
public:
    /// n  particles
    AndersonMixing(std::size_t n, int threads);

    /// Takes the places of all particles and the forces there, n each, once an iteration. Those
    /// that stay have no force.
    void add(std::span<const Vec3> places, std::span<const Vec3> forces);

    /// The step from the places of the last add().
    ///
    /// mobility  of particle i: the step for a force where nothing is known of others
    Vec3 step(std::size_t i, double mobility) const;

private:
    static constexpr std::size_t window = 4; ///< changes that are kept; 3 to 12 do as well
    struct Change
    {
        std::array<float, 3> place, force;
    };
    using Products = std::array<double, window>;

    /// Of the newest change of forces with all, then of all with the force.
    std::array<Products, 2> products() const;
    void set_shares(const Products& with_force);

    int threads_;
    RawArray<Vec3> places_, forces_;
    std::array<RawArray<Change>, window> changes_;
    std::array<Products, window> between_{}; ///< of changes of forces
    Products shares_{};
    std::size_t count_ = 0; ///< of changes
    std::size_t newest_ = 0;
    bool has_last_ = false;
};

} // namespace fppg
