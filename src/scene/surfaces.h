#pragma once

#include "fppg/scene.h"

#include "shapes/shape_mesh.h"

#include <string>
#include <vector>

namespace fppg
{

/// How the parts of a shape are taken that setmknextauto draws one by one.
enum class PartsAs
{
    Drawn, ///< each with its mk; what has no true shape of its own is refused
    One,   ///< as one body: at the first part the whole, at the others nothing
};

/// The true surfaces of a shape of a scene, as shape_meshes() gives them, in 2D with what
/// give_section() adds; none for a mesh file without facets and for what is no shape.
///
/// throws  IoError, GeometryError for mesh files, with their places; GeometryError as
///         shape_meshes(), without
std::vector<ShapeMesh> surfaces_of(const Scene& scene, const DrawOp& draw, PartsAs parts,
                                   int threads);

/// A part of a combination as one mesh; solid where one of its surfaces is.
///
/// throws  as surfaces_of(), and GeometryError for a part without a surface, with its place
ShapeMesh surface_of_part(const Scene& scene, const Combination& combination, std::size_t part,
                          PartsAs parts, int threads);

/// The mesh file of a draw; null for every other draw.
const MeshFile* mesh_of(const Scene& scene, const DrawOp& draw, int threads);

/// "Case_Def.xml:41: <drawbox>", the place of a draw for messages.
std::string place_of(const CaseDef& def, const SourceRef& source);

/// "housing" or "<drawbox> in line 41".
std::string name_of(const SourceRef& source);

} // namespace fppg
