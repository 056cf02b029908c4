#pragma once

#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace fppg
{

/// What a mesh file is read as.
enum class MeshFormat : std::uint8_t
{
    Stl,
    Ply,
    Vtk,           ///< legacy .vtk, .vtp or .vtu, told apart by their first bytes
    CsvBathymetry, ///< a table of heights
    Obj,           ///< Wavefront
    Off,
    Bathymetry, ///< points from which a grid of heights is made
    Step,       ///< a CAD model
};

/// Which shapes of a VTK file are taken: `polyselec`.
struct ShapeSelection
{
    bool points = true;
    bool lines = true;
    bool triangles = true;
    bool quads = true;
    bool other_polygons = true; ///< five and more corners
    bool operator==(const ShapeSelection&) const = default;
};

/// One side of `<expands>`: the grid goes on for `size`, then for `size2`, one cell each; a
/// negative `size` cuts it there.
struct BathymetryRamp
{
    double size = 0;          ///< metres; 0: nothing is added
    std::optional<double> z;  ///< height at the end of the first part; empty: that of the border
    double size2 = 0;         ///< metres; 0: no second part
    std::optional<double> z2; ///< height at the end of the second part; empty: that before it
    bool operator==(const BathymetryRamp&) const = default;
};

/// `<periodicx>`, `<periodicy>`: both ends of the grid are brought to one height.
struct BathymetryPeriod
{
    double ramp_width = 0; ///< metres
    double flat_width = 0; ///< metres
    bool operator==(const BathymetryPeriod&) const = default;
};

/// A rectangle in x and y.
struct GroundRectangle
{
    double x_min = 0;
    double y_min = 0;
    double x_size = 0;
    double y_size = 0;
    bool operator==(const GroundRectangle&) const = default;
};

/// `<drawbathymetry>`: a grid of heights, from points or as a file gives it.
struct BathymetryGrid
{
    /// `<grid file>`: the points are the nodes of the grid; the next four are not used then.
    bool is_grid_file = false;
    Transform transform; ///< of the points: scale, rotate and move of `<zpoints>`
    std::optional<GroundRectangle>
        selection;                         ///< only the points in it are used, after the transform
    double spacing = 0;                    ///< metres between the nodes of the grid
    std::optional<GroundRectangle> domain; ///< `initdomain`; empty: that of the points
    std::array<BathymetryRamp, 4> expands; ///< xmin, xmax, ymin, ymax
    std::array<std::optional<BathymetryPeriod>, 2> periods; ///< in x, in y
    Vec3 final_move;
    bool operator==(const BathymetryGrid&) const = default;
};

/// How a mesh file is read.
struct MeshReading
{
    MeshFormat format = MeshFormat::Stl;
    ShapeSelection shapes{};
    std::optional<BathymetryGrid> bathymetry{}; ///< of MeshFormat::Bathymetry
    /// Of MeshFormat::Step: names of parts or of assemblies, separated by commas, "bolt#2" the
    /// second of a name; empty: all parts.
    std::string parts{};
    /// Of MeshFormat::Step: how far facets are from the surface, metres; 0: 1/2000 of a part's
    /// size.
    double deflection = 0;
    bool operator==(const MeshReading&) const = default;
};

} // namespace fppg
