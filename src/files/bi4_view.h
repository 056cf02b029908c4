#pragma once

#include "core/binary_items.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// What a file of DualSPHysics' binary container (JPartDataBi4) holds of particles: views of its
/// bytes, empty where it lacks an array. Positions, velocities and normals are vectors of three.
struct Bi4View
{
    std::string_view idp, pos, posd, vel, rhop, bound_normals;
    std::vector<std::string> others; ///< names of the other arrays
    std::vector<BinaryItem> items;   ///< all of the file, with its values

    std::size_t size() const { return idp.size() / 4; }
    /// Where a file has both, the solver takes the single ones too.
    bool is_single() const { return posd.empty() || !pos.empty(); }
};

/// bytes   the whole file; must outlive the result
/// path    for messages
/// throws  IoError if the file is not whole or not of this format, or arrays differ in length
Bi4View view_bi4(std::string_view bytes, const std::string& path);

} // namespace fppg
