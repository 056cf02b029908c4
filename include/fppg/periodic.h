#pragma once

#include "fppg/lattice.h"
#include "fppg/particles.h"

#include <string>
#include <vector>

namespace fppg
{

struct CaseDef;

/// The solver repeats a case along an axis after the extent of its particles plus dp (JSph.cpp and
/// JPartsLoad4.cpp, v5.4), which is right for nodes only. With particles off the lattice the period
/// is that of the lattice: its nodes times dp.

/// What close_seams() did.
struct SeamsClosed
{
    std::size_t left_out = 0; ///< of pairs across the seam
    std::size_t moved = 0;    ///< by a period
};

/// Cuts one period out of the particles off the lattice, from half a step before the first node to
/// half a step behind the last: those of walls beyond it go, those of the volume move by a period.
/// Of two of walls, or two of the volume, that are nearer than 0.5 dp across the end of the period
/// the one at its end goes. The others keep 1e-4 dp off both ends, where the solver looks for them.
///
/// cost  O(n) for n particles
SeamsClosed close_seams(const CaseDef& def, RunField& field);

/// Makes the limits of the particles along periodic axes those of the lattice, if there are
/// particles off the lattice.
///
/// warnings  a sentence for an axis along which particles do not reach to both ends of the lattice,
///           whose limits stay as they are
void set_period(const CaseDef& def, CaseParticles& particles, std::vector<std::string>& warnings);

} // namespace fppg
