#pragma once

#include "fppg/element.h"
#include "fppg/particles.h"
#include "fppg/rgb.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace fppg
{

/// Ids of one mk.
struct IdRange
{
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    std::uint16_t mk = 0;
    ParticleType type = ParticleType::Fixed;
};

/// What Case.xml says of the particles.
struct CaseFacts
{
    std::vector<IdRange> ranges;          ///< sorted
    std::map<std::uint16_t, Rgb> colours; ///< of absolute mks: `fppg:color`
    double dp = 0;                        ///< metres; 0 where it does not say
    Box3 limits; ///< of the places of all particles, metres; empty where it does not say
};

/// Reads them from the tree of Case.xml; `path` is for messages.
///
/// throws  CaseError if a range or dp is no number
CaseFacts case_facts(const Element& root, const std::string& path);

/// The range that holds an id, or nullptr.
const IdRange* find_range(const std::vector<IdRange>& ranges, std::uint32_t id);

} // namespace fppg
