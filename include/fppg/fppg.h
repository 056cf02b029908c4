#pragma once

// All that most programs need: cases to particles (generate_case), results and outputs of the
// solver for other codes (feed_of_file, convert_particles), particles on a mesh (fit_mesh), what
// differs between two results (compare_results), and the errors that they throw.

#include "fppg/compare.h"
#include "fppg/convert.h"
#include "fppg/error.h"
#include "fppg/fit_mesh.h"
#include "fppg/generate.h"
#include "fppg/version.h"
