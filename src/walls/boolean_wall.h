#pragma once

#include "fppg/boolean.h"
#include "fppg/case_def.h"
#include "fppg/error.h"

#include "lattice/fitted_draw.h"
#include "scene/surfaces.h"

#include <deque>
#include <string>
#include <vector>

namespace fppg
{

/// A draw that is part of a combination, by its true shape.
struct BooleanWallPart
{
    std::string name; ///< for messages
    TriangleSoup soup;
    std::uint16_t mk = 0;  ///< absolute, that its particles get
    bool is_solid = false; ///< the draw fills its inside
    bool may_be_sheet = false;
    bool is_surface = false;                ///< as BooleanPart::is_surface
    double least_depth = 0;                 ///< metres; as BooleanPart::least_depth
    std::shared_ptr<const CadSource> cad{}; ///< of CAD files
};

/// The parts of a combination of a scene by their true shapes.
///
/// throws  IoError, GeometryError with the place of the part
std::vector<BooleanWallPart> boolean_parts(const Scene& scene, const Combination& combination,
                                           PartsAs as, int threads);

/// Parts taken in, and the surface of their combination.
struct CombinedParts
{
    std::vector<BooleanWallPart> parts;
    const BooleanNode* tree = nullptr;
    std::deque<SurfaceMesh> meshes; ///< of the parts
    BooleanMesh result;             ///< at least one facet
    std::size_t facets_read = 0;    ///< of all parts
    std::vector<std::string> warnings;
};

/// dp      metres; cracks of parts narrower than 0.15 dp are closed
/// throws  GeometryError that names the part, NothingLeft for a result without a facet
CombinedParts combine_parts(std::vector<BooleanWallPart> parts, const BooleanNode& tree, double dp,
                            int threads);

/// Their combination as one shape: solid where a part that stays in it is.
ShapeMesh shape_of(const CombinedParts& combined);

/// Per facet of the result, the mk of the part whose solid lies behind it.
std::vector<std::uint16_t> mks_of_facets(const CombinedParts& combined);

/// Whether the error only says that voids or fluid hollow all of a solid away, which is none.
bool is_hollowed_away(const Combination* combination, const GeometryError& error);

/// Puts particles on the true surface of a combination of parts and finds the nodes inside and
/// around it.
///
/// Spheres, cylinders and ellipsoids take part by their facets: particles are within
/// chord_error_dp (0.005 dp) of the true surface, not on it as those of a round shape by itself.
/// Those of CAD models are on the exact faces, and where these meet.
///
/// Edges where surfaces of different parts meet are feature lines. Nodes of the inside are those of
/// boolean_spans(), less the zone of the wall; each belongs to the first of its parts, as
/// share_out() says, and is drawn if that part is solid. A facet has the mk of the part whose solid
/// lies behind it.
///
/// combined  meshes in the coordinates of the case
/// clips     as in fit_shape()
/// throws    GeometryError without the place of the draw
FittedDraw fit_boolean(CombinedParts&& combined, const FitSettings& settings,
                       const LatticeGrid& grid, const std::vector<ClipPlane>& clips, int threads);

} // namespace fppg
