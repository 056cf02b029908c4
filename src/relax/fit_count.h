#pragma once

#include "relax/volume_band.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Which particles go, and where some come.
struct CountChange
{
    std::vector<char> is_removed;
    struct Inserted
    {
        std::uint32_t beside;
        Vec3 place;
    };
    std::vector<Inserted> inserted;
    std::size_t removed = 0;
};

/// Adds up along the rows of the lists how far Shepard sums are from 1, and gives or takes a
/// particle wherever that makes half a one; and what the number is then off that wanted.
///
/// is_last  only what the number is off
CountChange find_count_change(const Band& band, const NeighbourList& list,
                              const RelaxVolumeOptions& options,
                              const VolumeSurroundings& surroundings, bool is_last, int threads);

/// Carries a change out; lists must be made anew.
void change_count(Band& band, const CountChange& change);

} // namespace fppg
