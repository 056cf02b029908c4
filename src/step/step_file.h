#pragma once

#include "meshes/step_plugin.h"

#include <Geom_Surface.hxx>
#include <Standard_Handle.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace fppg::step
{

/// A solid, or a shell that is in none, in its place in the assembly.
struct Part
{
    TopoDS_Shape shape;
    std::string name;
    std::string path; ///< names above it, a line each
    bool has_color = false;
    double color[3]{}; ///< sRGB
};

/// A file that is open.
struct File
{
    std::vector<Part> parts;
    std::vector<Handle(Geom_Surface)> faces; ///< of all parts that were meshed
};

/// Reads a file.
///
/// returns  an empty text, or what is wrong
std::string read_file(const char* path, File& file);

/// Facets of a part, with what its exact faces say. Adds its faces to those of the file.
void mesh_part(File& file, std::size_t index, double deflection, double angle, void* to,
               void (*take)(void* to, const FppgStepMesh* mesh));

} // namespace fppg::step
