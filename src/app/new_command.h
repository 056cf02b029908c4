#pragma once

#include <string>
#include <vector>

namespace fppg
{

/// `fppg new FOLDER|FILES... -o Case_Def.xml`: from parts to a definition that runs, a picture of
/// it, and what inspect says of each part. Asks for what is missing at a terminal only. Returns 0.
///
/// throws  as propose_case(), and as generate_case() where the program refuses what was written
int run_new(const std::vector<std::string>& arguments);

} // namespace fppg
