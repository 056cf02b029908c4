#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

namespace fppg
{

/// What densities are computed from.
struct WaterNodes
{
    const CaseDef& def;
    const RunField& field;
    const std::vector<ParticleType>& type_of_mk; ///< size 65536
    /// Per block its first particle in particles.off_lattice, and their number as last entry.
    const std::vector<std::uint64_t>& off_lattice_begin;
};

/// Depths of the fluid below the top of its water, and what follows from them (rules R1 to R6 of
/// the experiments with GenCase v5.4.354):
/// - rhopgradient 2 (and 1 for hswl): for every axis with gravity, n = steps in the + direction
///   while the next node holds fluid or a floating body, plus 1 when the node that ends the run is
///   a fixed or moving boundary particle; d = |(n dp gravity)| / |gravity|
/// - rhopgradient 3: d = max over the fluid of s, minus s, with s = -position . gravity / |gravity|
/// - hswl automatic = max of d over fluid and floating particles, over fluid only for
///   rhopgradient 3
/// - rhop = rhop0 (1 + rhop0 |gravity| d / b)^(1 / gamma), as float; rhop0 for rhopgradient 1, and
///   where b or gravity is zero (GenCase writes NaN there)
/// - where part of gravity drives the fluid (ConstantsDef::driving), rhop by depths without it; but
///   hswl and the speed of sound by all of gravity
/// - where fluid is balanced and gravity is along an axis, depths are those of water at rest
///   (upward_depths.h), for rhopgradient 3 too: the highest surface is not that of water that
///   stands lower (public CaseFlexibleGate of v5.2, a bed of 0.05 m before a dam of 0.6 m: 1.3 g)
/// - all fluid of an mk that has particles of `<setfrdrawmode>` has rhop0, on nodes too, unless
///   def.hydrostatic_off_lattice (33 cases, 2D too, with all gradients and oblique gravity)
///
/// A covered node counts in its column as one of its mk but has no depth of its own. A particle off
/// the lattice has the number of steps of its nearest node, less its real distance from there along
/// each axis, at least 0; where its nearest node is no water, of the nearest node of water within 4
/// dp, and without any the depth 0. For hswl all nodes of fluid count that such particles hide,
/// with whole steps: two particles 0.6 and 0.4 dp from each other gave hswl = 1 dp, and of 33
/// random cases of free fluid under upright and oblique gravity 32 had GenCase's hswl.
///
/// Sets hswl, speed_system, speed_sound, b of `constants`, the depths of the fluid runs, and
/// rhop_of_depth or rhop of `particles`, and particles.off_lattice.rhop. Runs must be in the
/// default order (x, y, z) and without those off the lattice; where values are stored one per
/// particle, those of a block's nodes come first.
///
/// returns  whether fluid has less depth than rhopgradient 3 asks for
bool compute_densities(const WaterNodes& water, CaseParticles& particles, CaseConstants& constants,
                       int threads);

} // namespace fppg
