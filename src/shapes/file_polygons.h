#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

#include "shapes/polyhedra.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace fppg
{

/// Whether a file of this format is a table of heights.
inline bool has_heights(MeshFormat format)
{
    return format == MeshFormat::Bathymetry || format == MeshFormat::CsvBathymetry;
}

/// Calls body(corners) for the triangles and quads of a file, with indices into the vertices of its
/// soup. A quad of a table of heights that is not flat where it is drawn is two triangles (600
/// tables of four heights, scaled and turned, of GenCase v5.4.354).
template <typename Body>
void for_each_polygon(const MeshFile& file, const MeshFileOp& op, double dp, const Body& body)
{
    const bool may_be_bent = !has_heights(op.reading.format);
    const auto is_flat = [&](std::uint32_t first)
    {
        const auto corner = [&](std::uint32_t i)
        { return op.transform(file.soup.vertices[first + i]); };
        return is_flat_quad({corner(0), corner(1), corner(2), corner(5)}, dp);
    };
    auto quad = file.quads.begin();
    for (std::uint32_t t = 0; t < file.soup.size(); ++t)
    {
        const std::uint32_t first = 3 * t;
        std::vector<std::uint32_t> corners{first, first + 1, first + 2};
        const bool is_quad = quad != file.quads.end() && *quad == t;
        if (is_quad) ++quad;
        if (is_quad && (may_be_bent || is_flat(first)))
        {
            corners.push_back(first + 5);
            ++t;
        }
        body(std::move(corners));
    }
}

} // namespace fppg
