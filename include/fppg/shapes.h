#pragma once

#include "fppg/lattice.h"
#include "fppg/mesh.h"

#include <string>

namespace fppg
{

/// Reads an STL file, binary or ASCII, whatever its header says.
///
/// path     as the user named it, relative to the working directory
/// returns  facets in the order of the file; corners are the file's float32 values. Facets with a
///          coordinate that is not finite are left out with a warning that counts them
/// throws   IoError if the file cannot be opened; GeometryError if it is no STL, is truncated, has
/// a
///          facet that is no triangle or a number that cannot be read (names byte or line), or has
///          no facet left
MeshFile read_stl(const std::string& path);

/// The nodes inside a mesh, by the sum of signed crossings along each column.
///
/// Every column (x, y) is cut with all facets in double precision; a facet that faces down adds one
/// (entering, upwards), one that faces up takes one away. Nodes where the sum is positive are
/// inside, so overlapping closed parts of one file join. Columns that pass exactly through an edge
/// or a vertex count one facet only, by a consistent rule (as if the mesh were shifted by an
/// infinitesimal amount), so that no crossing is lost or counted twice. A node exactly on the
/// surface is inside.
///
/// soup     closed, facets counter-clockwise from outside; a mesh whose signed volume is negative
///          is taken with all facets flipped
/// threads  number of threads; the result does not depend on it
/// cost     O(facets + crossings log crossings) time, memory for the result only
SpanSet inside_spans(const TriangleSoup& soup, const LatticeGrid& grid, int threads);

} // namespace fppg
