#pragma once

#include "fppg/mesh.h"
#include "fppg/rgb.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// A solid of a CAD model, or a shell that is in none. SI units.
struct CadPart
{
    std::string name; ///< of the instance, else of the part; may be empty
    /// From the top: names of the assemblies above it, of the instance and the part.
    std::vector<std::string> path;
    std::optional<Rgb> color;
    std::size_t first_facet = 0; ///< of the file's facets
    std::size_t facet_count = 0;
    double volume = 0; ///< of the exact solid; 0: it is a shell
    double area = 0;   ///< of the exact faces
    Vec3 center;       ///< of the exact volume
    /// Of the exact volume about its center, m5: xx, yy, zz, xy, yz, xz of the inertia matrix.
    std::array<double, 6> inertia{};
    std::size_t sharp_edges = 0;  ///< CAD edges that bend by more than a degree, or end
    std::size_t smooth_edges = 0; ///< tangent ones
    double sharp_length = 0;      ///< of the first
};

/// A point of an exact face, with its derivatives by the two parameters of the face.
struct FacePoint
{
    Vec3 s, su, sv, suu, suv, svv;
};

/// The exact faces behind the facets of a file: of STEP files. Metres, as the file's facets.
struct CadFacets
{
    TriangleSoup soup;                                    ///< the facets of the file
    std::vector<std::uint32_t> face;                      ///< per facet the face that it stands for
    std::vector<std::array<std::array<double, 2>, 3>> uv; ///< per facet, of its corners on the face
    std::vector<char> is_plane;                           ///< per facet, whether the face is
    std::vector<CadPart> parts;
    /// Coordinates are not finite where the face has no such point. From any thread.
    std::function<FacePoint(std::uint32_t face, double u, double v)> at;
};

} // namespace fppg
