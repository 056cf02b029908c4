#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

namespace fppg
{

/// A particle as `<initials>` finds and leaves it.
struct InitialState
{
    Vec3 position;
    Vec3 velocity;
    double rhop = 0;
    std::uint64_t place = 0; ///< of the particle in its block: its id less that of the first
};

/// Runs the operations of a block on one of its particles; nothing in them is empty.
void apply_initials(const std::vector<InitialOp>& initials, InitialState& state);

/// All moves of a block in one; random ones, which only fluid has, do not count.
Transform motion_of(const ParticleBlock& block);

/// Whether a block has `<moverandom>`.
bool scatters(const ParticleBlock& block);

/// Whether a block's densities are set by `<initials>`.
bool sets_density(const ParticleBlock& block);

/// Sets pos_min and pos_max to the places after the moves.
///
/// throws  CaseError as set_initials() does
void set_limits(const CaseDef& def, CaseParticles& particles);

/// Gives every block the operations of its mk, with all that they leave empty: gravity, rhop0,
/// gamma and b of the case, and for densitydepth without posswl the highest against gravity of the
/// particles that it selects, at their places then (found with GenCase v5.4.354: two fluids of
/// different height, with and without a move before). An mk without particles has no effect. Sets
/// the limits of the particles anew where a block moves.
///
/// throws  CaseError if a moved particle leaves the domain, as GenCase does: its places go from the
///         first node to pointmax
/// cost    O(runs); O(particles of the block) where it turns, moves at random or the surface is to
///         be found, and 4 bytes per random number
void set_initials(const CaseDef& def, const CaseConstants& constants, CaseParticles& particles);

} // namespace fppg
