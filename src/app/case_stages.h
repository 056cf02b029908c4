#pragma once

#include "app/run_state.h"

#include <cstddef>

namespace fppg
{

// The stages of a run but for the writing of files, in order. Each takes the case from where the
// one before left it, and writes into the log what it did.

/// Reads the definition and makes the scene of it.
///
/// zone  of a case with `<vres>`; 0 else
/// vres  zones as the definition of zone 0 gives them; null for zone 0
void read_definition(CaseRunState& run, std::size_t zone, const VresDef* vres, MadeCase& made);

/// Fits walls and draws the rest on the lattice.
void draw(CaseRunState& run, MadeCase& made);

/// Spreads the particles of fitted walls.
void relax(CaseRunState& run, MadeCase& made);

/// Adds the particles of point files, which relaxation would move.
void add_points(CaseRunState& run, MadeCase& made);

/// Makes particles of nodes and walls.
///
/// throws  CaseError with -strict and diagnostics
void prepare_particles(CaseRunState& run, MadeCase& made);

/// Collects the shape files, and computes the normals, which may be those of one.
void make_normals(CaseRunState& run, MadeCase& made);

/// Brings fluid beside fitted walls to rest; after the normals, from which mDBC takes pressures.
void balance(CaseRunState& run, MadeCase& made);

/// All stages behind the definition.
void make_particles_of_case(CaseRunState& run, MadeCase& made);

} // namespace fppg
