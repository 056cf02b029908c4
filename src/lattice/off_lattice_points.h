#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"

#include <array>
#include <vector>

namespace fppg
{

/// Two particles, or a particle and a node, are never nearer, dp.
inline constexpr double nearest_dp = 0.75;

/// The places of particles that `setfrdrawmode auto="true"` draws off the lattice, in GenCase's
/// order of drawing, before clips and the limits of the domain.
///
/// Found by experiment with GenCase v5.4.354; the arithmetic is the one that gives its positions
/// to the last bit (lines and quads 24 of 24 random ones), since particles of nearly the same x
/// change places in the ids otherwise.

/// A segment in floor(L / dp + 0.5) equal intervals, both ends included; nothing when it is
/// shorter than dp / 2.
std::vector<Vec3> off_lattice_line(const Vec3& from, const Vec3& to, const LatticeGrid& grid);

/// A parallelogram in ceil(L / dp) equal intervals a side, all sides included. A side of 2 dp that
/// rounding makes longer has three, as in GenCase, which then refuses it.
///
/// throws  GeometryError when neighbours would be nearer than 0.75 dp ("too sharp"), which GenCase
///         refuses too
std::vector<Vec3> off_lattice_parallelogram(const Vec3& corner, const Vec3& first, const Vec3& last,
                                            const LatticeGrid& grid);

/// A trapezoid with the parallel sides 0-1 and 3-2: rows from the first to the second in
/// ceil(L / dp) steps along 0-3 and as many along 1-2, each in equal intervals of at most dp (41 of
/// 41 random ones).
///
/// throws  GeometryError when 1-2 is longer than 0-3 by more than 0.05 dp, which GenCase refuses
///         too (62 random ones)
std::vector<Vec3> off_lattice_trapezoid(const std::array<Vec3, 4>& corners,
                                        const LatticeGrid& grid);

/// Points of a square grid in the plane of the triangle that lie in it or on its sides. The grid
/// has the spacing dp and goes through the foot of the lattice's origin on the plane; one of its
/// axes has no y.
std::vector<Vec3> off_lattice_triangle(const std::array<Vec3, 3>& corners, const LatticeGrid& grid);

/// A piece of off_lattice_pieces(): a point, two corners as off_lattice_line(), three as
/// off_lattice_triangle(), four as off_lattice_parallelogram() or off_lattice_trapezoid().
std::vector<Vec3> off_lattice_polygon(const std::vector<Vec3>& corners, const LatticeGrid& grid);

/// A parallelepiped by a corner and its three neighbours, ceil(L / dp) equal intervals an edge.
///
/// throws  GeometryError as off_lattice_parallelogram()
std::vector<Vec3> off_lattice_block(const Vec3& corner, const std::array<Vec3, 3>& neighbours,
                                    const LatticeGrid& grid);

/// A sphere as shells of radius R k / n with n = ceil(R / dp): k = n in face mode, k < n in solid
/// mode, all in full mode, rising. A shell of radius r has rings at 2 ceil(pi r / (2 dp)) equal
/// steps of the polar angle, from the bottom up, each with ceil(2 pi r sin / dp) points from +x on.
/// The top pole is one of them (but for 30, 50, 60, 70, 82 and some more numbers of rings, by the
/// rounding of its angle), the bottom pole is left out, as GenCase leaves it out. Up to R =
/// 0.75 dp the centre alone. Layers are shells of radius R + layer * dp. Rotations
/// and scales of the matrix turn and stretch the shells, whose points were counted before.
std::vector<Vec3> off_lattice_sphere(const SphereOp& op, const Transform& matrix, DrawMode mode,
                                     const LatticeGrid& grid);

/// A sphere in a 2D case: the disc of radius r where it meets the plane y, as rings of radius
/// r k / n with n = ceil(r / dp), each with ceil(2 pi r k / (n dp)) points from +z on, and the
/// centre where the rings are more than 0.75 dp apart. Solid mode draws none, layers one each in
/// every mode; a radius up to 0.75 dp, and a sphere beside the plane, are their centre (21 spheres
/// and layers of GenCase v5.4.354). A matrix moves its centre alone (turns, scales and mirrors of
/// the same sphere: the same rings).
std::vector<Vec3> off_lattice_disc(const SphereOp& op, DrawMode mode, const LatticeGrid& grid);

/// A cylinder as ceil(L / dp) + 1 discs, one more where rounding makes L longer than a multiple (60
/// of 60 lengths, 7 of them so; solid boxes have room for rounding), each of the axis point and
/// rings of radius R k / n with n = ceil(R / dp) and ceil(2 pi r / dp) points. Covers are the end
/// discs, the tube is the ring k = n of every disc; solid mode takes the inner rings of the inner
/// discs without the axis, full mode everything. Layers move the tube and the visible covers
/// outwards by layer * dp.
std::vector<Vec3> off_lattice_cylinder(const CylinderOp& op, DrawMode mode,
                                       const LatticeGrid& grid);

/// Whether a cylinder is drawn with its inside. Its nodes are emptied before it then
/// (emptied_by_cylinder()).
bool fills_off_lattice_cylinder(const CylinderOp& op, DrawMode mode);

} // namespace fppg
