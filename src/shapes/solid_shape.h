#pragma once

#include "fppg/case_def.h"
#include "fppg/fitted_walls.h"

#include "nodes/spans.h"
#include "shapes/shape.h"

#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// A closed solid whose file is all that there is to say of it: what stages ask, and what reads its
/// command. A row of casedef/command_table.cpp names the reader.
class SolidShape
{
public:
    virtual ~SolidShape() = default;

    virtual Box3 bounds() const = 0;
    /// The closed true surface, not snapped, with `round`.
    ///
    /// dp      metres; facets are no deeper below the surface than chord_error_dp
    /// throws  GeometryError where more than 20 million facets would be needed
    virtual ShapeMesh surface(double dp) const = 0;
    /// The nodes of the lattice that the draw mode takes: face, solid or full.
    virtual SlabRegion nodes(const DrawState& state, const LatticeGrid& grid) const = 0;
    /// Faces for shape files, counter-clockwise from outside.
    virtual std::vector<ShapeCell> cells(const ShapeContext& context) const = 0;
    virtual ExactBody moments() const = 0;
};

/// The element of a draw, for the shape that reads it. All functions throw CaseError with file,
/// line and element.
class DrawReader
{
public:
    virtual ~DrawReader() = default;

    virtual DrawMode mode() const = 0;
    /// Its `<point>`s under the current matrix.
    virtual std::vector<Vec3> points(std::size_t at_least, std::size_t at_most) const = 0;
    /// A child with x, y, z as a direction, which the matrix turns but does not move.
    virtual std::optional<Vec3> direction(const char* child) const = 0;
    virtual double number(const char* attribute) const = 0;
    [[noreturn]] virtual void fail(const std::string& text) const = 0;
};

/// torus.cpp: the points that are no farther than `tube` from a circle.
///
/// axis    of the circle, of length 1
/// radius  of the circle, metres, above tube
SolidOp make_torus(const Vec3& center, const Vec3& axis, double radius, double tube);
std::optional<Shape> read_torus(const DrawReader& reader);

} // namespace fppg
