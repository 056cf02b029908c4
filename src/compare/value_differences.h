#pragma once

#include "files/particle_source.h"
#include "fppg/compare.h"

#include <string>
#include <vector>

namespace fppg
{

/// What differs in Case.xml, or both of it, and in the values of Case.bi4. The name and version of
/// the maker, the date and the name of the case are left out.
///
/// notes  receives a sentence where one file lacks them
std::vector<ValueDifference> value_differences(const ParticleSource& a, const ParticleSource& b,
                                               const CompareOptions& options, double dp,
                                               std::vector<std::string>& notes);

/// The text of an attribute of <case>, or of a value of Case.bi4; empty where there is none.
std::string maker_of(const ParticleSource& source, const char* attribute);

} // namespace fppg
