#pragma once

#include "fppg/initials.h"
#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fppg
{

/// `<norgeometry>`: normals to the polygons of a file.
struct GeometryNormals
{
    int line = 0;
    std::string file;         ///< as in the definition, variables replaced
    double distance_h = 2;    ///< reach D of a polygon, in h
    double max_size_h = 0;    ///< longer normals are shortened to this, in h; 0: none is
    bool save_shapes = false; ///< `svshapes`: the polygons used, with their normals
};

/// `<norset>`: the vector as written.
struct SetNormals
{
    Vec3 normal;
};

/// `<norplane>`: to a plane, from both sides.
struct PlaneNormals
{
    std::optional<Vec3> point; ///< empty: limit_dp * dp beyond the outermost selected of each mk
    double limit_dp = 0.5;
    Vec3 normal; ///< of any length
};

/// `<norsphere>`
struct SphereNormals
{
    Vec3 center;
    double radius = 0;
    bool is_inside = false; ///< the particles inside the sphere, else those outside
};

/// `<norcylinder>`
struct CylinderNormals
{
    Vec3 center1;
    Vec3 center2;
    double radius = 0;
    bool is_inside = false; ///< the particles inside the cylinder, else those outside
    std::array<bool, 2> limits{true, true}; ///< inside: the covers count at center1, center2
};

/// `<norparts>`: to the surface guessed from the particles themselves, 2-D only.
struct PartNormals
{
};

using NormalVariant =
    std::variant<SetNormals, PlaneNormals, SphereNormals, CylinderNormals, PartNormals>;

/// A child of `<normals>` other than norgeometry.
struct NormalOp
{
    int line = 0;
    bool has_mk = false;           ///< false: every boundary particle
    std::vector<std::uint16_t> mk; ///< absolute
    PositionFilter only;
    double max_distance_h = 2; ///< `maxdisth`; 0: no limit, of norparts no normals
    bool clear = true;         ///< the selected particles lose the normal that they have
    NormalVariant what;
};

/// `<normals>`
struct NormalsDef
{
    bool is_active = false;
    std::optional<GeometryNormals> geometry; ///< runs first, wherever it stands
    std::vector<NormalOp> ops;               ///< in the order of the file
};

struct CaseDef;
struct CaseParticles;
struct RunField;
struct ShapePolygons;

/// What the stage says besides the normals.
struct NormalsReport
{
    std::vector<std::string> log;      ///< lines for the output
    std::vector<std::string> warnings; ///< whole sentences
    std::vector<ShapePolygons> shapes; ///< the picture that svshapes asks for, else empty
};

/// The normals of the boundary particles for mDBC: the vector from the particle to the boundary's
/// surface, zero where there is none.
///
/// A particle that a fit put on a surface has no distance to it. It gets the exact normal of the
/// surface there (OffLatticeParticles::normals), 0.01 dp long, towards the side to which the faces
/// of norgeometry look that pass within 0.5 dp of it; where there are none, what norgeometry finds,
/// and outwards where no entry gives it a direction.
///
/// What leads straight to a facet of a CAD model leads to the exact face behind it.
///
/// Particles of layers behind a fitted surface, and the nodes under them within 2 h, get the exact
/// vector to the nearest place that fluid can touch (normals/wet_surface.h), whatever norgeometry
/// says; the other entries count as for all.
///
/// def        its `normals` are active
/// particles  at their places after `<initials>`
/// field      that they were made of; its walls and the nodes of its fluid are looked at
/// geometry   the polygons of def.normals.geometry's file; not used without
/// threads    number of threads; the result does not depend on it
/// returns    one vector per boundary particle, in id order, metres
/// throws     CaseError for norparts in 3-D
/// cost       O((particles + polygons) log polygons + candidates) time, 12 bytes per boundary
///            particle
/// source     experiments with GenCase v5.4.354; their rules are at the head of
///            src/normals/geometry_normals.h and at each function of src/normals/normals.cpp
std::vector<std::array<float, 3>> compute_normals(const CaseDef& def,
                                                  const CaseParticles& particles,
                                                  const RunField& field,
                                                  const std::vector<ShapePolygons>& geometry,
                                                  int threads, NormalsReport& report);

} // namespace fppg
