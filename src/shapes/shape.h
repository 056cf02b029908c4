#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"
#include "fppg/mesh.h"

#include "shapes/moments.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// The corners of a line (two) or of a face (three and more), metres.
using ShapeCell = std::vector<Vec3>;

/// What the answers of a shape depend on besides itself.
struct ShapeContext
{
    const DrawState& state;
    const LatticeGrid& grid;
    const MeshFile* mesh = nullptr; ///< of a mesh file; null for every other shape
    bool snapped = false;           ///< cells with corners and radii on the lattice

    bool is_wire() const { return state.mode == DrawMode::Wire; }
    /// Whether what a shape bounds is drawn too.
    bool may_fill() const { return state.mode != DrawMode::Face; }
    /// A place, on the lattice where cells are snapped.
    Vec3 place(const Vec3& p) const;
    /// A radius, a whole multiple of dp where cells are snapped.
    double rounded(double radius) const;
};

/// Whether a shape has a surface that particles can stand on and Booleans can cut: all but points,
/// lines and waves.
bool has_surface(const Shape& shape);

/// Whether shape files show a shape: all but points, ellipsoids and waves.
bool has_cells(const Shape& shape);

/// The box around a shape; empty for mesh files and waves.
Box3 bounds_of(const Shape& shape, double dp);

/// Whether a shape is drawn as something that has a thickness.
bool is_body(const Shape& shape, DrawMode mode);

/// The true surfaces, as shape_meshes() says, but that setnormalinvert turns nothing.
std::vector<ShapeMesh> surfaces_of(const Shape& shape, const ShapeContext& context);

/// The lines and faces that shape files show, before clips.
std::vector<ShapeCell> cells_of(const Shape& shape, const ShapeContext& context);

/// The exact body that a shape bounds, whatever the mode of the state.
///
/// why_not  filled with a sentence when nothing is returned
std::optional<ExactBody> body_of(const Shape& shape, const ShapeContext& context,
                                 std::string& why_not);

} // namespace fppg
